// Blum: the distances of a triangle's points from the origin. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/vec3.hpp"

namespace blum::surface {

/// Mean and distribution of |y| over all points y of a triangle, in closed form. The length of an affine function over
/// a triangle has the same mean and distribution, because the function maps the triangle to another triangle.
class RoundValues {
 public:
  /// @param corners  images of the corners. Their largest coordinate must be about 1, or less.
  explicit RoundValues(const std::array<Vec3d, 3>& corners);

  /// Returns false if rounding would make the results too inaccurate. Then no other function may be called.
  [[nodiscard]] bool is_accurate() const { return is_accurate_; }
  /// Returns the values at the corners, in the order given.
  [[nodiscard]] const std::array<double, 3>& at_corners() const { return at_corners_; }
  [[nodiscard]] double lowest() const { return lowest_; }
  [[nodiscard]] double highest() const { return highest_; }
  /// Returns the mean of |y|^2.
  [[nodiscard]] double mean_square() const { return mean_square_; }
  struct Mean {
    double value = 0;
    double error = 0;  ///< bound on the rounding error, without value_error()
  };
  [[nodiscard]] Mean mean() const;
  /// Returns the fraction of the area on which |y| is at most `value`.
  /// Cost: 50 to 150 ns.
  [[nodiscard]] double fraction_below(double value) const;
  /// Returns a bound e: values are those of a triangle whose corners are up to e away from the given ones.
  [[nodiscard]] double value_error() const { return value_error_; }
  /// Returns a bound on the error of fractions.
  [[nodiscard]] double fraction_error() const { return fraction_error_; }

 private:
  /// Side of the triangle in its plane, seen from the point of the plane that is closest to the origin.
  struct Side {
    double away = 0;   ///< distance of the side's line; negative if the point is on the right of the side
    double begin = 0;  ///< positions of the ends along the line
    double end = 0;
  };
  [[nodiscard]] double area_within(const Side& side, double radius) const;

  bool is_accurate_ = true;
  bool is_segment_ = false;  ///< true if the triangle is so narrow that it is treated as a segment
  double height_ = 0;        ///< distance of the plane, or of the segment's line, from the origin
  double area_ = 0;
  std::array<Side, 3> sides_{};
  std::array<double, 3> along_{};  ///< positions of the corners along the segment's line, in rising order
  std::array<double, 3> at_corners_{};
  double lowest_ = 0;
  double highest_ = 0;
  double mean_square_ = 0;
  double value_error_ = 0;
  double fraction_error_ = 0;
};

}  // namespace blum::surface
