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
  static constexpr std::string_view doc = "A CUDA device that can be asked for";
  static constexpr std::tuple members{Member{"device", &DeviceInfo::device, "", "what it is asked for by"},
                                      Member{"name", &DeviceInfo::name, "", "as its maker calls it"},
                                      Member{"memory", &DeviceInfo::memory, "bytes", "what it holds"}};
};

/// Available CUDA devices.
struct CudaDevices {
  std::vector<DeviceInfo> devices;
  std::string reason;  ///< if there are none: why, in one sentence; else empty
};

template <>
struct Description<CudaDevices> {
  static constexpr std::string_view name = "CudaDevices";
  static constexpr std::string_view doc = "The CUDA devices that there are";
  static constexpr std::tuple members{
      Member{"devices", &CudaDevices::devices, "", "each of them"},
      Member{"reason", &CudaDevices::reason, "", "why there are none, in one sentence; empty where there are some"}};
};

/// Loads the CUDA module and returns the devices that it finds. Cost: starting CUDA, once; up to a second.
[[nodiscard]] CudaDevices cuda_devices();

}  // namespace blum
