// Blum: orientations of triangles of closed meshes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Entry of shell_of_triangles() for a triangle with the same vertex at two corners.
constexpr std::uint32_t no_shell = std::numeric_limits<std::uint32_t>::max();

/// Returns for each triangle of a closed mesh the number of its shell. Shells are numbered as in Topology::shells, in
/// the order of their first triangles.
[[nodiscard]] std::vector<std::uint32_t> shell_of_triangles(const MeshView& mesh, const SiteTable& sites);

/// Returns the triangles of a closed manifold, some of them reversed so that neighbours have consistent orientations.
/// Each shell gets the orientation that most of its triangles have. Returns nullopt if a shell is one-sided.
/// @param count  is set to the number of reversed triangles.
[[nodiscard]] std::optional<std::vector<Triangle>> agreeing_triangles(const MeshView& mesh, const SiteTable& sites,
                                                                      std::size_t& count);

/// Returns all triangles of any mesh, some of them reversed, so that those that share an edge have consistent
/// orientations. A patch is a set of triangles that are connected through edges with exactly two triangles. In each
/// patch, at least half of the triangles are kept. Patches without a consistent orientation stay as they are.
/// Cost: O(triangles).
[[nodiscard]] std::vector<Triangle> agreeing_patches(const MeshView& mesh, const SiteTable& sites);

/// Triangles of a closed mesh, some of them reversed.
struct RepairedFacing {
  std::vector<Triangle> triangles;     ///< all triangles; indices of triangles and edges are those of the mesh
  std::size_t reversed_triangles = 0;  ///< triangles that faced against the majority of their shell
  std::size_t reversed_shells = 0;     ///< shells that were reversed as a whole
};

/// Returns the triangles of a mesh after wrong orientations were repaired. First, triangles that face another way than
/// most of their shell are reversed. Then, each outermost shell with a negative volume is reversed, together with all
/// shells inside it. So an inside-out solid with voids becomes the solid. Other shells keep their orientation, for
/// example a shell inside another one that faces the same way.
/// @return nullopt if no triangle is to be reversed, if an edge does not have two triangles, or if a shell is
/// one-sided.
/// @param given  the result of orientation() for the mesh.
/// @throws Cancelled. Cost: none for meshes that face outwards; for others, twice that of orientation().
[[nodiscard]] std::optional<RepairedFacing> repaired_facing(const MeshView& mesh, const SiteTable& sites,
                                                            const Orientation& given, const Context& context);

/// Returns six times the signed volume of a mesh; the volume is negative if the mesh faces inwards. Coordinates are
/// taken relative to the middle of the mesh's box, so that rounding errors are small even far from the origin.
[[nodiscard]] double volume_around_middle(const MeshView& mesh);

}  // namespace blum::detail
