// Proves that mesh files that lead to a device are refused. Without this check, /dev/zero filled the memory.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "blum/core/error.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum {
namespace {

TEST(RegressionDeviceInput, RefusesDevices) {
  const std::filesystem::path link = std::filesystem::path(::testing::TempDir()) / "blum_device_input_test.obj";
  std::filesystem::remove(link);
  std::error_code error;
  std::filesystem::create_symlink("/dev/null", link, error);  // /dev/null ends at once if the test fails
  if (error) GTEST_SKIP() << "no symbolic links here";
  std::string message;
  try {
    (void)read_mesh(link);
  } catch (const Error& e) {
    message = e.what();
  }
  std::filesystem::remove(link);
  EXPECT_NE(message.find("it is a device"), std::string::npos) << message;
}

}  // namespace
}  // namespace blum
