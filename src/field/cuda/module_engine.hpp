// Blum: calls into the CUDA module. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "field/cuda/load_module.hpp"

namespace blum::cuda {

[[nodiscard]] Call call_of(const Context& context);
/// Throws what a status stands for. @throws Error.
void check(Status status, const Call& call);

/// An engine of the module on one device.
class ModuleEngine {
 public:
  /// @throws DeviceError, OutOfMemory.
  explicit ModuleEngine(int index) : module_(load_module()) {
    Call call;
    check(module_.create(index, &engine_, &call), call);
  }
  ModuleEngine(const ModuleEngine&) = delete;
  ModuleEngine& operator=(const ModuleEngine&) = delete;
  ~ModuleEngine() { module_.destroy(engine_); }

  /// Calls a function of the module with the engine, arguments and a call.
  template <class Function, class... Arguments>
  void run(Function function, const Context& context, Arguments... arguments) const {
    Call call = call_of(context);
    check((module_.*function)(engine_, arguments..., &call), call);
  }

 private:
  const Module& module_;
  void* engine_ = nullptr;
};

}  // namespace blum::cuda
