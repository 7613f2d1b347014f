// Mesh files that lead to a device were read without end (/dev/zero filled the memory): devices are refused.
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
  std::filesystem::create_symlink("/dev/null", link, error);  // ends at once, should the test ever fail
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
