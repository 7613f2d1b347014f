// Blum: the CPU back end of distance_field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/backend.hpp"
#include "field/connectivity_cache.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/placed_sites.hpp"
#include "field/cpu/second_kernel.hpp"
#include "field/cpu/second_links.hpp"
#include "field/cpu/site_records.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "field/second_labels.hpp"

namespace blum::cpu {

/// Data of a mesh for the first order (closest sites).
struct FirstSites {
  const MeshView& mesh;
  const SiteTable& sites;
  const Adjacency& adjacency;
  std::span<const Vec3d> positions;  ///< in the normalised frame
  const SiteOrder& order;
  const SiteRecords& records;
};

/// Records, labels and links that the tiles of the second order (second-closest sites) read.
class SecondSites {
 public:
  void build(const FirstSites& first, const SecondLabels& labels, const Context& context);

  [[nodiscard]] const SiteRecords& records() const { return records_; }
  [[nodiscard]] const ClusterForest& forest() const { return forest_; }
  /// Returns a job whose field and request are not set. The job is valid until the next build().
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

/// Computes fields on the CPU.
class Engine final : public FieldBackend {
 public:
  [[nodiscard]] Device device() const override { return Device::cpu(); }
  void set_mesh(const MeshView& mesh, const Context& context) override;
  [[nodiscard]] const SiteTable& sites() const override { return sites_; }
  [[nodiscard]] bool needs_sites_for(sign::Method /*method*/) const override { return false; }
  [[nodiscard]] FieldResult compute(const FieldRequest& request, const Context& context,
                                    std::vector<PhaseTime>& phases) override;
  [[nodiscard]] std::vector<std::size_t> compute_second(const SecondRequest& request, const Context& context) override;

 private:
  void build_records(const FieldRequest& request, const Context& context);
  /// Returns a job for the tiles of a grid. Sets only the grid, its place and scale, and the cancellation; the caller
  /// sets the rest.
  [[nodiscard]] FieldJob make_job(const GridSpec& grid, const Context& context) const;

  MeshView mesh_;
  ConnectivityCache connectivity_;

  SiteTable sites_;
  Adjacency adjacency_;
  NormalFrame frame_;
  PlacedSites placed_;
  std::vector<TileScratch> scratch_;
  SecondSites second_;
};

}  // namespace blum::cpu
