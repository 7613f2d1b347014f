// Blum: the sites of a mesh in the frame that is computed in. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/site_records.hpp"
#include "field/kernels/normal_frame.hpp"

namespace blum::cpu {

using kernels::NormalFrame;

/// @param named  the vertices that the mesh names.
/// @throws InvalidGrid when the common box is so large that float32 distances would overflow.
[[nodiscard]] NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named,
                                            const GridSpec& grid);

/// What kernels read of a mesh.
struct PlacedSites {
  std::vector<Vec3d> positions;  ///< of all vertices that the mesh names, normalised
  SiteOrder order;
  SiteRecords records;
  ClusterForest forest;

  /// Reuses the memory of what was there. @throws Cancelled.
  void build(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency, const NormalFrame& frame,
             const Context& context);
};

}  // namespace blum::cpu
