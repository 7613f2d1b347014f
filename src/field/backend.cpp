// The one place that knows every back end.
#include "field/backend.hpp"

#include <mutex>
#include <utility>

#include "blum/core/error.hpp"
#include "field/cpu/engine.hpp"
#include "field/cuda/cuda_backend.hpp"

namespace blum {
namespace {

struct Replacement {
  std::mutex mutex;
  BackendMaker maker;
};

Replacement& replacement() {
  static Replacement value;
  return value;
}

std::unique_ptr<FieldBackend> make_cuda(int index) {
  {
    const std::scoped_lock lock(replacement().mutex);
    if (replacement().maker) return replacement().maker(index);
  }
  return cuda::make_backend(index);
}

}  // namespace

std::unique_ptr<FieldBackend> make_field_backend(const Context& context) {
  switch (context.device.kind) {
    case DeviceKind::cuda:
      return make_cuda(context.device.index);
    case DeviceKind::automatic:
      try {
        return make_cuda(0);
      } catch (const DeviceError&) {
        return std::make_unique<cpu::Engine>();
      }
    case DeviceKind::cpu:
      break;
  }
  return std::make_unique<cpu::Engine>();
}

void replace_cuda_backend(BackendMaker maker) {
  const std::scoped_lock lock(replacement().mutex);
  replacement().maker = std::move(maker);
}

}  // namespace blum
