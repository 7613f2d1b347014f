// Blum: a mesh that does not deform, with a hierarchy over it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/oriented_bvh.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

class RigidMesh {
 public:
  /// @param name  of the mesh in messages. @throws InvalidMesh, also for coordinates beyond 1e70; Cancelled.
  RigidMesh(const MeshView& mesh, const std::string& name, const Context& context);

  [[nodiscard]] const OrientedBvh& bvh() const { return bvh_; }
  [[nodiscard]] const Box3& bounds() const { return bvh_.bounds(); }

  /// Returns the corners of a primitive. Segments repeat a corner, and points are three equal corners.
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t primitive) const {
    const auto& [a, b, c] = primitives_[primitive];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t primitive, const RigidTransform& pose) const {
    const auto& [a, b, c] = primitives_[primitive];
    return {pose(vertices_[a]), pose(vertices_[b]), pose(vertices_[c])};
  }

  /// Returns points whose convex hull contains the mesh: its vertices, or the corners of its box if it has many.
  [[nodiscard]] const std::vector<Vec3d>& hull_points() const { return hull_points_; }

 private:
  std::vector<Vec3d> vertices_;
  std::vector<std::array<std::uint32_t, 3>> primitives_;
  std::vector<Vec3d> hull_points_;
  OrientedBvh bvh_;
};

}  // namespace blum::detail
