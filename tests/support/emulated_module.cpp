// A shared library that replaces the CUDA module in tests; its kernels run on the host. If BLUM_CUDA_MODULE names it,
// the tool and the Python package find a CUDA device.
#include "support/emulated_platform.hpp"

extern "C" __attribute__((visibility("default"))) const blum::cuda::Module* blum_cuda_module() {
  return blum::cuda::ModuleFunctions<blum::test::EmulatedPlatform>::table();
}
