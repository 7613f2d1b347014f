// Blum: the device on which a call computes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace blum {

enum class DeviceKind : std::uint8_t {
  cpu,
  automatic,  ///< the first CUDA device if it works, otherwise the CPU
  cuda
};

/// Device on which a call computes.
struct Device {
  DeviceKind kind = DeviceKind::cpu;
  int index = 0;  ///< index of a CUDA device, as the CUDA runtime counts visible devices; >= 0

  [[nodiscard]] static constexpr Device cpu() { return {}; }
  [[nodiscard]] static constexpr Device automatic() { return {DeviceKind::automatic, 0}; }
  [[nodiscard]] static constexpr Device cuda(int index = 0) { return {DeviceKind::cuda, index}; }
  [[nodiscard]] friend constexpr bool operator==(const Device&, const Device&) = default;
};

/// Returns the device for "cpu", "auto", "cuda" (the first CUDA device) or "cuda:K". @throws InvalidOption for other
/// texts.
[[nodiscard]] Device parse_device(std::string_view text);
/// Returns the text that parse_device() reads as this device.
[[nodiscard]] std::string to_string(const Device& device);

}  // namespace blum
