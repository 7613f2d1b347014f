// Blum: finds the CUDA module. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/cuda/module_interface.hpp"

namespace blum::cuda {

/// The module, loaded at the first call: the file that BLUM_CUDA_MODULE names, else libblum_cuda.so beside the library
/// or program that Blum is part of, else where the system looks for libraries.
/// @throws DeviceError saying where it was looked for and why it could not be loaded.
[[nodiscard]] const Module& load_module();

/// Puts another table in the module's place, for tests; nullptr restores it. What was made before keeps its own.
void replace_module(const Module* module);

}  // namespace blum::cuda
