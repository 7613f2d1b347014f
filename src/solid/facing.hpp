// Blum: orientations of triangles of closed meshes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Entry of shell_of_triangles() for triangles that name a vertex twice.
constexpr std::uint32_t no_shell = std::numeric_limits<std::uint32_t>::max();

/// Returns the closed shell of each triangle. Shells are numbered as in Topology::shells: by their smallest triangle.
[[nodiscard]] std::vector<std::uint32_t> shell_of_triangles(const MeshView& mesh, const SiteTable& sites);

/// Returns the triangles of a closed manifold, some of them reversed so that neighbours agree. Each shell keeps the
/// orientation of most of its triangles. Returns nullopt if a surface has only one side.
/// @param count  gets the number of reversed triangles.
[[nodiscard]] std::optional<std::vector<Triangle>> agreeing_triangles(const MeshView& mesh, const SiteTable& sites,
                                                                      std::size_t& count);

/// Returns six times the volume between the triangles of a mesh and the middle of its box. From the middle, rounding
/// does not lose it if the mesh lies far from the origin. Negative if the mesh faces inwards.
[[nodiscard]] double volume_around_middle(const MeshView& mesh);

}  // namespace blum::detail
