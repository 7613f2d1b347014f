// Blum: merging vertices that lie in one place. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Merges vertices with equal coordinates (-0.0 equals 0.0). With tolerance > 0, it also merges all vertices joined by
/// a chain of steps of at most `tolerance` (mesh units). A whole chain becomes one vertex, however long it is.
///
/// - A merged vertex takes the position of its member with the smallest index. The result's vertices come in the order
///   of these members, so the result depends on the input alone. Vertices that nothing names are merged and kept, too.
/// - Triangles, segments and points keep their order. The shape stays whole as a set of points, although some triangles
///   collapse by welding, or did in the input. A triangle with two equal corners (a, a, b) is removed. The segment (a,
///   b) is appended to `segments` if no other triangle or segment has that edge. A triangle or segment whose corners
///   are all one vertex is removed. The vertex is appended to `points` if nothing else names it. Vertices named
///   repeatedly in `points` are named once. Repeated triangles are all kept.
/// - Vertices with a coordinate that is not finite are merged only with exactly equal ones.
///
/// Cost: O(V + F) expected time for tolerance 0, otherwise O(V log V + F). This holds for coordinates of any size, and
/// if many vertices coincide or crowd together. A tolerance below 1e-300 counts as 0.
/// @throws InvalidOption if tolerance is negative or not finite.
/// @throws InvalidMesh if an index is out of range or there are more than max_id_count vertices.
[[nodiscard]] TriangleMesh weld(const MeshView& mesh, double tolerance = 0);

/// Returns the vertex that each vertex becomes by the rules of weld(): entry i is the smallest index of the cluster of
/// vertex i.
/// @throws as weld().
[[nodiscard]] std::vector<std::uint32_t> weld_clusters(std::span<const Vec3d> vertices, double tolerance = 0);

}  // namespace blum
