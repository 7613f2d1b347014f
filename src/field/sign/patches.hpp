// Blum: parts of a surface that nothing touches. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::sign {

inline constexpr std::uint32_t no_patch = 0xffffffff;

/// Sets of triangles that are connected across edges which two of them share in opposite directions, none of which is
/// too flat, or touches or crosses another triangle that is no neighbour.
struct Patches {
  std::uint32_t count = 0;
  /// Of each site: that of all the triangles at it. no_patch where they are not of one patch, or where another vertex
  /// or edge lies in the same place.
  std::vector<std::uint32_t> of_site;
  /// The largest triangle of each patch.
  std::vector<std::uint32_t> largest;
};

/// @throws Cancelled.
/// Cost: that of find_self_intersections(); where there are more pairs than 1,000 and a quarter of the triangles, no
/// patches.
[[nodiscard]] Patches find_patches(const MeshView& mesh, const SiteTable& sites, const Context& context);

}  // namespace blum::sign
