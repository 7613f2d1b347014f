// Blum: zip archives of uncompressed entries, for .npz files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/bytes/field_sink.hpp"

namespace blum::volume_io {

/// Writes stored entries in one pass; sizes beyond 4 GB use the zip64 records (APPNOTE 4.3, 4.5.3).
/// The checksum of an entry is found before its bytes are written, by all threads: the header of a stored entry must
/// name it, and readers that stream cannot use one that comes after the data.
class ZipWriter {
 public:
  ZipWriter(AtomicFile& file, FieldSink& sink, const Context& context) : file_(file), sink_(sink), context_(context) {}

  /// Adds an entry whose content is `head` followed by `body`. The name must be ASCII.
  void add(const std::string& name, std::span<const std::byte> head, std::span<const std::byte> body);
  /// Writes the directory; to be called once, after the last entry.
  void finish();

 private:
  struct Entry {
    std::string name;
    std::uint32_t crc = 0;
    std::uint64_t size = 0;
    std::uint64_t offset = 0;
  };
  void write(const std::string& bytes);

  AtomicFile& file_;
  FieldSink& sink_;
  const Context& context_;
  std::uint64_t position_ = 0;
  std::vector<Entry> entries_;
};

/// CRC-32 of a long run of bytes, by all threads of the context.
[[nodiscard]] std::uint32_t parallel_crc32(std::span<const std::byte> bytes, const Context& context);

}  // namespace blum::volume_io
