// Blum: interpolation of a slice. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "field/slice_picture.hpp"

namespace blum::cli {

struct Sample {
  double value = 0;
  double slope_u = 0;  ///< change of the value for each node step
  double slope_v = 0;
  bool continuous = true;  ///< false next to a jump of the sign (open meshes), where no contour is drawn
};

/// Interpolates distances, at places in node coordinates. Next to a jump, it returns the nearest node's value.
class DistanceSampler {
 public:
  explicit DistanceSampler(const Slice& slice);
  /// Interpolates bilinearly. Smoother curves would overshoot at the corners of a surface.
  [[nodiscard]] Sample at(double u, double v) const;
  /// Evaluates a quadratic spline, which rounds ridges within a node step. An interpolating curve would oscillate along
  /// ridges that are oblique to the grid, and its contours would be wavy.
  [[nodiscard]] Sample smoothed(double u, double v) const;

 private:
  /// The cell that contains a place, or the nearest cell if the place is outside the slice.
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

/// The site of a place, and its margin over the second one.
struct RegionSample {
  SiteId site;
  SiteId rival;       ///< the second site; also none() if `alone`
  double margin = 1;  ///< 0 on the border; rises by about 1.5 per node step
  bool alone = true;  ///< no second site among the 3 x 3 nodes
};
/// Lets the 3 x 3 nearest nodes vote with weights of a quadratic spline. At a node, its own site wins.
[[nodiscard]] RegionSample region_at(const Slice& slice, double u, double v);

}  // namespace blum::cli
