// Blum: the edges at each vertex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/index_rows.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::voronoi {

/// The edges of a SiteTable at each of its vertices, in rising order.
[[nodiscard]] inline IndexRows edges_of_vertices(const SiteTable& table) {
  return detail::rows_of(table.edge_count(), table.vertex_count(),
                         [&](std::size_t edge) -> const Segment& { return table.edges()[edge]; });
}

/// Where edges at a vertex end.
[[nodiscard]] inline std::vector<Vec3d> far_ends(const MeshView& mesh, const SiteTable& table, std::uint32_t v,
                                                 std::span<const std::uint32_t> edges) {
  std::vector<Vec3d> out;
  for (const std::uint32_t edge : edges) {
    const auto& [a, b] = table.edges()[edge];
    out.push_back(mesh.vertices[a == v ? b : a]);
  }
  return out;
}

}  // namespace blum::voronoi
