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
  std::vector<std::size_t> rank;  ///< for each body: rank modulo 2, the least over all choices of points in its voids
  bool over_integers = false;     ///< true if they span all integer winding numbers in every body
  /// For each body: a point of a void with undecided winding numbers.
  std::vector<std::optional<Vec3d>> undecided;
};

/// Computes how often closed surfaces of an axis wind around the voids. Triangles with free edges are removed
/// repeatedly. The others are grouped into sheets, which are connected over edges of two triangles. Elimination at the
/// seams yields the cycles of sheets. Crossings of sheets with lines from the voids show how often each cycle winds
/// around each void. This is repeated for all points of each void, because a surface that passes through a void
/// encloses only some of them. Duplicate triangles are counted once.
/// @param body_of  for each vertex.
/// @throws Cancelled. Cost: linear, except for the elimination, which is cheap because sheets are few.
[[nodiscard]] Windings windings(const ComplexView& axis, const Incidence& incidence,
                                const std::vector<Vec3d>& positions, const std::vector<std::uint32_t>& body_of,
                                const Complement& complement, std::size_t body_count, const Box3& box,
                                const Context& context);

}  // namespace blum::verifier
