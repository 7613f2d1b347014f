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

/// Returns the triangles at each edge. Edges have their smaller end first.
/// @param triangles  the triangles to consider.
[[nodiscard]] std::map<Edge, std::vector<std::uint32_t>> triangles_at_edges(const MeshView& mesh,
                                                                            std::span<const std::uint32_t> triangles);

/// The border of the common part of solids. Each of its triangles is a part of one of theirs.
struct Overlap {
  TriangleMesh mesh;
  std::vector<std::uint32_t> source;   ///< for each triangle, its triangle in the surfaces
  std::vector<std::uint32_t> body_of;  ///< the connected part that each triangle bounds
  std::string obstacle;                ///< why it cannot be computed; empty if it can
};

/// Returns the set of points around which the surfaces wind twice or more.
/// @param surfaces  of one solid or of two, closed, facing outwards. Those that cross themselves count where they wind
///   twice.
/// @throws Cancelled.
[[nodiscard]] Overlap overlap_of(const MeshView& surfaces, const Context& context);

/// Returns for each triangle the number of its patch. Patches end where triangles meet whose sources are not
/// neighbours.
/// @param are_neighbours  callable: returns true if two sources are neighbours.
[[nodiscard]] std::vector<std::uint32_t> patches_of(const Overlap& overlap,
                                                    FunctionRef<bool(std::uint32_t, std::uint32_t)> are_neighbours);

/// Returns the curves in which triangles of two labels meet. These are chains of edges, closed, or from one place where
/// more of them meet to another.
/// @param triangles  the triangles to consider; every edge must have two of them.
[[nodiscard]] std::vector<std::vector<Vec3d>> border_curves(const TriangleMesh& mesh,
                                                            const std::vector<std::uint32_t>& labels,
                                                            const std::vector<std::uint32_t>& triangles);

}  // namespace blum::detail
