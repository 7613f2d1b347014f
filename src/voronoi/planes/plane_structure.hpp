// Blum: sheets, seams and junctions between the regions of planes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "voronoi/planes/convex_faces.hpp"
#include "voronoi/planes/half_spaces.hpp"

namespace blum::voronoi {

/// A convex polygon between the regions of two planes, or on one plane.
struct PlaneSheet {
  HalfSpaces::Index first = 0;
  HalfSpaces::Index second = 0;          ///< larger than `first`; the floor for polygons on the plane `first`
  std::vector<std::uint32_t> junctions;  ///< a loop, counterclockwise as seen from the region of `second`
};

/// The diagram inside a convex polyhedron. Coordinates are relative to the origin of the planes.
struct PlaneStructure {
  struct Junction {
    Vec3d at;
    double height = 0;                      ///< distance from its planes
    double condition = 0;                   ///< PlacedCorner::condition of four of its planes
    std::vector<HalfSpaces::Index> planes;  ///< ascending; the last one is the floor on the surface
  };
  std::vector<Vec3d> normals;  ///< of the planes: unit vectors that point inwards
  std::vector<Junction> junctions;
  std::vector<PlaneSheet> sheets;   ///< ascending by their planes
  std::vector<PlaneSheet> surface;  ///< one polygon on each plane
};

/// Two junctions, the smaller one first.
using JunctionEdge = std::pair<std::uint32_t, std::uint32_t>;

[[nodiscard]] inline JunctionEdge sorted_edge(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Calls visit(a, b) for each two successive junctions of a loop.
template <class Visit>
void each_edge(const std::vector<std::uint32_t>& loop, const Visit& visit) {
  for (std::size_t k = 0; k < loop.size(); ++k) visit(loop[k], loop[(k + 1) % loop.size()]);
}

/// Returns the diagram of planes, or nothing if they are not the faces of a bounded convex polyhedron, each with a
/// polygon of its own. The structure is exact; coordinates are rounded once.
///
/// A sheet consists of all vertices that touch two planes, if these are more than two. Two of its vertices share a seam
/// if they are the only ones that also touch a third plane.
/// @throws Cancelled.
[[nodiscard]] std::optional<PlaneStructure> plane_structure(const ConvexFaces& faces, const Context& context);

}  // namespace blum::voronoi
