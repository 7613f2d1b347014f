// Blum: merging vertices at the same position. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Merges vertices with equal coordinates (-0.0 equals 0.0). With tolerance > 0, it also merges vertices that are at
/// most `tolerance` (mesh units) apart. Merging continues along chains. If each vertex of a chain is at most
/// `tolerance` away from the next vertex, the whole chain becomes one vertex. Chains may have any length.
///
/// - A merged vertex has the position of the original vertex with the smallest index. The vertices of the result are in
///   the order of these indices, so the result depends on the input alone. Vertices that no triangle, segment or point
///   uses are merged and kept, too.
/// - Triangles, segments and points keep their order. The shape loses no points, even if triangles are degenerate after
///   welding. A triangle with two equal corners (a, a, b) is removed. The segment (a, b) is appended to `segments` if
///   no other triangle or segment has this edge. A triangle or segment whose corners are all the same vertex is
///   removed. The vertex of a removed element is appended to `points` if nothing else uses this vertex. Repeated
///   vertices in `points` are kept once. Repeated triangles are all kept.
/// - Vertices with a coordinate that is not finite are merged only with vertices at exactly the same position.
///
/// Cost: O(V + F) expected time for V vertices and F triangles if tolerance is 0, otherwise O(V log V + F). The cost is
/// the same for coordinates of any magnitude, and for many vertices that coincide or are close together. A tolerance
/// below 1e-300 counts as 0.
/// @throws InvalidOption if tolerance is negative or not finite.
/// @throws InvalidMesh if an index is out of range or there are more than max_id_count vertices.
[[nodiscard]] TriangleMesh weld(const MeshView& mesh, double tolerance = 0);

/// Returns the clusters of vertices that weld() merges. Entry i is the smallest vertex index in the cluster of vertex
/// i.
/// @throws as weld().
[[nodiscard]] std::vector<std::uint32_t> weld_clusters(std::span<const Vec3d> vertices, double tolerance = 0);

}  // namespace blum
