// Blum: simple, slow clipping of a solid by half spaces, as a reference. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "solid/model/grid_planes.hpp"

namespace blum::test {

using VertexLoop = std::vector<std::uint32_t>;

/// A flat part of a surface. It lies to the left of its loops, seen from outside.
struct FlatFace {
  std::size_t axis = 3;  ///< normal axis of a face that closes a cut; 3: part of a triangle
  std::vector<VertexLoop> loops;
};

/// A part of a solid: its closed surface.
struct SolidPart {
  std::vector<Vec3d> vertices;
  std::vector<FlatFace> faces;
  bool is_sure = true;  ///< false if rounding may have changed thin parts
};

[[nodiscard]] SolidPart whole_solid(const TriangleMesh& mesh);

/// The part of a solid on one side of a plane perpendicular to an axis. Points in the plane count as above. Each edge
/// that passes the plane gets a vertex there, and faces are cut from vertex to vertex. New faces close the cut.
[[nodiscard]] SolidPart cut_by_plane(const SolidPart& part, std::size_t axis, double plane, bool keep_above);

/// The topology of the part of a solid in a cube.
struct PartShape {
  bool is_sure = true;
  std::size_t components = 0;
  std::size_t voids = 0;
  std::vector<int> shells;                ///< Euler number of each component of the boundary
  std::array<std::vector<int>, 6> sides;  ///< of components in the cube's sides: below, above, along x, y, z

  /// True if all components, also those in the sides, are contractible.
  [[nodiscard]] bool passes() const;
};

/// @param high  the upper corner of the cube that contains the part.
[[nodiscard]] PartShape shape_of(const SolidPart& part, const Vec3d& high);

/// Cuts the solid of a closed mesh into the cubes between planes. Calls visit(place of the lower corner, shape) for
/// each cube.
void for_each_cube(const TriangleMesh& mesh, const detail::GridPlanes& planes,
                   const std::function<void(const detail::Place&, const PartShape&)>& visit);

}  // namespace blum::test
