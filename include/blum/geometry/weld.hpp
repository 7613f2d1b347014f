// Blum: merging vertices that lie in one place. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Merges vertices: those with equal coordinates (-0.0 equals 0.0), or with tolerance > 0 also all that a chain of
/// steps no longer than `tolerance` (mesh units) joins, so a whole chain becomes one vertex however long it is.
///
/// - A merged vertex takes the position of its member with the smallest index. The result's vertices come in the order
///   of these members, so the result depends on the input alone. Vertices that nothing names are merged and kept too.
/// - Triangles, segments and points keep their order. What welding (or the input) has collapsed is replaced such that
///   the shape as a set of points stays whole: a triangle with two equal corners (a, a, b) is left out, and becomes the
///   segment (a, b) at the end of `segments` if no other triangle or segment has that edge; a triangle or segment whose
///   corners are all one vertex is left out, and becomes an entry of `points` if nothing else names that vertex.
///   Vertices named more than once in `points` are named once. Repeated triangles are all kept.
/// - Vertices with a coordinate that is not finite are merged only with exactly equal ones.
///
/// Cost: O(V + F) expected time for tolerance 0; O(V log V + F) otherwise, also where many vertices coincide or crowd
/// together, and for any size of coordinates. A tolerance below 1e-300 counts as 0.
/// @throws InvalidOption when tolerance is negative or not finite.
/// @throws InvalidMesh when an index is out of range or there are more than max_id_count vertices.
[[nodiscard]] TriangleMesh weld(const MeshView& mesh, double tolerance = 0);

/// Which vertex each vertex becomes, under the rules of weld(): entry i is the smallest index of the cluster of vertex
/// i.
/// @throws as weld().
[[nodiscard]] std::vector<std::uint32_t> weld_clusters(std::span<const Vec3d> vertices, double tolerance = 0);

}  // namespace blum
