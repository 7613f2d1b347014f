// Blum: on which side of a surface points lie. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/geometry/winding_number.hpp"
#include "solid/polyhedron.hpp"

namespace blum::detail {

/// Tells whether points lie in what a mesh bounds; see Solid::inside().
class PointLocation {
 public:
  explicit PointLocation(const MeshSolid& solid);

  [[nodiscard]] bool contains(const Vec3d& p) const;

 private:
  /// Whether the winding number counted along a ray is above 0, or the point lies on the surface of a polyhedron;
  /// nullopt where the ray meets an edge, so that this one does not tell.
  [[nodiscard]] std::optional<bool> contains_along(const Vec3d& p, const Vec3d& direction) const;

  bool is_polyhedron_;
  TriangleMesh mesh_;  ///< all bodies
  std::optional<Bvh> bvh_;
  std::optional<WindingNumber> winding_;  ///< of meshes that are not closed
};

}  // namespace blum::detail
