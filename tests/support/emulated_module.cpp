// A shared library in the CUDA module's place, whose kernels run on the host: with BLUM_CUDA_MODULE naming it, the tool
// and the Python package have a CUDA device, for tests.
#include "support/emulated_platform.hpp"

extern "C" __attribute__((visibility("default"))) const blum::cuda::Module* blum_cuda_module() {
  return blum::cuda::ModuleFunctions<blum::test::EmulatedPlatform>::table();
}
