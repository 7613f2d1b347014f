// Blum: errors of the CUDA runtime as exceptions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include <string>

#include "blum/core/error.hpp"

namespace blum::cuda {

/// Throws if a call of the CUDA runtime failed.
/// @throws OutOfMemory, DeviceError.
inline void check(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  (void)cudaGetLastError();  // clears the error; otherwise the next call would report it again
  const std::string text = std::string("CUDA: ") + what + ": " + cudaGetErrorString(status);
  if (status == cudaErrorMemoryAllocation) throw OutOfMemory(text);
  throw DeviceError(text);
}

}  // namespace blum::cuda
