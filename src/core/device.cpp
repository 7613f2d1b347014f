#include "blum/core/device.hpp"

#include <charconv>

#include "blum/core/error.hpp"

namespace blum {

Device parse_device(std::string_view text) {
  if (text == "cpu") return Device::cpu();
  if (text == "auto") return Device::automatic();
  if (text == "cuda") return Device::cuda();
  constexpr std::string_view prefix = "cuda:";
  if (text.starts_with(prefix)) {
    const std::string_view number = text.substr(prefix.size());
    int index = -1;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
    if (error == std::errc{} && end == number.data() + number.size() && index >= 0) return Device::cuda(index);
  }
  throw InvalidOption("device is \"" + std::string(text) +
                      "\", but must be cpu, auto, cuda, or cuda:K for device number K");
}

std::string to_string(const Device& device) {
  if (device.kind == DeviceKind::cpu) return "cpu";
  if (device.kind == DeviceKind::automatic) return "auto";
  return "cuda:" + std::to_string(device.index);
}

}  // namespace blum
