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
/// The region of a plane is a convex polyhedron. It starts as a large box. Each of its vertices searches for a plane
/// that it is outside of (PlaneTree). If there is one, the plane's half-space cuts the region. Otherwise, the vertex
/// knows all planes that it touches. Signs are exact. The topology of the region follows from signs alone. All vertices
/// of a region touch its plane, so each vertex is found once for each plane that it touches.
///
/// @param is_bounded  receives false if the polytope is not bounded; then the result is empty.
/// @throws Cancelled. Cost: about 30 searches for each plane. Vertices that touch k planes cost k^2 exact signs.
[[nodiscard]] std::vector<PlaneCorner> plane_corners(const HalfSpaces& spaces, const ConvexFaces& faces,
                                                     bool& is_bounded, const Context& context);

}  // namespace blum::voronoi
