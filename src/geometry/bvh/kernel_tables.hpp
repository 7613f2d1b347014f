// Blum: kernels for the best instruction set of the machine. SPDX-License-Identifier: Apache-2.0
//
// For files that are compiled once for each instruction set, behind their kernels, within HWY_ONCE and an unnamed
// namespace. Chosen once: the loops take tens of nanoseconds, and a look-up would be felt.
#pragma once

#include <cstddef>

#if defined(BLUM_HIGHWAY) && (HWY_TARGETS & (HWY_TARGETS - 1))
namespace blum {

/// Where the tables of functions have those of the best instruction set.
inline std::size_t best_target() {
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return hwy::GetChosenTarget().GetIndex();
}

}  // namespace blum

#define BLUM_KERNEL(kernel) \
  HWY_EXPORT(kernel);       \
  const auto best_##kernel = HWY_DISPATCH_TABLE(kernel)[best_target()]
#else
#define BLUM_KERNEL(kernel) const auto best_##kernel = &HWY_NAMESPACE::kernel
#endif
