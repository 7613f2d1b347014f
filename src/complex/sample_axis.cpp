#include "blum/complex/sample_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "blum/core/exact_text.hpp"

namespace blum {
namespace {

/// Returns the number of equal parts into which a length is divided, from 1 to 4096; 1 if the length is not a number.
std::size_t parts_of(double length, double step) {
  constexpr double most = 4096;
  return length > step ? static_cast<std::size_t>(std::ceil(std::min(length / step, most))) : 1;
}

class Sampler {
 public:
  Sampler(const MedialView& axis, double step) : axis_(axis), step_(step) {
    for (std::uint32_t v = 0; v < axis.positions.size(); ++v) add(v);
  }

  void add_edge(const std::array<std::uint32_t, 2>& edge) {
    const auto [a, b] = edge;
    const std::size_t parts = parts_of(length(a, b), step_);
    for (std::size_t k = 1; k < parts; ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(parts);
      add({a, b, b}, {1 - t, t, 0});
    }
  }

  /// Divides a triangle whose longest side exceeds the step into rows along that side, and each row into columns. Each
  /// column gets a sample in its middle. No point of a column is further than a step from its sample: sqrt(0.5^2 +
  /// 0.86^2) < 1.
  void add_triangle(std::array<std::uint32_t, 3> corners) {
    const auto side = [&](std::size_t k) { return length(corners[k], corners[(k + 1) % 3]); };
    const std::size_t first = side(0) >= side(1) && side(0) >= side(2) ? 0 : side(1) >= side(2) ? 1 : 2;
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
    const double longest = side(0);
    if (!(longest > step_)) return;
    const Vec3d along = axis_.positions[corners[1]] - axis_.positions[corners[0]];
    const Vec3d up = axis_.positions[corners[2]] - axis_.positions[corners[0]];
    // Position of the height's foot on the longest side, from 0 to 1. Both angles at that side are acute.
    const double foot = std::clamp(dot(along, up) / (longest * longest), 0.0, 1.0);
    const double height = blum::length(cross(along, up)) / longest;
    const std::size_t rows = parts_of(height, 0.86 * step_);
    for (std::size_t row = 0; row < rows; ++row) add_row(corners, longest, foot, row, rows);
  }

  std::vector<AxisSample> take() { return std::move(samples_); }

 private:
  [[nodiscard]] double length(std::uint32_t a, std::uint32_t b) const {
    return blum::length(axis_.positions[a] - axis_.positions[b]);
  }
  void add(std::uint32_t v) { samples_.push_back({axis_.positions[v], axis_.radius[v], v}); }
  /// @param foot  position of the height's foot on the longest side, from 0 at the first corner to 1 at the second.
  void add_row(const std::array<std::uint32_t, 3>& corners, double longest, double foot, std::size_t row,
               std::size_t rows) {
    const double low = static_cast<double>(row) / static_cast<double>(rows);  // fraction of the height
    const double high = static_cast<double>(row + 1) / static_cast<double>(rows);
    const double begin = foot * low;  // fraction of the longest side
    const double end = 1 - (1 - foot) * low;
    const std::size_t columns = parts_of((end - begin) * longest, step_);
    for (std::size_t column = 0; column < columns; ++column) {
      const double at = begin + (end - begin) * (static_cast<double>(column) + 0.5) / static_cast<double>(columns);
      const double highest = at < foot ? at / foot : foot < 1 ? (1 - at) / (1 - foot) : 1;
      const double of_top = 0.5 * (low + std::max(low, std::min(high, highest)));
      const double of_second = at - of_top * foot;
      add(corners, {1 - of_top - of_second, of_second, of_top});
    }
  }
  void add(const std::array<std::uint32_t, 3>& corners, const std::array<double, 3>& weights) {
    AxisSample sample{{}, 0, corners[0]};
    for (std::size_t k = 0; k < 3; ++k) {
      sample.position += axis_.positions[corners[k]] * weights[k];
      sample.radius += axis_.radius[corners[k]] * weights[k];
    }
    samples_.push_back(sample);
  }

  const MedialView& axis_;
  double step_;
  std::vector<AxisSample> samples_;
};

}  // namespace

std::vector<AxisSample> sample_axis(const MedialView& axis, double step) {
  if (!(step > 0)) throw InvalidOption("step is " + exact_text(step) + ", but must be above 0");
  Sampler sampler(axis, step);
  for (const auto& edge : axis.edges) sampler.add_edge(edge);
  for (const auto& triangle : axis.triangles) sampler.add_triangle(triangle);
  return sampler.take();
}

double area_of(const MedialView& axis) {
  double twice = 0;
  for (const auto& [a, b, c] : axis.triangles) {
    twice += length(cross(axis.positions[b] - axis.positions[a], axis.positions[c] - axis.positions[a]));
  }
  return 0.5 * twice;
}

}  // namespace blum
