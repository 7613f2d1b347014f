#include "support/emulated_backend.hpp"

#include "field/cuda/module_engine.hpp"
#include "support/emulated_platform.hpp"

namespace blum::test {

EmulatedCuda::EmulatedCuda(std::size_t slab_nodes) {
  EmulatedPlatform::wanted_slab_nodes =
      slab_nodes > 0 ? slab_nodes : kernels::FieldEngine<kernels::EmulatedDevice>::default_slab_nodes;
  cuda::replace_module(cuda::ModuleFunctions<EmulatedPlatform>::table());
}

EmulatedCuda::~EmulatedCuda() {
  cuda::replace_module(nullptr);
}

}  // namespace blum::test
