// Blum: the common part of solids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Returns, for each edge, the triangles that contain it. The smaller end of an edge is its first.
/// @param triangles  the triangles to consider.
[[nodiscard]] std::map<Edge, std::vector<std::uint32_t>> triangles_at_edges(const MeshView& mesh,
                                                                            std::span<const std::uint32_t> triangles);

/// The border of the overlap of two solids, or of one solid that meets itself. Each of its triangles is a part of a
/// triangle of the solids' surfaces.
struct Overlap {
  TriangleMesh mesh;
  std::vector<std::uint32_t> source;   ///< for each triangle, the triangle of the surfaces that it is a part of
  std::vector<std::uint32_t> body_of;  ///< for each triangle, the connected part of the overlap that it bounds
  std::string obstacle;                ///< reason why the overlap cannot be computed; empty if it was computed
};

/// Returns the overlap: the set of points around which the surfaces wind twice or more.
/// @param surfaces  the surfaces of one or two solids, closed, facing outwards. If the surfaces cross themselves, the
/// result also contains the points around which a surface winds twice.
/// @throws Cancelled.
[[nodiscard]] Overlap overlap_of(const MeshView& surfaces, const Context& context);

/// Returns for each triangle of the overlap the number of its patch. Two triangles with a common edge are in one patch
/// if their sources are equal or neighbours.
/// @param are_neighbours  callable: returns true if two sources are neighbours.
[[nodiscard]] std::vector<std::uint32_t> patches_of(const Overlap& overlap,
                                                    FunctionRef<bool(std::uint32_t, std::uint32_t)> are_neighbours);

/// Returns the curves in which triangles of different labels meet. A curve is a chain of edges between triangles of
/// different labels. The curve is closed, or each of its ends is a vertex at which one, three or more of these edges
/// meet.
/// @param triangles  the triangles to consider. Each of their edges must be an edge of two of them.
[[nodiscard]] std::vector<std::vector<Vec3d>> border_curves(const TriangleMesh& mesh,
                                                            const std::vector<std::uint32_t>& labels,
                                                            const std::vector<std::uint32_t>& triangles);

}  // namespace blum::detail
