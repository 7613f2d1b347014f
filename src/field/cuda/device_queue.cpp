#include "field/cuda/device_queue.hpp"

#include <cstddef>
#include <memory>

#include "blum/core/error.hpp"

namespace blum::cuda {

int cuda_index(const Device& device) {
  if (device.kind == DeviceKind::cuda) return device.index;
  if (device.kind == DeviceKind::automatic) return 0;
  throw InvalidOption(
      "memory of a CUDA device is requested, but the device is the CPU: use FieldSolver or distance_transform() for "
      "host memory");
}

}  // namespace blum::cuda

namespace blum {

DeviceMemory::DeviceMemory(const Device& device, std::size_t bytes) : size_(bytes) {
  const int index = cuda::cuda_index(device);
  const cuda::Module& module = cuda::load_module();
  void* memory = nullptr;
  cuda::Call call;
  cuda::check(module.allocate(index, bytes, &memory, &call), call);
  data_ = std::shared_ptr<void>(memory, [index, release = module.release](void* own) { release(index, own); });
}

}  // namespace blum
