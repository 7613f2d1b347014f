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

/// Joins triangles that face the same way and lie nearly in one plane.
/// @param vertices  of the mesh, possibly moved.
/// @param flatness  >= 0: greatest distance of a joined corner from the plane of the largest triangle is twice this.
///   Triangles that lie exactly in one plane are always joined.
/// @return for each triangle: the smallest triangle of its face.
[[nodiscard]] std::vector<std::uint32_t> join_flat_triangles(const MeshView& mesh, std::span<const Vec3d> vertices,
                                                             const SiteTable& table, const PolyhedronSites& sites,
                                                             double flatness);

/// Moves vertices as little as possible so that all faces are flat, except for rounding. Rounded coordinates make the
/// corners of a face leave its plane, and no plane through them contains all of its edges.
///
/// Newton's method for the vertices and the planes together; the shortest step of each iteration comes from conjugate
/// gradients.
/// @param face_of  as join_flat_triangles() returns it.
/// @return the largest distance of a corner from the plane of its face that is left.
double flatten_faces(const MeshView& mesh, std::span<const std::uint32_t> face_of, std::vector<Vec3d>& vertices);

}  // namespace blum::voronoi
