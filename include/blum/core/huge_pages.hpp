// Blum: large lists in huge pages. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace blum::detail {

/// Asks the system to use huge pages for memory that has not been read or written yet. A huge page causes one page
/// fault, instead of one for each of the 512 small pages that it replaces. Has no effect on blocks below 4 MB, or if
/// the system has no huge pages.
void request_huge_pages(void* memory, std::size_t bytes);

/// Returns a list of `size` entries with their default values, in huge pages if it is large.
template <class T>
[[nodiscard]] std::vector<T> large_list(std::size_t size) {
  std::vector<T> out;
  out.reserve(size);
  request_huge_pages(out.data(), size * sizeof(T));
  out.resize(size);
  return out;
}

}  // namespace blum::detail
