#include "io/bytes/byte_source.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <system_error>
#include <vector>

#include "blum/core/error.hpp"

namespace blum::volume_io {

void ByteSource::check_range(std::uint64_t offset, std::size_t count) const {
  if (offset > size() || count > size() - offset) {
    throw FormatError(name_ + ": it ends at byte " + std::to_string(size()) + ", but " + std::to_string(count) +
                      " bytes from byte " + std::to_string(offset) + " on are needed; the file is cut short");
  }
}

FileSource::FileSource(const std::filesystem::path& path) : ByteSource(path.string()) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw FileError("cannot read '" + name() + "': " + (error ? error.message() : "there is no such file"));
  }
  if (!std::filesystem::is_regular_file(status)) throw FileError("cannot read '" + name() + "': it is not a file");
  size_ = std::filesystem::file_size(path, error);
  if (error) throw FileError("cannot read '" + name() + "': " + error.message());
  stream_.open(path, std::ios::binary);
  if (!stream_) throw FileError("cannot open '" + name() + "' for reading; check its permissions");
}

void FileSource::read(std::uint64_t offset, std::span<std::byte> out) const {
  check_range(offset, out.size());
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  stream_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
  if (!stream_) throw FileError("cannot read '" + name() + "': the system gave fewer bytes than the file has");
}

void MemorySource::read(std::uint64_t offset, std::span<std::byte> out) const {
  check_range(offset, out.size());
  if (!out.empty()) std::memcpy(out.data(), bytes_.data() + offset, out.size());
}

void ByteStream::check_left(std::uint64_t count, const char* what) const {
  if (count > most_left()) {
    throw FormatError(name() + ": " + what + " should be " + std::to_string(count) + " bytes, but at most " +
                      std::to_string(most_left()) + " are left; the file is cut short or its header is wrong");
  }
}

void ByteStream::read(std::span<std::byte> out, const char* what) {
  check_left(out.size(), what);
  const std::size_t got = read_some(out);
  if (got < out.size()) {
    throw FormatError(name() + ": " + what + " should be " + std::to_string(out.size()) + " bytes, but there are " +
                      std::to_string(got) + "; the file is cut short or its header is wrong");
  }
}

void ByteStream::skip(std::uint64_t count, const char* what) {
  check_left(count, what);
  std::vector<std::byte> waste(static_cast<std::size_t>(std::min<std::uint64_t>(count, std::uint64_t{1} << 16U)));
  while (count > 0) {
    const std::size_t piece = static_cast<std::size_t>(std::min<std::uint64_t>(count, waste.size()));
    read(std::span(waste).first(piece), what);
    count -= piece;
  }
}

void ByteStream::check_end() {
  std::byte next{};
  [[maybe_unused]] const std::size_t got = read_some(std::span(&next, 1));
}

std::size_t PlainStream::read_some(std::span<std::byte> out) {
  const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), end_ - at_));
  source_.read(at_, out.first(count));
  at_ += count;
  return count;
}

}  // namespace blum::volume_io
