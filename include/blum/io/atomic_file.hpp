// Blum: output files that appear complete or not at all. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace blum {

/// Writes a file so that no reader ever finds an incomplete file under its name.
///
/// The bytes are written to a temporary file in the directory of the target. Then commit() flushes this file to the
/// disk and renames it, so that it replaces the target. If commit() is not called, the temporary file is removed and an
/// existing target is unchanged. The new file gets the permissions of the replaced file, and its owner and group if the
/// system allows it. If the target is a symbolic link, the link is kept, and the file that the link points to is
/// replaced or created. A target that is not a regular file (/dev/null, /dev/stdout, a pipe) is written directly, and
/// cannot be restored. A target that is a directory, or that may not be written, is rejected at once.
///
/// Small writes are collected in a buffer of 256 KiB. An object must not be used by several threads at the same time.
class AtomicFile {
 public:
  /// @throws FileError if the file cannot be created. The message contains the path and the system's reason.
  explicit AtomicFile(std::filesystem::path path);
  /// Removes the temporary file unless commit() succeeded. Never throws.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;

  /// Appends `size` bytes.
  /// @throws FileError if the system reports an error, such as a full disk, or after finish() or commit().
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Flushes all written bytes to the disk and closes the file, so that commit() only has to rename it. Call finish()
  /// for several files that should appear together. May be called once, before commit(). If finish() is not called,
  /// commit() also flushes and closes the file.
  /// @throws FileError in the same cases as commit().
  void finish();

  /// Makes the file appear under its name, with all bytes that were written. May be called once.
  /// @throws FileError if this call or an earlier write failed. The target is then unchanged, unless it is written
  /// directly.
  void commit();

  /// Returns the path that was passed to the constructor.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Returns the number of bytes written so far, including those in the buffer.
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  void open_target();
  void open_temporary(bool replaces, unsigned mode, unsigned owner, unsigned group);
  void flush();
  void write_through(const char* data, std::size_t size);
  void discard() noexcept;
  [[noreturn]] void fail(std::string_view action, int error);

  std::filesystem::path path_;
  std::filesystem::path target_;     ///< path_ with links followed
  std::filesystem::path temporary_;  ///< empty if the target is written directly
  std::vector<char> buffer_;
  std::size_t size_ = 0;
  int descriptor_ = -1;
  bool finished_ = false;  ///< true after finish(), until commit()
};

}  // namespace blum
