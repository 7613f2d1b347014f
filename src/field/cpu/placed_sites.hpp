// Blum: the sites of a mesh in the frame that is computed in. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/cluster_forest.hpp"
#include "field/cpu/normal_frame.hpp"
#include "field/cpu/site_records.hpp"

namespace blum::cpu {

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
