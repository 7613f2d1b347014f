// Proves that devices convert to the names of the tool and Python and back, and that other names are refused.
#include "blum/core/device.hpp"

#include <gtest/gtest.h>

#include "blum/core/error.hpp"

namespace blum {
namespace {

TEST(Device, NamesConvertBothWays) {
  for (const Device& device : {Device::cpu(), Device::automatic(), Device::cuda(), Device::cuda(7)}) {
    EXPECT_EQ(parse_device(to_string(device)), device);
  }
  EXPECT_EQ(parse_device("cuda"), Device::cuda(0));
  EXPECT_EQ(to_string(Device::cuda(3)), "cuda:3");
}

TEST(Device, OtherNamesAreRefused) {
  for (const char* text : {"", "gpu", "CPU", "cuda:", "cuda:-1", "cuda:+1", "cuda:1x", "cuda: 1", "cuda:99999999999"}) {
    EXPECT_THROW((void)parse_device(text), InvalidOption) << text;
  }
}

}  // namespace
}  // namespace blum
