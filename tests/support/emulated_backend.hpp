// Blum: lets the CUDA back end run its kernels on the host. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace blum::test {

/// During its lifetime, CUDA device 0 is the host. Only kernel launches and device memory differ from a CUDA device.
class EmulatedCuda {
 public:
  /// @param slab_nodes  nodes per slab of a field; 0: as many as on a device.
  explicit EmulatedCuda(std::size_t slab_nodes = 0);
  EmulatedCuda(const EmulatedCuda&) = delete;
  EmulatedCuda& operator=(const EmulatedCuda&) = delete;
  ~EmulatedCuda();
};

}  // namespace blum::test
