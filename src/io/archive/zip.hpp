// Blum: ZIP archives, read and written. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/text/row_writer.hpp"

namespace blum::volume_io {

struct ZipEntry {
  std::string name;
  bool deflated = false;
  std::uint32_t crc = 0;
  std::uint64_t packed_size = 0;
  std::uint64_t size = 0;
  std::uint64_t header_offset = 0;
};

/// Stream of the content of one entry. check_finished() compares the checksum.
class ZipEntryStream final : public ByteStream {
 public:
  ZipEntryStream(std::unique_ptr<ByteStream> inner, const ZipEntry& entry, std::string name)
      : inner_(std::move(inner)), left_(entry.size), expected_crc_(entry.crc), name_(std::move(name)) {}
  [[nodiscard]] std::size_t read_some(std::span<std::byte> out) override;
  [[nodiscard]] std::uint64_t most_left() const override;
  [[nodiscard]] const std::string& name() const override { return name_; }
  /// @throws FormatError unless the whole entry has been read and its checksum is correct.
  void check_finished() const;

 private:
  std::unique_ptr<ByteStream> inner_;
  std::uint64_t left_ = 0;
  std::uint32_t expected_crc_ = 0;
  std::uint32_t crc_ = 0;
  std::string name_;
};

/// Reader of an archive through its directory, including zip64 archives. Entries must be stored or deflated and not
/// encrypted. The archive must be a single file.
class ZipReader {
 public:
  /// Reads the directory. The source must outlive the reader and its streams. @throws FormatError.
  explicit ZipReader(const ByteSource& source);
  /// Returns the entries in the order of the directory.
  [[nodiscard]] const std::vector<ZipEntry>& entries() const { return entries_; }
  /// Returns the entry with this name, or null.
  [[nodiscard]] const ZipEntry* find(std::string_view name) const;
  /// Opens the content of an entry. @throws FormatError.
  [[nodiscard]] std::unique_ptr<ZipEntryStream> open(const ZipEntry& entry) const;

 private:
  const ByteSource& source_;
  std::vector<ZipEntry> entries_;
};

/// Writer of an archive with stored entries, in one pass. Sizes above 4 GB are written in zip64 records (APPNOTE 4.3,
/// 4.5.3).
/// The checksum of an entry is computed by all threads before its bytes are written. The header of a stored entry must
/// contain it, because streaming readers cannot use a checksum that follows the data.
class ZipWriter {
 public:
  ZipWriter(AtomicFile& file, FieldSink& sink, const Context& context) : file_(file), sink_(sink), context_(context) {}

  /// Adds an entry with the content `head` followed by `body`. The name must be ASCII.
  void add(const std::string& name, std::span<const std::byte> head, std::span<const std::byte> body);
  /// Writes the directory. It must be called once, after the last entry.
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

/// Returns the CRC-32 of many bytes. All threads of the context compute it together.
[[nodiscard]] std::uint32_t parallel_crc32(std::span<const std::byte> bytes, const Context& context);

/// Returns true if a file with these first bytes is a ZIP archive, for example an .npz file.
[[nodiscard]] inline bool begins_as_zip(std::string_view head) {
  return head.starts_with("PK\x03\x04");
}

}  // namespace blum::volume_io
