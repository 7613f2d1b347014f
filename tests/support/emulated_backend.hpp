// Blum: lets the CUDA back end run its kernels on the host. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "field/cuda/load_module.hpp"
#include "support/emulated_platform.hpp"

namespace blum::test {

/// While it is alive, CUDA device 0 is the host: everything above the kernels' launches and the device's memory is what
/// runs on a CUDA device.
class EmulatedCuda {
 public:
  explicit EmulatedCuda(std::size_t slab_nodes = kernels::FieldEngine<kernels::EmulatedDevice>::default_slab_nodes) {
    EmulatedPlatform::wanted_slab_nodes = slab_nodes;
    cuda::replace_module(cuda::ModuleFunctions<EmulatedPlatform>::table());
  }
  EmulatedCuda(const EmulatedCuda&) = delete;
  EmulatedCuda& operator=(const EmulatedCuda&) = delete;
  ~EmulatedCuda() { cuda::replace_module(nullptr); }
};

}  // namespace blum::test
