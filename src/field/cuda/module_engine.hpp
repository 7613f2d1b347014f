// Blum: calls into the CUDA module. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "field/cuda/module_interface.hpp"

namespace blum::cuda {

/// The module, loaded at the first call: the file that BLUM_CUDA_MODULE names, else libblum_cuda.so beside the library
/// or program that Blum is part of, else where the system looks for libraries.
/// @throws DeviceError saying where it was looked for and why it could not be loaded.
[[nodiscard]] const Module& load_module();

/// Puts another table in the module's place, for tests; nullptr restores it. What was made before keeps its own.
void replace_module(const Module* module);

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
