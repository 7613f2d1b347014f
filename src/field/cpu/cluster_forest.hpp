// Blum: hierarchies of boxes over the records. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "blum/core/context.hpp"
#include "field/cpu/site_records.hpp"

namespace blum::cpu {

/// Sixteen-ary boxes above the clusters of one kind: levels[0] bounds 16 clusters each, the last level has at most 16.
struct ClusterTree {
  std::vector<BoxArrays> levels;
};

struct ClusterForest {
  std::array<ClusterTree, kind_count> trees;
};

/// Cost: O(clusters). Reuses the memory of `out`.
void build_cluster_forest(const SiteRecords& sites, const Context& context, ClusterForest& out);

}  // namespace blum::cpu
