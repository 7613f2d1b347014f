// Blum: files that are checked before they get their names. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/core/error.hpp"

namespace blum {

/// Draft of a file: a file that is written, and perhaps read again, before it replaces another file. The draft is a
/// hidden file in the directory of the file to be replaced, with the same extension and a new name. If the file to be
/// replaced is a link, keep() replaces the file that the link points to. The destructor deletes the draft, unless
/// keep() was called.
class Draft {
 public:
  /// Creates an empty draft.
  /// @throws FileError if no file can be created in the directory of `name`.
  explicit Draft(std::filesystem::path name);
  ~Draft();
  Draft(Draft&& other) noexcept;
  Draft& operator=(Draft&&) = delete;
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  /// Returns the path of the draft.
  [[nodiscard]] const std::filesystem::path& path() const { return draft_; }
  /// Returns the name of the file to be replaced.
  [[nodiscard]] const std::filesystem::path& name() const { return name_; }
  /// Renames the draft to the name of the file to be replaced. If the file to be replaced exists, the draft gets the
  /// permissions of this file. May be called once.
  /// @throws FileError.
  void keep();

 private:
  std::filesystem::path name_;
  std::filesystem::path draft_;
};

}  // namespace blum
