// Blum: computes one tile of the second order of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/cpu/second_links.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "field/second_labels.hpp"

namespace blum::cpu {

/// Input of all tiles of the second order, and the output of their results.
struct SecondJob {
  /// Records that may be second, without reaches: the point that beats a site beyond its reach may be excluded. Only
  /// the grid of its request is used.
  FieldJob field;
  SecondRequest request;
  /// Labels of every site. Records' planes come from sites with the same labels only. If `links` is set, they also come
  /// from others, and the links of the first site's vertices are evaluated in addition.
  std::span<const SecondLabels::OfSite> labels;
  const SecondLinks* links = nullptr;
  /// Labels that share some site with label l: others[first_other[l] .. first_other[l + 1]), ascending.
  std::span<const std::uint32_t> first_other;
  std::span<const std::uint32_t> others;

  /// Returns true if no site has labels of both, so that one of the two may be second wherever anything is first.
  [[nodiscard]] bool are_apart(const SecondLabels::OfSite& a, const SecondLabels::OfSite& b) const;
};

/// Memory that a worker keeps from tile to tile, and the nodes that are left to exact queries.
class SecondScratch {
 public:
  SecondScratch();
  SecondScratch(SecondScratch&&) noexcept;
  SecondScratch& operator=(SecondScratch&&) noexcept;
  ~SecondScratch();

  struct Impl;
  Impl& impl() { return *impl_; }

  /// Linear indices of nodes that no site claimed, although some site may be second.
  std::vector<std::size_t> unsettled;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Computes the second distance and site of every node of a box, as compute_tile() does the first.
void compute_second_tile(const SecondJob& job, const NodeBox& tile, SecondScratch& scratch);

}  // namespace blum::cpu
