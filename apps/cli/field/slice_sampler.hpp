// Blum: interpolation of a slice. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "field/slice_picture.hpp"

namespace blum::cli {

struct Sample {
  double value = 0;
  double slope_u = 0;  ///< change of the value per grid step
  double slope_v = 0;
  bool continuous = true;  ///< false next to a jump of the sign (in fields of open meshes); no contour is drawn there
};

/// Interpolates distances. Positions are in grid steps from the first node. Next to a jump of the sign, the value of
/// the nearest node is used.
class DistanceSampler {
 public:
  explicit DistanceSampler(const Slice& slice);
  /// Interpolates bilinearly. Smoother interpolation would overshoot at the corners of a surface.
  [[nodiscard]] Sample at(double u, double v) const;
  /// Evaluates a quadratic spline, which rounds ridges within one grid step. An interpolating curve would oscillate
  /// along ridges that are oblique to the grid, so its contours would be wavy.
  [[nodiscard]] Sample smoothed(double u, double v) const;

 private:
  /// Cell (square between four nodes) that contains a position. If the position is outside of the slice, the nearest
  /// cell.
  struct Cell {
    std::int64_t i, j;
    double s, t;  ///< position in the cell, from 0 to 1
  };
  [[nodiscard]] Cell cell_at(double u, double v) const;
  [[nodiscard]] bool is_smooth_around(const Cell& cell) const;
  [[nodiscard]] Sample bilinear(const Cell& cell) const;
  [[nodiscard]] double node(std::int64_t i, std::int64_t j) const;
  [[nodiscard]] bool is_smooth(std::int64_t i, std::int64_t j) const;

  const Slice& slice_;
  std::vector<bool> smooth_;  ///< for each cell: true if it contains no jump of the sign
};

/// Site of a position, and its margin over the second-best site.
struct RegionSample {
  SiteId site;
  SiteId rival;       ///< second-best site; none() also stands for the region beyond the band
  double margin = 1;  ///< 0 on the border of the region; increases by about 1.5 per grid step
  bool alone = true;  ///< true if the 3 x 3 nearest nodes have only one site
};
/// Finds the site of a position. The 3 x 3 nearest nodes vote for their sites, with the weights of a quadratic spline.
/// At a node, the node's site wins.
[[nodiscard]] RegionSample region_at(const Slice& slice, double u, double v);

}  // namespace blum::cli
