// Blum: the closed surfaces of an axis and the voids in them, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/homology/complement.hpp"
#include "certificate/homology/elimination.hpp"

namespace blum::verifier {

/// Winding numbers of the closed surfaces of an axis.
struct Windings {
  std::vector<std::size_t> rank;  ///< in each body, modulo 2: the least over all choices of points in its voids
  bool over_integers = false;     ///< true if they span all integer ones, in every body
  /// For each body, a point of a void left undecided by triangles through its points.
  std::vector<std::optional<Vec3d>> undecided;
};

/// Computes how often closed surfaces of an axis wind around the voids. Triangles with free edges are removed
/// repeatedly. The rest is grouped into sheets over edges of two triangles. Elimination at the seams yields the cycles
/// of sheets. Crossings of lines from the voids count how often each cycle winds around each void. That is done for all
/// points of the voids, because a surface through a void is around some of them only. Duplicate triangles count once.
/// @param body_of  of each vertex.
/// @throws Cancelled. Cost: linear, except for the elimination: sheets are few.
[[nodiscard]] Windings windings(const ComplexView& axis, const Incidence& incidence,
                                const std::vector<Vec3d>& positions, const std::vector<std::uint32_t>& body_of,
                                const Complement& complement, std::size_t body_count, const Box3& box,
                                const Context& context);

}  // namespace blum::verifier
