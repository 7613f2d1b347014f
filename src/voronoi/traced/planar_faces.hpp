// Blum: flat faces of a polyhedron whose coordinates are rounded. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"

namespace blum::voronoi {

/// Sets of connected triangles that form flat faces.
struct JoinedTriangles {
  std::vector<std::uint32_t> face_of;  ///< for each triangle: the smallest triangle of its face
  std::vector<bool> is_flat;           ///< for each edge: both of its triangles are in one face
};

/// Joins triangles that face the same way and lie nearly in one plane.
/// @param vertices  of the mesh, possibly moved.
/// @param flatness  >= 0: greatest distance of a joined corner from the plane of the largest triangle is twice this.
///   Triangles that lie exactly in one plane are always joined.
[[nodiscard]] JoinedTriangles join_flat_triangles(const MeshView& mesh, std::span<const Vec3d> vertices,
                                                  const SiteTable& table, const PolyhedronSites& sites,
                                                  double flatness);

/// Moves vertices as little as possible so that all faces are flat, except for rounding. Rounded coordinates make the
/// corners of a face leave its plane, and no plane through them contains all of its edges.
///
/// Newton's method for the vertices and the planes together; the shortest step of each iteration comes from conjugate
/// gradients.
/// @return the largest distance of a corner from the plane of its face that is left.
double flatten_faces(const MeshView& mesh, const JoinedTriangles& faces, std::vector<Vec3d>& vertices);

}  // namespace blum::voronoi
