#include "blum/io/draft.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>
#include <sstream>
#include <system_error>
#include <utility>

namespace blum {
namespace {

namespace fs = std::filesystem;

fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path whole = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path, error).lexically_normal() : whole;
}

/// A new empty file beside `path`.
fs::path make_draft(const fs::path& path) {
  constexpr int most_attempts = 100;
  constexpr std::size_t most_of_name = 100;
  const fs::path target = resolved(path);
  std::random_device random;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    std::ostringstream name;
    name << "." << target.stem().string().substr(0, most_of_name) << "." << std::hex << random() << random() << ".draft"
         << path.extension().string();  // what was asked for, which a link may lead away from
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
