// Blum: available CUDA devices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/describe.hpp"

namespace blum {

/// A CUDA device that Blum can use.
struct DeviceInfo {
  std::string device;        ///< name that parse_device() reads: "cuda:0"
  std::string name;          ///< name given by the manufacturer
  std::uint64_t memory = 0;  ///< total memory in bytes
};

template <>
struct Description<DeviceInfo> {
  static constexpr std::string_view name = "DeviceInfo";
  static constexpr std::string_view doc = "Available CUDA device";
  static constexpr std::tuple members{
      Member{"device", &DeviceInfo::device, "", "name that selects the device, for example cuda:0"},
      Member{"name", &DeviceInfo::name, "", "name given by the manufacturer"},
      Member{"memory", &DeviceInfo::memory, "bytes", "total memory"}};
};

/// All CUDA devices that Blum can use.
struct CudaDevices {
  std::vector<DeviceInfo> devices;
  std::string reason;  ///< reason in one sentence if there are no devices; otherwise empty
};

template <>
struct Description<CudaDevices> {
  static constexpr std::string_view name = "CudaDevices";
  static constexpr std::string_view doc = "Available CUDA devices";
  static constexpr std::tuple members{
      Member{"devices", &CudaDevices::devices, "", "list of the devices"},
      Member{"reason", &CudaDevices::reason, "", "reason in one sentence if there are no devices; otherwise empty"}};
};

/// Loads the CUDA module and returns the devices that it finds. Cost: the first call starts CUDA, which takes up to a
/// second.
[[nodiscard]] CudaDevices cuda_devices();

}  // namespace blum
