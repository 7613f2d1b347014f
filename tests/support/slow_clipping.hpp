// Blum: a solid cut by half spaces, slowly and plainly, to compare with. SPDX-License-Identifier: Apache-2.0
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

/// A flat part of a surface between loops, which it lies to the left of, seen from outside.
struct FlatFace {
  std::size_t axis = 3;  ///< across which it lies, for what closes a cut; else it is a part of a triangle
  std::vector<VertexLoop> loops;
};

/// A part of a solid: its closed surface.
struct SolidPart {
  std::vector<Vec3d> vertices;
  std::vector<FlatFace> faces;
  bool is_sure = true;  ///< false where something is so thin that rounding may have changed it
};

[[nodiscard]] SolidPart whole_solid(const TriangleMesh& mesh);

/// The part of a solid on one side of a plane across an axis; what lies in the plane counts as above. Every edge of the
/// surface that passes the plane gets a vertex there, every face is cut from vertex to vertex, and what these cuts
/// surround is closed by a face.
[[nodiscard]] SolidPart cut_by_plane(const SolidPart& part, std::size_t axis, double plane, bool keep_above);

/// What the part of a solid in a cube is like.
struct PartShape {
  bool is_sure = true;
  std::size_t components = 0;
  std::size_t voids = 0;
  std::vector<int> shells;                ///< Euler number of each boundary component
  std::array<std::vector<int>, 6> sides;  ///< of each component in the cube's sides: below, above, along x, y, z

  /// Whether all components, and those in the sides, are contractible.
  [[nodiscard]] bool passes() const;
};

/// @param high  the upper corner of the cube that the part was cut to.
[[nodiscard]] PartShape shape_of(const SolidPart& part, const Vec3d& high);

/// Cuts the solid of a closed mesh into the cubes between planes and calls visit for each, with the place of its lower
/// corner.
void for_each_cube(const TriangleMesh& mesh, const detail::GridPlanes& planes,
                   const std::function<void(const detail::Place&, const PartShape&)>& visit);

}  // namespace blum::test
