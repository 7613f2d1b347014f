// Blum: values of a slice between its nodes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "field/slice_picture.hpp"

namespace blum::cli {

struct Sample {
  double value = 0;
  double slope_u = 0;  ///< change of the value for each node step
  double slope_v = 0;
  bool continuous = true;  ///< false next to a jump of the sign (open meshes): no contours there
};

/// Distances at any place, in node coordinates, where the field is continuous: linear between the nodes, or a spline
/// near them.
class DistanceSampler {
 public:
  explicit DistanceSampler(const Slice& slice);
  /// Takes the nodes' values there, and is bilinear between them: smoother curves draw ears at the corners of a
  /// surface.
  [[nodiscard]] Sample at(double u, double v) const;
  /// A quadratic spline, which rounds ridges within a node step. Any curve through the nodes waves along a ridge that
  /// is oblique to the grid, and contours of waves are worms.
  [[nodiscard]] Sample smoothed(double u, double v) const;

 private:
  /// The cell that a place lies in, the nearest one beyond the border.
  struct Cell {
    std::int64_t i, j;
    double s, t;  ///< in [0, 1] within the cell
  };
  [[nodiscard]] Cell cell_at(double u, double v) const;
  [[nodiscard]] bool is_smooth_around(const Cell& cell) const;
  [[nodiscard]] Sample bilinear(const Cell& cell) const;
  [[nodiscard]] double node(std::int64_t i, std::int64_t j) const;
  [[nodiscard]] bool is_smooth(std::int64_t i, std::int64_t j) const;

  const Slice& slice_;
  std::vector<bool> smooth_;  ///< per cell
};

/// The site that a place counts to, and by how much it wins over the next one.
struct RegionSample {
  SiteId site;
  SiteId rival;       ///< the second; none() as well when there is only one site around
  double margin = 1;  ///< 0 on the border, about 1.5 per node step from it
  bool alone = true;  ///< no second site around
};
/// Votes of the 3 x 3 nodes around, with weights of a quadratic spline: every node keeps its own site.
[[nodiscard]] RegionSample region_at(const Slice& slice, double u, double v);

}  // namespace blum::cli
