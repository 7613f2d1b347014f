// Blum: what solids have in common. SPDX-License-Identifier: Apache-2.0
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

/// The triangles at each edge, the smaller end first. @param triangles  those that are looked at.
[[nodiscard]] std::map<Edge, std::vector<std::uint32_t>> triangles_at_edges(const MeshView& mesh,
                                                                            std::span<const std::uint32_t> triangles);

/// The border of what solids have in common: each of its triangles is a part of one of theirs.
struct Overlap {
  TriangleMesh mesh;
  std::vector<std::uint32_t> source;   ///< of each triangle, in the surfaces
  std::vector<std::uint32_t> body_of;  ///< the connected part that it bounds
  std::string obstacle;                ///< why it cannot be told; empty where it is
};

/// The points around which the surfaces wind twice or more.
/// @param surfaces  of one solid or of two, closed, facing outwards. Those that cross themselves count where they wind
///                  twice.
/// @throws Cancelled.
[[nodiscard]] Overlap overlap_of(const MeshView& surfaces, const Context& context);

/// For each triangle a number of the patch that it lies in: patches end where triangles meet whose sources are no
/// neighbours.
/// @param are_neighbours  whether two sources are.
[[nodiscard]] std::vector<std::uint32_t> patches_of(const Overlap& overlap,
                                                    FunctionRef<bool(std::uint32_t, std::uint32_t)> are_neighbours);

/// Where triangles of two labels meet: chains of edges, closed, or from one place where more of them meet to another.
/// @param triangles  that are looked at; every edge must have two of them.
[[nodiscard]] std::vector<std::vector<Vec3d>> border_curves(const TriangleMesh& mesh,
                                                            const std::vector<std::uint32_t>& labels,
                                                            const std::vector<std::uint32_t>& triangles);

}  // namespace blum::detail
