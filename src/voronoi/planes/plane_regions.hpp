// Blum: regions of the planes of a convex polyhedron. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "voronoi/planes/convex_faces.hpp"
#include "voronoi/planes/half_spaces.hpp"

namespace blum::voronoi {

/// A point in which the regions of at least four half-spaces meet; the floor counts as one.
struct PlaneCorner {
  std::vector<HalfSpaces::Index> planes;  ///< all half-spaces that it touches, ascending
  HalfSpaces::Base base{};                ///< four of them that meet in this point only
};

/// Returns the vertices of the polytope of all half-spaces, each once, in the order of their planes.
///
/// The region of a plane is a convex polyhedron. It starts as a large box, and each other half-space cuts it. Exact
/// signs decide which vertices are cut off. Two vertices share an edge if no third vertex touches all half-spaces that
/// both touch. All vertices of a region touch its plane, so each vertex is found once for each plane that it touches.
///
/// @param is_bounded  receives false if the polytope is not bounded; then the result is empty.
/// @throws Cancelled. Cost: about 0.1 us for each pair of planes and vertex of a region.
[[nodiscard]] std::vector<PlaneCorner> plane_corners(const HalfSpaces& spaces, const ConvexFaces& faces,
                                                     bool& is_bounded, const Context& context);

}  // namespace blum::voronoi
