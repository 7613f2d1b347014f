// Blum: the edges at each vertex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "blum/geometry/sites.hpp"

namespace blum::voronoi {

/// The edges of a SiteTable at each of its vertices, in rising order.
class EdgesOfVertices {
 public:
  explicit EdgesOfVertices(const SiteTable& sites) : first_(sites.vertex_count() + 1, 0) {
    for (const Segment& ends : sites.edges()) {
      for (const std::uint32_t v : ends) ++first_[v + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    edges_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t edge = 0; edge < sites.edge_count(); ++edge) {
      for (const std::uint32_t v : sites.edges()[edge]) edges_[next[v]++] = edge;
    }
  }

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t v) const {
    return std::span(edges_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

 private:
  /// Those of v are edges_[first_[v]] ... edges_[first_[v + 1] - 1].
  std::vector<std::uint32_t> first_, edges_;
};

}  // namespace blum::voronoi
