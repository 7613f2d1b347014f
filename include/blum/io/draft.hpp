// Blum: files that are checked before they get their names. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/core/error.hpp"

namespace blum {

/// File that is written, and perhaps read again, before it replaces another one. It is hidden, lies beside the other
/// file, and has the same extension and a new name. A link is followed, so that the draft can replace the file that it
/// points to. The file is deleted with the object, unless it was kept.
class Draft {
 public:
  /// Makes an empty file.
  /// @throws FileError if none can be made beside `name`.
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
  /// Moves the draft to the name of the file, and gives it the permissions of an existing file. May be called once.
  /// @throws FileError.
  void keep();

 private:
  std::filesystem::path name_;
  std::filesystem::path draft_;
};

}  // namespace blum
