#include "io/bytes/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// Closes the descriptor that it holds.
struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw FileError("cannot read '" + path.string() + "': " + std::generic_category().message(error));
}

/// Reads up to `size` bytes; fewer only where the file ends.
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

}  // namespace

FileBytes read_whole_file(const std::filesystem::path& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) fail(path, errno);
  struct stat info{};
  if (::fstat(file.number, &info) != 0) fail(path, errno);
  if (S_ISDIR(info.st_mode)) fail(path, EISDIR);
  if (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode)) {  // may never end
    throw FileError("cannot read '" + path.string() + "': it is a device, not a file");
  }

  // One byte more than the file should have shows in the first read whether it has ended; a pipe, or a file that grows
  // meanwhile, goes on into a buffer of twice the size.
  Buffer<std::byte> bytes(std::max<std::size_t>(static_cast<std::size_t>(info.st_size) + 1, 4096));
  std::size_t size = read_up_to(file.number, bytes.data(), bytes.size(), path);
  while (size == bytes.size()) {
    bytes = first_bytes(bytes, size, 2 * size);
    size += read_up_to(file.number, bytes.data() + size, bytes.size() - size, path);
  }
  return {std::move(bytes), size};
}

}  // namespace blum
