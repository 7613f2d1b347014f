// Blum: large writes with progress and cancellation. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "blum/core/context.hpp"
#include "blum/io/atomic_file.hpp"

namespace blum::volume_io {

/// Passes bytes on to files in pieces, so that a caller can follow the writing and stop it in time.
class FieldSink {
 public:
  /// @param total  bytes that will be written in all, for the progress.
  FieldSink(std::uint64_t total, const Context& context) : context_(context), total_(total) {}

  void write(AtomicFile& file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      throw_if_cancelled(context_);
      const auto piece = bytes.first(std::min(bytes.size(), piece_size));
      file.write(piece.data(), piece.size());
      bytes = bytes.subspan(piece.size());
      done_ += piece.size();
      if (context_.progress) {
        context_.progress(
            std::min(1.0, static_cast<double>(done_) / static_cast<double>(std::max<std::uint64_t>(total_, 1))),
            "write");
      }
    }
  }
  void write(AtomicFile& file, std::string_view text) { write(file, std::as_bytes(std::span(text))); }

 private:
  /// Small enough that even a slow disk takes one within the time that a cancelled call may run on.
  static constexpr std::size_t piece_size = std::size_t{8} << 20;

  const Context& context_;
  std::uint64_t total_ = 0;
  std::uint64_t done_ = 0;
};

}  // namespace blum::volume_io
