// Blum: available CUDA devices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/describe.hpp"

namespace blum {

/// Available CUDA device.
struct DeviceInfo {
  std::string device;        ///< name that parse_device() reads: "cuda:0"
  std::string name;          ///< name given by its maker
  std::uint64_t memory = 0;  ///< bytes
};

template <>
struct Description<DeviceInfo> {
  static constexpr std::string_view name = "DeviceInfo";
  static constexpr std::string_view doc = "Available CUDA device";
  static constexpr std::tuple members{
      Member{"device", &DeviceInfo::device, "", "name that selects it, for example cuda:0"},
      Member{"name", &DeviceInfo::name, "", "name given by its maker"},
      Member{"memory", &DeviceInfo::memory, "bytes", "total memory"}};
};

/// Available CUDA devices.
struct CudaDevices {
  std::vector<DeviceInfo> devices;
  std::string reason;  ///< if there are none: why, in one sentence; else empty
};

template <>
struct Description<CudaDevices> {
  static constexpr std::string_view name = "CudaDevices";
  static constexpr std::string_view doc = "Available CUDA devices";
  static constexpr std::tuple members{
      Member{"devices", &CudaDevices::devices, "", "list of the devices"},
      Member{"reason", &CudaDevices::reason, "", "reason in one sentence if there are none; else empty"}};
};

/// Loads the CUDA module and returns the devices that it finds. Cost: starting CUDA, once; up to a second.
[[nodiscard]] CudaDevices cuda_devices();

}  // namespace blum
