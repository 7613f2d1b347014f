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

/// Input of all tiles of the second order, and the memory for their results.
struct SecondJob {
  /// Sites that may be second, as records without reaches. Beyond a site's reach, some surface point is closer, but
  /// this point may be excluded in the second order. The job's request is unused, except for the grid.
  FieldJob field;
  SecondRequest request;
  /// Labels of every site. The planes that bound a record's domain come from sites with the same labels only. If
  /// `links` is set, they come from all neighbours. In this case, the links of the first site's vertices are evaluated
  /// in addition.
  std::span<const SecondLabels::OfSite> labels;
  const SecondLinks* links = nullptr;
  /// For each label l, the labels that occur together with l on some site: others[first_other[l] .. first_other[l +
  /// 1]), ascending.
  std::span<const std::uint32_t> first_other;
  std::span<const std::uint32_t> others;

  /// Returns true if no site shares labels with both a and b. Then one of the two sites may be second, for any first
  /// site.
  [[nodiscard]] bool are_apart(const SecondLabels::OfSite& a, const SecondLabels::OfSite& b) const;
};

/// Memory that a worker keeps from tile to tile, and the nodes left to exact queries.
class SecondScratch {
 public:
  SecondScratch();
  SecondScratch(SecondScratch&&) noexcept;
  SecondScratch& operator=(SecondScratch&&) noexcept;
  ~SecondScratch();

  struct Impl;
  Impl& impl() { return *impl_; }

  /// Linear indices of nodes for which no second site was found, although some site may be second.
  std::vector<std::size_t> unsettled;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Computes the second distance and site of every node of a box. compute_tile() does the same for the first.
void compute_second_tile(const SecondJob& job, const NodeBox& tile, SecondScratch& scratch);

}  // namespace blum::cpu
