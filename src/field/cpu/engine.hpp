// Blum: the CPU back end of distance_field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "field/backend.hpp"
#include "field/connectivity_cache.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/normal_frame.hpp"
#include "field/cpu/placed_sites.hpp"
#include "field/cpu/second_sites.hpp"
#include "field/cpu/tile_kernel.hpp"

namespace blum::cpu {

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
  /// Of a field, but for its request and signs.
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
