// Blum: which triangles of an axis make up a sheet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/union_find.hpp"

namespace blum {

/// Two triangles that share an edge with no other.
struct Hinge {
  std::array<std::uint32_t, 2> vertices;
  std::array<std::uint32_t, 2> triangles;
};

/// Joins triangles at hinges, but for those beside seams where two sheets meet. Where seams lie a step beside the
/// crease of two sheets, first on one side of it and then on the other, the two hang together at the step. So beside
/// seams nothing is joined where the axis bends by 37 degrees or more, at the hinge or between what lies on either side
/// a few triangles away from the seam; unless that is only a few triangles, which go to the neighbour that they are
/// flattest with.
/// @param axis  whose edges have roles.
[[nodiscard]] detail::UnionFind join_sheets(const Complex& axis, const std::vector<Hinge>& hinges);

}  // namespace blum
