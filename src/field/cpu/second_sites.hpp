// Blum: sites as the second order sees them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/cluster_forest.hpp"
#include "field/cpu/second_kernel.hpp"
#include "field/cpu/second_links.hpp"
#include "field/cpu/site_records.hpp"
#include "field/second_labels.hpp"

namespace blum::cpu {

/// What the first order knows of a mesh.
struct FirstSites {
  const MeshView& mesh;
  const SiteTable& sites;
  const Adjacency& adjacency;
  std::span<const Vec3d> positions;  ///< in the normalised frame
  const SiteOrder& order;
  const SiteRecords& records;
};

/// The records, labels and links that tiles of the second order read.
class SecondSites {
 public:
  void build(const FirstSites& first, const SecondLabels& labels, const Context& context);

  [[nodiscard]] const SiteRecords& records() const { return records_; }
  [[nodiscard]] const ClusterForest& forest() const { return forest_; }
  /// Without the field and its request. Valid until the next build().
  [[nodiscard]] SecondJob job() const;

 private:
  void find_others(const FirstSites& first, const SecondLabels& labels);

  SiteRecords records_;
  ClusterForest forest_;
  std::vector<SecondLabels::OfSite> labels_;
  std::vector<std::uint32_t> first_other_, others_;
  SecondLinks links_;
  bool has_links_ = false;
};

}  // namespace blum::cpu
