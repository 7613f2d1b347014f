// Blum: which way triangles of closed meshes face. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Of shell_of_triangles(): of triangles that name a vertex twice.
constexpr std::uint32_t no_shell = std::numeric_limits<std::uint32_t>::max();

/// Closed shells, numbered as Topology::shells is: by their smallest triangle.
[[nodiscard]] std::vector<std::uint32_t> shell_of_triangles(const MeshView& mesh, const SiteTable& sites);

/// The triangles of a closed manifold, some of them reversed such that neighbours agree. Shells keep the way that most
/// of their triangles face. nullopt where a surface has only one side.
/// @param count  of the triangles that were reversed.
[[nodiscard]] std::optional<std::vector<Triangle>> agreeing_triangles(const MeshView& mesh, const SiteTable& sites,
                                                                      std::size_t& count);

/// Six times the volume between the triangles of a mesh and the middle of its box: from there, so that it is not lost
/// where the mesh lies far from the origin. Negative where it faces inwards.
[[nodiscard]] double volume_around_middle(const MeshView& mesh);

}  // namespace blum::detail
