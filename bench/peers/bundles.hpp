// Blum: the order in which peers visit nodes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "blum/core/parallel.hpp"
#include "peers/peers.hpp"

namespace blum::bench {

/// Bundles of 8 x 8 rows along x. Rows of a bundle alternate in direction, so that each node follows a neighbour. The
/// chosen bundles contain about peer_nodes() nodes, and are spread evenly over the grid.
class Bundles {
 public:
  explicit Bundles(const GridSpec& grid) : grid_(grid), along_y_((grid.size[1] + 7) / 8) {
    const std::int64_t along_z = (grid.size[2] + 7) / 8;
    const double part = std::max(1.0, static_cast<double>(grid.node_count()) / peer_nodes());
    const auto stride = static_cast<std::int64_t>(std::floor(part + 1e-9));
    // A lattice of slope 0.38 in the plane of bundles keeps chosen bundles of the same row or column far apart.
    const auto slope = std::max<std::int64_t>(1, std::lround(0.38 * static_cast<double>(stride)));
    for (std::int64_t z = 0; z < along_z; ++z) {
      for (std::int64_t y = 0; y < along_y_; ++y) {
        if ((y + slope * z) % stride == 0) taken_.push_back(z * along_y_ + y);
      }
    }
    for (const std::int64_t bundle : taken_) nodes_ += count(bundle);
  }

  [[nodiscard]] std::size_t size() const { return taken_.size(); }
  [[nodiscard]] double fraction() const {
    return static_cast<double>(nodes_) / static_cast<double>(grid_.node_count());
  }

  /// Calls visit(index, position) for the nodes of one bundle.
  template <class Visit>
  void visit(std::size_t taken, const Visit& visit) const {
    const std::int64_t first_y = taken_[taken] % along_y_ * 8;
    const std::int64_t first_z = taken_[taken] / along_y_ * 8;
    const std::int64_t last_y = std::min(first_y + 8, grid_.size[1]) - 1;
    const std::int64_t last_z = std::min(first_z + 8, grid_.size[2]) - 1;
    const std::int64_t last_x = grid_.size[0] - 1;
    bool forth = true;
    bool up = true;
    for (std::int64_t k = first_z; k <= last_z; ++k, up = !up) {
      for (std::int64_t y = first_y; y <= last_y; ++y, forth = !forth) {
        const std::int64_t j = up ? y : first_y + last_y - y;
        for (std::int64_t x = 0; x <= last_x; ++x) {
          const std::int64_t i = forth ? x : last_x - x;
          visit(grid_.index(i, j, k), grid_.position(i, j, k));
        }
      }
    }
  }

 private:
  [[nodiscard]] std::int64_t count(std::int64_t bundle) const {
    const std::int64_t y = bundle % along_y_ * 8;
    const std::int64_t z = bundle / along_y_ * 8;
    return std::min<std::int64_t>(8, grid_.size[1] - y) * std::min<std::int64_t>(8, grid_.size[2] - z) * grid_.size[0];
  }

  GridSpec grid_;
  std::int64_t along_y_;
  std::vector<std::int64_t> taken_;
  std::int64_t nodes_ = 0;
};

/// An empty result for a peer. Its output pages are touched before the clock starts, which favours the peer.
inline PeerField empty_result(const GridSpec& grid) {
  PeerField result;
  result.field.grid = grid;
  result.field.distance = Buffer<float>(grid.node_count(), std::numeric_limits<float>::quiet_NaN());
  result.field.site = Buffer<SiteId>(grid.node_count(), SiteId::none());
  result.field.site_ids = SiteIds::triangles;
  return result;
}

/// Calls build(), then query(bundles, bundle, field) for all bundles, with several threads. Fills in the times.
template <class Build, class Query>
void run_peer(PeerField& result, const Context& context, const Build& build, const Query& query) {
  const Bundles bundles(result.field.grid);
  const Times built = time_once(build);
  const Times queried = time_once([&] {
    parallel_for(context, bundles.size(), 1, "", [&](const WorkRange& range) {
      for (std::size_t b = range.begin; b < range.end; ++b) query(bundles, b, result.field);
    });
  });
  result.fraction = bundles.fraction();
  result.build_wall = built.wall;
  result.build_cpu = built.cpu;
  result.times = built;
  result.times.wall += queried.wall / result.fraction;
  result.times.cpu += queried.cpu / result.fraction;
}

}  // namespace blum::bench
