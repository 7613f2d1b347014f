// Blum: sources and streams of the bytes of files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>

#include "blum/core/buffer.hpp"

namespace blum {

/// Content of a file.
struct FileBytes {
  Buffer<std::byte> storage = {};
  std::size_t size = 0;  ///< the storage may be larger than this
  [[nodiscard]] std::span<const std::byte> span() const { return storage.span().first(size); }
};

}  // namespace blum

namespace blum::volume_io {

/// Source of bytes with random access. Only one thread may use a source at a time.
class ByteSource {
 public:
  explicit ByteSource(std::string name) : name_(std::move(name)) {}
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Reads out.size() bytes, starting at `offset`. @throws FormatError if the source is too short, FileError if the
  /// system fails.
  virtual void read(std::uint64_t offset, std::span<std::byte> out) const = 0;
  /// Returns the name of the file, for messages.
  [[nodiscard]] const std::string& name() const { return name_; }

 protected:
  void check_range(std::uint64_t offset, std::size_t count) const;

 private:
  std::string name_;
};

/// Use of the bytes of a pipe, which can be read only once.
enum class PipeUse : std::uint8_t {
  take,   ///< the source takes the bytes; later readers get none
  keep,   ///< the next reader also gets the bytes
  refuse  ///< it is an error if the file is a pipe
};

class FileSource final : public ByteSource {
 public:
  /// Opens a file. A pipe is read to its end, and its bytes stay in memory.
  /// @throws FileError unless it is a regular file or a pipe that can be read.
  explicit FileSource(const std::filesystem::path& path, PipeUse use = PipeUse::take);
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, std::span<std::byte> out) const override;

 private:
  std::shared_ptr<const FileBytes> pipe_;  ///< bytes of a pipe; null for regular files
  mutable std::ifstream stream_;
  std::uint64_t size_ = 0;
};

class MemorySource final : public ByteSource {
 public:
  MemorySource(std::span<const std::byte> bytes, std::string name) : ByteSource(std::move(name)), bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, std::span<std::byte> out) const override;

 private:
  std::span<const std::byte> bytes_;
};

/// Stream of bytes that are read in order.
class ByteStream {
 public:
  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  virtual ~ByteStream() = default;

  /// Reads out.size() bytes, or fewer if the stream ends before. @throws FormatError for damaged data.
  [[nodiscard]] virtual std::size_t read_some(std::span<std::byte> out) = 0;
  /// Returns an upper bound on the number of bytes left. Readers use it to reject headers that promise more data,
  /// before they allocate memory.
  [[nodiscard]] virtual std::uint64_t most_left() const = 0;
  [[nodiscard]] virtual const std::string& name() const = 0;

  /// Reads exactly out.size() bytes. `what` is their description in messages. @throws FormatError if the stream is too
  /// short.
  void read(std::span<std::byte> out, const char* what);
  void skip(std::uint64_t count, const char* what);
  /// Reads to the end of compressed data, so that their checksum is compared. Additional data are accepted, because
  /// some writers pad. @throws FormatError if the data are damaged.
  void check_end();
  /// @throws FormatError if fewer than `count` bytes can be left. `what` is their description.
  void check_left(std::uint64_t count, const char* what) const;
};

/// Stream of a range of bytes of a source, without decompression. The source must outlive it.
class PlainStream final : public ByteStream {
 public:
  explicit PlainStream(const ByteSource& source) : PlainStream(source, 0, source.size()) {}
  PlainStream(const ByteSource& source, std::uint64_t begin, std::uint64_t end)
      : source_(source), at_(begin), end_(end) {}
  [[nodiscard]] std::size_t read_some(std::span<std::byte> out) override;
  [[nodiscard]] std::uint64_t most_left() const override { return end_ - at_; }
  [[nodiscard]] const std::string& name() const override { return source_.name(); }

 private:
  const ByteSource& source_;
  std::uint64_t at_ = 0;
  std::uint64_t end_ = 0;
};

enum class Compression : std::uint8_t { gzip, zlib, deflate };

/// Stream of the decompressed content of a range of bytes of a source. The source must outlive it. Gzip data may have
/// several members.
class InflateStream final : public ByteStream {
 public:
  InflateStream(const ByteSource& source, std::uint64_t begin, std::uint64_t end, Compression compression);
  ~InflateStream() override;
  [[nodiscard]] std::size_t read_some(std::span<std::byte> out) override;
  [[nodiscard]] std::uint64_t most_left() const override;
  [[nodiscard]] const std::string& name() const override { return source_.name(); }

 private:
  struct State;
  void refill();
  void end_of_member();

  const ByteSource& source_;
  std::uint64_t at_ = 0;
  std::uint64_t end_ = 0;
  Compression compression_;
  std::unique_ptr<State> state_;
};

}  // namespace blum::volume_io

namespace blum {

/// Returns all bytes of a file, or of a pipe up to its end. If read_file_head() was called for the pipe before, the
/// bytes that it read are part of the result.
/// @throws FileError if it cannot be read, or is a directory or a device; OutOfMemory.
[[nodiscard]] FileBytes read_whole_file(const std::filesystem::path& path);

inline constexpr std::size_t head_size = 8192;  ///< Number of bytes that show the format of a file.

/// Returns the first bytes of a file, at most `size`. A pipe can be read only once, so all its bytes are kept in memory
/// until the next call of read_whole_file() for the same pipe. Any thread may call this function.
/// @throws as read_whole_file().
[[nodiscard]] std::string read_file_head(const std::filesystem::path& path, std::size_t size = head_size);

/// Returns the number of bytes of a file. A pipe is read and kept, as by read_file_head().
/// @throws as read_whole_file().
[[nodiscard]] std::uint64_t count_file_bytes(const std::filesystem::path& path);

/// Returns true if a path names a pipe. The path is not opened.
[[nodiscard]] bool is_pipe(const std::filesystem::path& path);

}  // namespace blum
