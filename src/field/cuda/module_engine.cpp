#include "field/cuda/module_engine.hpp"

#include "blum/core/error.hpp"

namespace blum::cuda {

Call call_of(const Context& context) {
  Call call;
  call.context = &context;
  call.is_cancelled = [](const void* of) { return static_cast<const Context*>(of)->cancel.stop_requested(); };
  call.report = [](const void* of, double fraction) {
    const auto& progress = static_cast<const Context*>(of)->progress;
    if (progress) progress(fraction, "field");
  };
  return call;
}

void check(Status status, const Call& call) {
  switch (status) {
    case Status::done:
      return;
    case Status::out_of_memory:
      throw OutOfMemory(call.message);
    case Status::invalid_mesh:
      throw InvalidMesh(call.message);
    case Status::invalid_grid:
      throw InvalidGrid(call.message);
    case Status::invalid_option:
      throw InvalidOption(call.message);
    case Status::cancelled:
      throw Cancelled();
    case Status::device_error:
      break;
  }
  throw DeviceError(call.message);
}

}  // namespace blum::cuda
