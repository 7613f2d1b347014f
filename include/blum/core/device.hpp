// Blum: the device on which a call computes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace blum {

enum class DeviceKind : std::uint8_t {
  cpu,
  automatic,  ///< the first CUDA device if one works, else the CPU
  cuda
};

/// Device on which a call computes, as a value.
struct Device {
  DeviceKind kind = DeviceKind::cpu;
  int index = 0;  ///< number of a CUDA device among the visible ones, as the CUDA runtime counts; >= 0

  [[nodiscard]] static constexpr Device cpu() { return {}; }
  [[nodiscard]] static constexpr Device automatic() { return {DeviceKind::automatic, 0}; }
  [[nodiscard]] static constexpr Device cuda(int index = 0) { return {DeviceKind::cuda, index}; }
  [[nodiscard]] friend constexpr bool operator==(const Device&, const Device&) = default;
};

/// Reads "cpu", "auto", "cuda" (the first) or "cuda:K". @throws InvalidOption.
[[nodiscard]] Device parse_device(std::string_view text);
/// Returns the text that parse_device() reads as this device.
[[nodiscard]] std::string to_string(const Device& device);

}  // namespace blum
