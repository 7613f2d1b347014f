#include "blum/field/cuda_devices.hpp"

#include <array>

#include "blum/core/device.hpp"
#include "blum/core/error.hpp"
#include "field/cuda/module_engine.hpp"

namespace blum {

CudaDevices cuda_devices() {
  CudaDevices out;
  try {
    const cuda::Module& module = cuda::load_module();
    for (int index = 0;; ++index) {
      std::array<char, 256> name{};
      std::uint64_t memory = 0;
      cuda::Call call;
      cuda::check(module.describe_device(index, name.data(), name.size(), &memory, &call), call);
      out.devices.push_back({to_string(Device::cuda(index)), name.data(), memory});
    }
  } catch (const DeviceError& error) {  // also thrown for the index after the last device
    if (out.devices.empty()) out.reason = error.what();
  }
  return out;
}

}  // namespace blum
