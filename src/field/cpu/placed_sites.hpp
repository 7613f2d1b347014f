// Blum: the sites of a mesh in the normalised frame. SPDX-License-Identifier: Apache-2.0
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

/// Returns the normalised frame of a mesh and a grid.
/// @param named  the vertices that the mesh uses.
/// @throws InvalidGrid if the box around mesh and grid is too large or too small for float32 distances.
[[nodiscard]] NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named,
                                            const GridSpec& grid);

/// Data that the kernels read of a mesh.
struct PlacedSites {
  std::vector<Vec3d> positions;  ///< of all vertices, in the normalised frame; only those in use are set
  SiteOrder order;
  SiteRecords records;
  ClusterForest forest;

  /// Builds all members. Reuses their memory.
  /// @throws Cancelled.
  void build(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency, const NormalFrame& frame,
             const Context& context);
};

}  // namespace blum::cpu
