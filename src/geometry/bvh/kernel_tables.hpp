// Blum: kernels for the machine's best instruction set. SPDX-License-Identifier: Apache-2.0
//
// Helper for files that are compiled once per instruction set. Include it after their kernels, within HWY_ONCE and an
// unnamed namespace. Each kernel's function is chosen once. Loops take only tens of nanoseconds, so choosing it in each
// call would cost noticeable time.
#pragma once

#include <cstddef>

#if defined(BLUM_HIGHWAY) && (HWY_TARGETS & (HWY_TARGETS - 1))
namespace blum {

/// Returns the index of the machine's best instruction set in the tables of functions.
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
