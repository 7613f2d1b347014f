// Chooses the back end for a device. Only this file names all back ends.
#include "field/backend.hpp"

#include "blum/core/error.hpp"
#include "field/cpu/engine.hpp"
#include "field/cuda/cuda_backend.hpp"

namespace blum {
namespace {

/// Returns make_cuda(index) for a CUDA device and make_cpu() for the CPU. For `automatic`, tries CUDA device 0 first.
/// If that fails, writes the error to `reason` and returns make_cpu().
template <class MakeCuda, class MakeCpu>
auto make_on(const Device& device, const MakeCuda& make_cuda, const MakeCpu& make_cpu, std::string& reason) {
  if (device.kind == DeviceKind::cuda) return make_cuda(device.index);
  if (device.kind == DeviceKind::automatic) {
    try {
      return make_cuda(0);
    } catch (const DeviceError& error) {
      reason = error.what();
    } catch (const OutOfMemory& error) {  // device memory may be short because other processes fill it
      reason = error.what();
    }
  }
  return make_cpu();
}

}  // namespace

std::unique_ptr<FieldBackend> make_field_backend(const Context& context, int order, std::string& reason) {
  if (order == 2) {
    if (context.device.kind == DeviceKind::cuda) {
      throw InvalidOption("fields of order 2 are computed on the CPU only, not on " + to_string(context.device) +
                          ": ask for the device 'cpu' or 'auto'");
    }
    if (context.device.kind == DeviceKind::automatic) reason = "fields of order 2 are computed on the CPU only";
    return std::make_unique<cpu::Engine>();
  }
  return make_on(
      context.device, cuda::make_field_backend,
      []() -> std::unique_ptr<FieldBackend> { return std::make_unique<cpu::Engine>(); }, reason);
}

std::unique_ptr<ImageBackend> make_image_backend(const Context& context, std::string& reason) {
  return make_on(
      context.device, cuda::make_image_backend, []() -> std::unique_ptr<ImageBackend> { return nullptr; }, reason);
}

}  // namespace blum
