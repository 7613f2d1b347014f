// Blum: an engine of the CUDA module that works on memory of the caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "blum/core/context.hpp"
#include "blum/core/device.hpp"
#include "blum/field/device_memory.hpp"
#include "field/cuda/module_engine.hpp"

namespace blum::cuda {

/// Returns the index of the requested CUDA device.
/// @throws InvalidOption for the CPU.
[[nodiscard]] int cuda_index(const Device& device);

/// Base of the solvers that keep results on a device (device_*.hpp).
class DeviceQueue {
 public:
  /// @throws DeviceError, OutOfMemory, InvalidOption.
  explicit DeviceQueue(const Device& device) : index_(cuda_index(device)), engine_(index_) {}

  [[nodiscard]] Device device() const { return Device::cuda(index_); }

  template <class Function, class... Arguments>
  void run(Function function, Arguments... arguments) const {
    engine_.run(function, Context{}, arguments...);
  }
  [[nodiscard]] DeviceProgress progress() const {
    DeviceProgress progress;
    run(&Module::progress, &progress.queued, &progress.finished);
    return progress;
  }
  void follow(std::uint64_t pieces, void* stream) const { run(&Module::follow, pieces, stream); }
  [[nodiscard]] std::optional<Device> device_of(const void* memory) const {
    int index = -1;
    run(&Module::device_of, memory, &index);
    return index < 0 ? std::nullopt : std::make_optional(Device::cuda(index));
  }
  void order(void* before, void* after) const { run(&Module::order, before, after); }

 private:
  int index_;
  ModuleEngine engine_;
};

}  // namespace blum::cuda
