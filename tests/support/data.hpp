// Blum: paths of real shapes and images for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace blum::test {

/// The folder of real shapes: the environment variable BLUM_DATA_DIR, else the folder given to CMake, else
/// ../shared/data beside the project. The project does not contain it, and it may be absent. Target: blum_test_data.
std::filesystem::path data_directory();

/// The file of that name in the data folder; nullopt only if the data folder is absent. If the folder exists but the
/// file does not, the test fails, so that no test that needs data is skipped unnoticed.
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

/// The reason for GTEST_SKIP. tools/results.py recognises its words: if the data folder is present, a test skipped for
/// lack of data counts as failed.
inline std::string no_data(const std::string& name) {
  return "no data folder: " + name + " is not there (set BLUM_DATA_DIR)";
}

}  // namespace blum::test
