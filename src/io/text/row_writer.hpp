// Blum: large files, written with progress and cancellation. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/io/atomic_file.hpp"

namespace blum {

/// Writer of numbers to a file, as text or as little-endian bytes. The file appears under its name when finish() is
/// called.
class RowWriter {
 public:
  /// @param rows  number of calls of end_row(), used to report progress.
  RowWriter(const std::filesystem::path& path, std::size_t rows, Context context)
      : file_(path), context_(std::move(context)), rows_(rows) {
    buffer_.reserve(piece_size + 4096);
  }

  /// Creates a writer that does not report progress.
  explicit RowWriter(const std::filesystem::path& path) : RowWriter(path, 0, {}) {}

  void text(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() >= piece_size) flush();
  }
  /// Writes a blank and a number, with as few digits as identify it exactly.
  template <class T>
  void number(T value) {
    std::array<char, 40> digits{};
    digits[0] = ' ';
    const auto result = std::to_chars(digits.data() + 1, digits.data() + digits.size(), value);
    text({digits.data(), static_cast<std::size_t>(result.ptr - digits.data())});
  }
  void vector(const Vec3d& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) number(v[axis]);
  }
  template <class T>
  void bytes(T value) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    text({raw.data(), raw.size()});
  }
  void end_row() { ++done_; }
  /// Completes the file. @throws FileError, Cancelled.
  void finish() {
    flush();
    file_.commit();
  }

 private:
  /// Number of bytes between two checks for cancellation. It is small, so that a cancelled call ends soon.
  static constexpr std::size_t piece_size = std::size_t{1} << 20;

  void flush() {
    throw_if_cancelled(context_);
    file_.write(buffer_);
    buffer_.clear();
    if (context_.progress) {
      context_.progress(rows_ == 0 ? 1.0 : static_cast<double>(done_) / static_cast<double>(rows_), "write");
    }
  }

  AtomicFile file_;
  Context context_;
  std::string buffer_;
  std::size_t rows_ = 0;
  std::size_t done_ = 0;
};

}  // namespace blum

namespace blum::volume_io {

/// Sink that passes bytes to a file in pieces. It reports progress and checks for cancellation between pieces.
class FieldSink {
 public:
  /// @param total  number of bytes that will be written in total, used to report progress.
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
  /// Number of bytes of a piece. Even a slow disk writes it within the time allowed for a cancelled call.
  static constexpr std::size_t piece_size = std::size_t{8} << 20;

  const Context& context_;
  std::uint64_t total_ = 0;
  std::uint64_t done_ = 0;
};

}  // namespace blum::volume_io
