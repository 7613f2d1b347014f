// Blum: what vertices and triangles of an axis are by its edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/union_find.hpp"

namespace blum::detail {

/// The end of an edge that is not this one.
inline std::uint32_t other_end(const std::array<std::uint32_t, 2>& edge, std::uint32_t v) {
  return edge[0] == v ? edge[1] : edge[0];
}
/// The corner of a triangle that is not on its side.
inline std::uint32_t third_corner(const std::array<std::uint32_t, 3>& triangle,
                                  const std::array<std::uint32_t, 2>& side) {
  return triangle[0] ^ triangle[1] ^ triangle[2] ^ side[0] ^ side[1];
}

/// What the edges at a vertex are.
struct Kind {
  std::uint32_t rims = 0, seams = 0, curves = 0, inner = 0;

  [[nodiscard]] bool is_rim() const { return rims == 2 && seams == 0 && curves == 0; }
  [[nodiscard]] bool is_seam() const { return seams == 2 && rims == 0 && curves == 0; }
  [[nodiscard]] bool is_seam_end() const { return seams == 1 && rims > 0 && curves == 0; }
  [[nodiscard]] bool is_curve() const { return curves == 2 && rims + seams + inner == 0; }
  [[nodiscard]] bool is_curve_end() const { return curves == 1 && rims + seams + inner == 0; }
  [[nodiscard]] bool is_junction() const { return seams > 2 || (seams > 0 && curves > 0); }
};

/// Which triangles are of one sheet: those that edges of exactly two triangles join.
inline detail::UnionFind sheets_of(const Incidence& incidence) {
  detail::UnionFind sheets(incidence.sides().size());
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    const auto at = incidence.triangles_of_edge()[e];
    if (at.size() == 2) sheets.join(at[0], at[1]);
  }
  return sheets;
}

/// @param incidence  of a complex of so many vertices.
inline std::vector<Kind> kinds_of(const Incidence& incidence, std::size_t vertices) {
  std::vector<Kind> kinds(vertices);
  for (std::uint32_t e = 0; e < incidence.edges().size(); ++e) {
    const std::size_t count = incidence.triangles_of_edge()[e].size();
    for (const std::uint32_t v : incidence.edges()[e]) {
      ++(count == 0 ? kinds[v].curves : count == 1 ? kinds[v].rims : count == 2 ? kinds[v].inner : kinds[v].seams);
    }
  }
  return kinds;
}

}  // namespace blum::detail
