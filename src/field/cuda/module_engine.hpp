// Blum: calls into the CUDA module. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "field/cuda/module_interface.hpp"

namespace blum::cuda {

/// Returns the module. The first call loads it. If BLUM_CUDA_MODULE is set, it is the path of the file. Otherwise
/// libblum_cuda.so is searched beside the library or program that contains Blum, then in the system's library folders.
/// @throws DeviceError if the module cannot be loaded. Its message lists the places searched and the reasons.
[[nodiscard]] const Module& load_module();

/// Replaces the module by another function table, for tests; nullptr restores it. Existing engines keep their table.
void replace_module(const Module* module);

[[nodiscard]] Call call_of(const Context& context);
/// Throws the error for a status; does nothing for Status::done.
/// @throws Error.
void check(Status status, const Call& call);

/// Engine of the module on one device. Destroys it at the end.
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

  /// Calls a function of the module with the engine, the arguments and a Call. Throws if it fails.
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
