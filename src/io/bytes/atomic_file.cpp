#include "blum/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/io/draft.hpp"

namespace blum {
namespace {

constexpr std::size_t buffer_size = std::size_t{256} << 10;
/// Largest number of bytes for one write(2). Linux writes at most 2 GiB at once, and macOS rejects more.
constexpr std::size_t largest_write = std::size_t{1} << 30;

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// Returns the number of an open descriptor if the path stands for one: /dev/stdout, /dev/stderr, /dev/fd/N,
/// /proc/self/fd/N. Opening such a path again would write from the start of a redirected file, and would fail for
/// sockets.
std::optional<int> descriptor_of(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!path.starts_with(prefix)) continue;
    int number = 0;
    const char* end = path.data() + path.size();
    const auto [last, error] = std::from_chars(path.data() + prefix.size(), end, number);
    if (error == std::errc() && last == end && number >= 0) return number;
  }
  return std::nullopt;
}

/// Follows symbolic links. The target need not exist yet.
/// @returns nullopt if the links form a circle or cannot be read; errno contains the reason.
std::optional<std::filesystem::path> follow_links(std::filesystem::path path) {
  for (int depth = 0; depth < 40; ++depth) {
    struct stat info{};
    if (::lstat(path.c_str(), &info) != 0 || !S_ISLNK(info.st_mode)) return path;
    std::error_code error;
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) {
      errno = error.value();
      return std::nullopt;
    }
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  errno = ELOOP;
  return std::nullopt;
}

/// Returns a random hidden name in the target's folder. It is short enough for every file system.
std::filesystem::path temporary_name(const std::filesystem::path& target, std::random_device& random) {
  char suffix[32];
  std::snprintf(suffix, sizeof(suffix), ".%08x%08x.tmp", random(), random());
  std::string name = ".";
  name.append(target.filename().string(), 0, 100).append(suffix);
  return target.parent_path() / name;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  buffer_.reserve(buffer_size);
  open_target();
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::open_target() {
  if (path_.empty()) throw FileError("cannot write a file without a name");
  if (const auto number = descriptor_of(path_.string())) {
    descriptor_ = ::fcntl(*number, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail("open", errno);
    return;
  }
  struct stat info{};
  if (::stat(path_.c_str(), &info) != 0) {
    if (errno != ENOENT) fail("open", errno);
    if (path_.filename().empty()) fail("open", EISDIR);  // "new/" is the path of a folder, which does not exist
    const auto target = follow_links(path_);
    if (!target) fail("open", errno);
    target_ = *target;
    return open_temporary(false, 0, 0, 0);
  }
  if (S_ISDIR(info.st_mode)) fail("open", EISDIR);
  if (!S_ISREG(info.st_mode)) {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0) fail("open", errno);
    return;
  }
  // A rename would not need permission to write the old file. So check the permission: a write-protected file must not
  // be replaced.
  if (::access(path_.c_str(), W_OK) != 0) fail("open", errno);
  const auto target = follow_links(path_);
  if (!target) fail("open", errno);
  target_ = *target;
  open_temporary(true, info.st_mode & 0777U, info.st_uid, info.st_gid);
}

void AtomicFile::open_temporary(bool replaces, unsigned mode, unsigned owner, unsigned group) {
  std::random_device random;
  for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
    temporary_ = temporary_name(target_, random);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) {
    const int error = errno;
    temporary_.clear();
    fail("open", error);
  }
  if (!replaces) return;
  // Only root may change the owner, and some file systems have no owners. If the call fails, the file belongs to the
  // caller.
  [[maybe_unused]] const int owned = ::fchown(descriptor_, owner, group);
  if (::fchmod(descriptor_, static_cast<mode_t>(mode)) != 0) fail("set the permissions of", errno);
}

void AtomicFile::write(const void* data, std::size_t size) {
  if (descriptor_ < 0) throw FileError("cannot write '" + path_.string() + "': it is closed already");
  const char* bytes = static_cast<const char*>(data);
  size_ += size;
  if (buffer_.size() + size <= buffer_size) {
    buffer_.insert(buffer_.end(), bytes, bytes + size);
    return;
  }
  flush();
  if (size < buffer_size) {
    buffer_.insert(buffer_.end(), bytes, bytes + size);
  } else {
    write_through(bytes, size);
  }
}

void AtomicFile::flush() {
  write_through(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void AtomicFile::write_through(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, data, std::min(size, largest_write));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("write", errno);
    }
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::finish() {
  if (descriptor_ < 0) throw FileError("cannot write '" + path_.string() + "': it is closed already");
  flush();
  if (!temporary_.empty() && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) fail("write", errno);
  // Network file systems may report a full disk only when the file is closed.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("write", errno);
  finished_ = true;
}

void AtomicFile::commit() {
  if (!finished_) finish();
  finished_ = false;
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("replace", errno);
  temporary_.clear();
  // After the rename, every program sees the new file. It survives a power cut only if the directory is also written to
  // disk. Not every file system supports that.
  const std::filesystem::path directory = target_.has_parent_path() ? target_.parent_path() : ".";
  const int handle = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle >= 0) {
    [[maybe_unused]] const int synced = ::fsync(handle);
    ::close(handle);
  }
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::fail(std::string_view action, int error) {
  discard();
  std::string message = "cannot " + std::string(action) + " '" + path_.string() + "'";
  if (action == "open") message += " for writing";
  throw FileError(message + ": " + reason(error));
}

namespace {

namespace fs = std::filesystem;

fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path whole = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path, error).lexically_normal() : whole;
}

/// Creates a new empty file in the folder of the target of `path`.
fs::path make_draft(const fs::path& path) {
  constexpr int most_attempts = 100;
  constexpr std::size_t most_of_name = 100;
  const fs::path target = resolved(path);
  std::random_device random;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    std::ostringstream name;
    name << "." << target.stem().string().substr(0, most_of_name) << "." << std::hex << random() << random() << ".draft"
         << path.extension().string();  // extension of the given path; the target of a link may have another one
    fs::path draft = target.parent_path() / name.str();
    const int file = open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return draft;
    }
    if (errno != EEXIST) break;
  }
  throw FileError("'" + path.string() + "' cannot be written: " + std::strerror(errno));
}

}  // namespace

Draft::Draft(fs::path name) : name_(std::move(name)), draft_(make_draft(name_)) {}

Draft::~Draft() {
  std::error_code ignored;
  if (!draft_.empty()) fs::remove(draft_, ignored);
}

Draft::Draft(Draft&& other) noexcept : name_(std::move(other.name_)), draft_(std::exchange(other.draft_, {})) {}

void Draft::keep() {
  const fs::path target = resolved(name_);
  std::error_code error;
  const fs::file_status old = fs::status(target, error);
  if (fs::is_regular_file(old)) fs::permissions(draft_, old.permissions(), error);
  fs::rename(draft_, target, error);
  if (error) throw FileError("'" + name_.string() + "': " + error.message());
  draft_.clear();
}

}  // namespace blum
