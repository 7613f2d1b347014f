// Blum: where tests find real shapes and images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace blum::test {

/// The folder of real shapes: the environment variable BLUM_DATA_DIR, else what CMake was given, else
/// ../shared/data beside the project. It is no part of the project, and may be absent. (Target blum_test_data.)
std::filesystem::path data_directory();

/// The file of that name in the data folder; nullopt where there is no data folder, and only then: where there is one,
/// a file that is missing in it fails the test, so that a test that needs data cannot be passed over unseen.
inline std::optional<std::filesystem::path> data_file(const std::string& name) {
  const std::filesystem::path directory = data_directory();
  std::error_code ignored;
  if (!std::filesystem::is_directory(directory, ignored)) return std::nullopt;
  std::filesystem::path file = directory / name;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    ADD_FAILURE() << "the data folder " << directory << " has no file " << name;
    return std::nullopt;
  }
  return file;
}

/// The reason to give to GTEST_SKIP. tools/results.py knows these words: with the data folder present, a test that was
/// skipped for want of data counts as failed.
inline std::string no_data(const std::string& name) {
  return "no data folder: " + name + " is not there (set BLUM_DATA_DIR)";
}

}  // namespace blum::test
