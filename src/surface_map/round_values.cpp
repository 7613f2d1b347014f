#include "surface_map/round_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "blum/geometry/closest_point.hpp"
#include "surface_map/linear_values.hpp"
#include "surface_map/triangle_sides.hpp"

namespace blum::surface {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Largest error of fractions.
constexpr double most_fraction_error = 1e-7;
/// Largest width of triangles that are treated as segments.
constexpr double most_width = 1e-6;
/// Rounding errors of a sum, as a multiple of epsilon times the magnitudes of its terms.
constexpr double factor = 32;

/// A sum, and a bound on the rounding error.
struct Sum {
  double value = 0;
  double magnitude = 0;
  void add(double term) {
    value += term;
    magnitude += std::abs(term);
  }
};

/// Adds a function of the ends of a side: its value at the end, minus that at the beginning.
template <class Function>
void add_difference(Sum& sum, double begin, double end, const Function& at) {
  sum.add(at(end));
  sum.add(-at(begin));
}

/// Adds the integral of a distance over a range of a segment, times the distance from the first point of the range.
/// The integral of r = sqrt(h^2 + s^2) is (s r + h^2 asinh(s / h)) / 2, and that of s r is r^3 / 3.
void add_ramp(Sum& sum, double from, double begin, double end, double height, double scale) {
  add_difference(sum, begin, end, [&](double s) {
    const double r = std::hypot(s, height);
    return scale * r * r * r / 3;
  });
  add_difference(sum, begin, end, [&](double s) {
    const double logarithm = height > 0 ? height * height * std::asinh(s / height) : 0;
    return -scale * from * (s * std::hypot(s, height) + logarithm) / 2;
  });
}

}  // namespace

RoundValues::RoundValues(const std::array<Vec3d, 3>& corners) {
  const std::array<double, 3> squared = squared_sides(corners);
  const std::size_t first = longest_of(squared);
  const Vec3d& a = corners[first];
  const Vec3d& b = corners[(first + 1) % 3];
  const Vec3d& c = corners[(first + 2) % 3];
  const double size = std::sqrt(squared[first]);
  if (!(size > 0)) {
    is_accurate_ = false;
    return;
  }
  const Vec3d all = a + b + c;
  mean_square_ = (squared_length(all) + squared_length(a) + squared_length(b) + squared_length(c)) / 12;
  lowest_ = length(closest_point_on_triangle({}, corners));
  for (std::size_t k = 0; k < 3; ++k) at_corners_[k] = length(corners[k]);
  highest_ = *std::max_element(at_corners_.begin(), at_corners_.end());
  value_error_ = 8 * epsilon * highest_;
  const Vec3d along = (b - a) / size;
  const Vec3d rest = (c - a) - along * dot(c - a, along);
  const double width = length(rest);
  area_ = size * width / 2;
  fraction_error_ = 4 * factor * epsilon * highest_ * highest_ / area_;
  if (fraction_error_ <= most_fraction_error) {
    const Vec3d up = rest / width;
    height_ = std::abs(dot(a, cross(along, up)));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = corners[(first + k) % 3];
      const Vec3d& q = corners[(first + k + 1) % 3];
      const std::array<double, 2> at{dot(p, along), dot(p, up)};
      const std::array<double, 2> by{dot(q - p, along), dot(q - p, up)};
      const double reach = std::hypot(by[0], by[1]);
      if (!(reach > 0)) continue;
      sides_[k].away = (at[0] * by[1] - at[1] * by[0]) / reach;
      sides_[k].begin = (at[0] * by[0] + at[1] * by[1]) / reach;
      sides_[k].end = sides_[k].begin + reach;
    }
    return;
  }
  is_accurate_ = width <= most_width;
  is_segment_ = true;
  value_error_ += width;
  fraction_error_ = factor * epsilon * highest_ / size;
  along_ = {dot(a, along), dot(b, along), dot(c, along)};
  std::sort(along_.begin(), along_.end());
  height_ = length(a - along * dot(a, along));
}

/// Over the triangle of the origin's projection and a side, the integral of sqrt(h^2 + r^2) is a function of the ends
/// (see docs/theory/surface-maps.md). The signed sum over the sides is the integral over the triangle.
RoundValues::Mean RoundValues::mean() const {
  Sum sum;
  if (is_segment_) {
    // The weights of positions rise linearly from the first corner to the second one, then fall to the third one.
    const auto [low, middle, high] = along_;
    const double least = 1e-9 * (high - low);
    double error = 0;
    if (middle - low > least) {
      add_ramp(sum, low, low, middle, height_, 2 / ((high - low) * (middle - low)));
    } else {
      error += 1e-9 * highest_;
    }
    if (high - middle > least) {
      add_ramp(sum, high, middle, high, height_, -2 / ((high - low) * (high - middle)));
    } else {
      error += 1e-9 * highest_;
    }
    return {sum.value, factor * epsilon * sum.magnitude + error};
  }
  const double h = height_;
  for (const Side& side : sides_) {
    const double p = side.away;
    if (p == 0) continue;
    const double squared = p * p + h * h;
    const double near = std::sqrt(squared);
    const double cube = h * h * h / 3;
    const auto distance = [&](double s) { return std::sqrt(s * s + squared); };
    add_difference(sum, side.begin, side.end, [&](double s) { return p / 6 * s * distance(s); });
    add_difference(sum, side.begin, side.end,
                   [&](double s) { return p / 6 * (p * p + 3 * h * h) * std::asinh(s / near); });
    if (!(cube > 0)) continue;
    add_difference(sum, side.begin, side.end, [&](double s) { return cube * std::atan(h * s / (p * distance(s))); });
    add_difference(sum, side.begin, side.end, [&](double s) { return -cube * std::atan(s / p); });
  }
  return {std::abs(sum.value) / area_, factor * epsilon * sum.magnitude / area_};
}

/// Returns the signed area of the points of a disc in the triangle of its middle and a side.
double RoundValues::area_within(const Side& side, double radius) const {
  const double half = std::sqrt(std::max(radius * radius - side.away * side.away, 0.0));
  const double begin = std::clamp(side.begin, -half, half);
  const double end = std::clamp(side.end, -half, half);
  double angle = 0;
  if (side.away != 0) {
    if (begin != side.begin) angle += std::atan(begin / side.away) - std::atan(side.begin / side.away);
    if (end != side.end) angle += std::atan(side.end / side.away) - std::atan(end / side.away);
  }
  return (side.away * (end - begin) + radius * radius * angle) / 2;
}

double RoundValues::fraction_below(double value) const {
  if (value >= highest_) return 1;
  if (value < lowest_ || value <= height_) return 0;
  const double radius = std::sqrt((value - height_) * (value + height_));
  if (is_segment_) {
    const LinearValue line{along_[0], along_[1], along_[2], 1};
    return surface::fraction_below(line, radius) - surface::fraction_below(line, -radius);
  }
  double area = 0;
  for (const Side& side : sides_) area += area_within(side, radius);
  return std::clamp(std::abs(area) / area_, 0.0, 1.0);
}

}  // namespace blum::surface
