#include "io/bytes/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"

namespace blum::volume_io {

void ByteSource::check_range(std::uint64_t offset, std::size_t count) const {
  if (offset > size() || count > size() - offset) {
    throw FormatError(name_ + ": the file has " + std::to_string(size()) + " bytes, but " + std::to_string(count) +
                      " bytes that begin at byte " + std::to_string(offset) + " are needed; the file is cut short");
  }
}

void MemorySource::read(std::uint64_t offset, std::span<std::byte> out) const {
  check_range(offset, out.size());
  if (!out.empty()) std::memcpy(out.data(), bytes_.data() + offset, out.size());
}

void ByteStream::check_left(std::uint64_t count, const char* what) const {
  if (count > most_left()) {
    throw FormatError(name() + ": " + what + " must have " + std::to_string(count) +
                      " bytes, but the file contains at most " + std::to_string(most_left()) +
                      " more; the file is cut short or its header is wrong");
  }
}

void ByteStream::read(std::span<std::byte> out, const char* what) {
  check_left(out.size(), what);
  const std::size_t got = read_some(out);
  if (got < out.size()) {
    throw FormatError(name() + ": " + what + " must have " + std::to_string(out.size()) +
                      " bytes, but the file contains only " + std::to_string(got) +
                      " more; the file is cut short or its header is wrong");
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

namespace blum {
namespace {

/// Descriptor that is closed by the destructor.
struct Descriptor {
  int number;
  explicit Descriptor(int descriptor) : number(descriptor) {}
  Descriptor(Descriptor&& other) noexcept : number(std::exchange(other.number, -1)) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// Returns the reason why a path without a file cannot be read.
std::string missing_text(const std::filesystem::path& path) {
  if (path == "-") return "there is no file of this name; for standard input, give the name /dev/stdin";
  return std::generic_category().message(ENOENT);
}

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  if (error == ENOENT) throw FileError("cannot read '" + path.string() + "': " + missing_text(path));
  throw FileError("cannot read '" + path.string() + "': " + std::generic_category().message(error));
}

/// Reads `size` bytes, or fewer if the file ends before.
std::size_t read_up_to(int descriptor, std::byte* data, std::size_t size, const std::filesystem::path& path) {
  std::size_t filled = 0;
  while (filled < size) {
    const ssize_t count = ::read(descriptor, data + filled, std::min(size - filled, std::size_t{1} << 30));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, errno);
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  return filled;
}

Buffer<std::byte> first_bytes(const Buffer<std::byte>& bytes, std::size_t size, std::size_t new_size) {
  Buffer<std::byte> result(new_size);
  std::copy_n(bytes.begin(), size, result.begin());
  return result;
}

/// Opens a file or a pipe for reading.
Descriptor opened(const std::filesystem::path& path, struct stat& info) {
  Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) fail(path, errno);
  if (::fstat(file.number, &info) != 0) fail(path, errno);
  if (S_ISDIR(info.st_mode)) fail(path, EISDIR);
  if (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode)) {  // reading a device may never end
    throw FileError("cannot read '" + path.string() + "': it is a device, not a file");
  }
  return file;
}

FileBytes read_to_end(const Descriptor& file, const struct stat& info, const std::filesystem::path& path) {
  // The first read requests one byte more than the file size, to detect the end of the file. Pipes, and files that grow
  // meanwhile, are longer; for them the buffer is doubled repeatedly.
  Buffer<std::byte> bytes(std::max<std::size_t>(static_cast<std::size_t>(info.st_size) + 1, 4096));
  std::size_t size = read_up_to(file.number, bytes.data(), bytes.size(), path);
  while (size == bytes.size()) {
    bytes = first_bytes(bytes, size, 2 * size);
    size += read_up_to(file.number, bytes.data() + size, bytes.size() - size, path);
  }
  return {std::move(bytes), size};
}

/// Device and inode. Device and inode identify a pipe, whatever path names it.
using PipeKey = std::pair<dev_t, ino_t>;

/// Returns the key of the pipe that a path names; nullopt if it names no pipe. The path is not opened: opening a pipe
/// without a writer would wait for one.
std::optional<PipeKey> pipe_at(const std::filesystem::path& path) {
  struct stat info{};
  if (::stat(path.c_str(), &info) != 0 || !S_ISFIFO(info.st_mode)) return std::nullopt;
  return PipeKey{info.st_dev, info.st_ino};
}

FileBytes read_all(const std::filesystem::path& path) {
  struct stat info{};
  const Descriptor file = opened(path, info);
  return read_to_end(file, info, path);
}

std::string text_head(std::span<const std::byte> bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes.data()), std::min(size, bytes.size())};
}

/// Content of pipes that were read, but whose bytes are still needed.
class KeptPipes {
 public:
  /// Returns the content of a pipe, and keeps it. If the content is not kept yet, the pipe is read now.
  [[nodiscard]] std::shared_ptr<const FileBytes> keep(const PipeKey& key, const std::filesystem::path& path) {
    {
      const std::scoped_lock lock(mutex_);
      if (const auto at = pipes_.find(key); at != pipes_.end()) return at->second;
    }
    auto bytes = std::make_shared<FileBytes>(read_all(path));  // outside the lock, because it may wait for a writer
    const std::scoped_lock lock(mutex_);
    return pipes_.emplace(key, std::move(bytes)).first->second;
  }
  /// Returns the content of a pipe if it is kept, and forgets it.
  [[nodiscard]] std::shared_ptr<FileBytes> take(const PipeKey& key) {
    const std::scoped_lock lock(mutex_);
    const auto at = pipes_.find(key);
    if (at == pipes_.end()) return nullptr;
    std::shared_ptr<FileBytes> bytes = std::move(at->second);
    pipes_.erase(at);
    return bytes;
  }

 private:
  std::mutex mutex_;
  std::map<PipeKey, std::shared_ptr<FileBytes>> pipes_;
};

KeptPipes& kept_pipes() {
  static KeptPipes pipes;
  return pipes;
}

/// Returns the content of a pipe, which is no longer kept.
std::shared_ptr<const FileBytes> taken(const PipeKey& key, const std::filesystem::path& path) {
  if (auto kept = kept_pipes().take(key)) return kept;
  return std::make_shared<FileBytes>(read_all(path));
}

}  // namespace

FileBytes read_whole_file(const std::filesystem::path& path) {
  if (const std::optional<PipeKey> pipe = pipe_at(path)) {
    // The content is copied only if another thread still reads it.
    if (const std::shared_ptr<FileBytes> kept = kept_pipes().take(*pipe)) {
      if (kept.use_count() == 1) return std::move(*kept);
      return {first_bytes(kept->storage, kept->size, kept->size), kept->size};
    }
  }
  return read_all(path);
}

std::string read_file_head(const std::filesystem::path& path, std::size_t size) {
  if (const std::optional<PipeKey> pipe = pipe_at(path)) return text_head(kept_pipes().keep(*pipe, path)->span(), size);
  struct stat info{};
  const Descriptor file = opened(path, info);
  std::string head(size, '\0');
  head.resize(read_up_to(file.number, reinterpret_cast<std::byte*>(head.data()), size, path));
  return head;
}

std::uint64_t count_file_bytes(const std::filesystem::path& path) {
  if (const std::optional<PipeKey> pipe = pipe_at(path)) return kept_pipes().keep(*pipe, path)->size;
  struct stat info{};
  const Descriptor file = opened(path, info);
  return static_cast<std::uint64_t>(info.st_size);
}

bool is_pipe(const std::filesystem::path& path) {
  return pipe_at(path).has_value();
}

namespace volume_io {

FileSource::FileSource(const std::filesystem::path& path, PipeUse use) : ByteSource(path.string()) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    const bool is_missing = !error || error == std::errc::no_such_file_or_directory;
    throw FileError("cannot read '" + name() + "': " + (is_missing ? missing_text(path) : error.message()));
  }
  if (const std::optional<PipeKey> pipe = pipe_at(path)) {
    if (use == PipeUse::refuse) {
      throw FileError("cannot read '" + name() +
                      "': it is a pipe, and it is one of several files of the same content; write it to a file");
    }
    pipe_ = use == PipeUse::keep ? kept_pipes().keep(*pipe, path) : taken(*pipe, path);
    size_ = pipe_->size;
    return;
  }
  if (!std::filesystem::is_regular_file(status)) throw FileError("cannot read '" + name() + "': it is not a file");
  size_ = std::filesystem::file_size(path, error);
  if (error) throw FileError("cannot read '" + name() + "': " + error.message());
  stream_.open(path, std::ios::binary);
  if (!stream_) throw FileError("cannot open '" + name() + "' for reading; check its permissions");
}

void FileSource::read(std::uint64_t offset, std::span<std::byte> out) const {
  check_range(offset, out.size());
  if (pipe_) {
    if (!out.empty()) std::memcpy(out.data(), pipe_->span().data() + offset, out.size());
    return;
  }
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  stream_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
  if (!stream_) throw FileError("cannot read '" + name() + "': the system gave fewer bytes than the file has");
}

}  // namespace volume_io

}  // namespace blum

namespace blum::volume_io {
namespace {

constexpr std::size_t buffer_size = std::size_t{256} << 10;
/// Largest expansion of deflate data: one byte becomes at most 1032 bytes (a match of 258 bytes takes at least two
/// bits).
constexpr std::uint64_t largest_ratio = 1032;

int window_bits(Compression compression) {
  switch (compression) {
    case Compression::gzip:
      return 15 + 16;
    case Compression::zlib:
      return 15;
    case Compression::deflate:
      break;
  }
  return -15;
}

}  // namespace

struct InflateStream::State {
  z_stream z{};
  std::vector<std::byte> input = std::vector<std::byte>(buffer_size);
  bool finished = false;
};

InflateStream::InflateStream(const ByteSource& source, std::uint64_t begin, std::uint64_t end, Compression compression)
    : source_(source), at_(begin), end_(end), compression_(compression), state_(std::make_unique<State>()) {
  if (inflateInit2(&state_->z, window_bits(compression)) != Z_OK) {
    throw OutOfMemory(name() + ": not enough memory to decompress it");
  }
}

InflateStream::~InflateStream() {
  inflateEnd(&state_->z);
}

std::uint64_t InflateStream::most_left() const {
  if (state_->finished) return 0;
  // Bits that are already read may represent one more byte of input, and a match may be half copied. The 8 bytes allow
  // for both cases.
  const std::uint64_t input = end_ - at_ + state_->z.avail_in + 8;
  return input > std::numeric_limits<std::uint64_t>::max() / largest_ratio ? std::numeric_limits<std::uint64_t>::max()
                                                                           : input * largest_ratio;
}

void InflateStream::refill() {
  const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_size, end_ - at_));
  source_.read(at_, std::span(state_->input).first(count));
  at_ += count;
  state_->z.next_in = reinterpret_cast<Bytef*>(state_->input.data());
  state_->z.avail_in = static_cast<uInt>(count);
}

/// Ends a gzip member and starts the next one, if any. Zeros or other bytes after the last member are ignored.
void InflateStream::end_of_member() {
  z_stream& z = state_->z;
  if (z.avail_in == 0 && at_ < end_) refill();
  const bool more = compression_ == Compression::gzip && z.avail_in > 0 && z.next_in[0] == 0x1f;
  if (more) {
    inflateReset(&z);
  } else {
    state_->finished = true;
  }
}

std::size_t InflateStream::read_some(std::span<std::byte> out) {
  z_stream& z = state_->z;
  std::size_t done = 0;
  while (done < out.size() && !state_->finished) {
    if (z.avail_in == 0 && at_ < end_) refill();
    const std::size_t room = std::min(out.size() - done, std::size_t{1} << 30U);
    z.next_out = reinterpret_cast<Bytef*>(out.data() + done);
    z.avail_out = static_cast<uInt>(room);
    const int status = inflate(&z, Z_NO_FLUSH);
    done += room - z.avail_out;
    if (status == Z_STREAM_END) {
      end_of_member();
    } else if (status == Z_BUF_ERROR && z.avail_in == 0 && at_ == end_) {
      throw FormatError(name() + ": the compressed data end too early; the file is cut short");
    } else if (status == Z_MEM_ERROR) {
      throw OutOfMemory(name() + ": not enough memory to decompress it");
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      throw FormatError(name() + ": the compressed data are damaged (" + (z.msg != nullptr ? z.msg : "zlib error") +
                        ")");
    }
  }
  return done;
}

}  // namespace blum::volume_io
