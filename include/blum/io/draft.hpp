// Blum: files that are looked at before they get their names. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/core/error.hpp"

namespace blum {

/// A file that is written, and perhaps read again, before it takes the place of another: hidden, beside it, with the
/// same extension, under a name that no file had. A link is followed, so that the draft can take the place of what it
/// points to. Gone with the object, unless it was kept.
class Draft {
 public:
  /// Makes an empty file. @throws FileError where none can be made beside `name`.
  explicit Draft(std::filesystem::path name);
  ~Draft();
  Draft(Draft&& other) noexcept;
  Draft& operator=(Draft&&) = delete;
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  /// Of the draft.
  [[nodiscard]] const std::filesystem::path& path() const { return draft_; }
  /// Whose place it is to take.
  [[nodiscard]] const std::filesystem::path& name() const { return name_; }
  /// Lets the draft take the place of the file, whose permissions it gets where there is one. To be called once.
  /// @throws FileError
  void keep();

 private:
  std::filesystem::path name_;
  std::filesystem::path draft_;
};

}  // namespace blum
