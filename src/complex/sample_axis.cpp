#include "blum/complex/sample_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "blum/core/exact_text.hpp"

namespace blum {
namespace {

/// Into how many parts something is cut; 1 where a length is no number.
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

  /// The middles of the parts that a triangle is cut into, all of its shape.
  void add_triangle(const std::array<std::uint32_t, 3>& corners) {
    const auto [a, b, c] = corners;
    const std::size_t parts = parts_of(std::max({length(a, b), length(b, c), length(c, a)}), step_);
    if (parts == 1) return;
    const double third = 1.0 / (3.0 * static_cast<double>(parts));
    for (std::size_t i = 0; i < parts; ++i) {
      for (std::size_t j = 0; i + j < parts; ++j) {
        const std::array<double, 2> at{3.0 * static_cast<double>(i), 3.0 * static_cast<double>(j)};
        add_middle(corners, {(at[0] + 1) * third, (at[1] + 1) * third});
        if (i + j + 1 < parts) add_middle(corners, {(at[0] + 2) * third, (at[1] + 2) * third});
      }
    }
  }

  std::vector<AxisSample> take() { return std::move(samples_); }

 private:
  [[nodiscard]] double length(std::uint32_t a, std::uint32_t b) const {
    return blum::length(axis_.positions[a] - axis_.positions[b]);
  }
  void add(std::uint32_t v) { samples_.push_back({axis_.positions[v], axis_.radius[v], v}); }
  void add_middle(const std::array<std::uint32_t, 3>& corners, const std::array<double, 2>& weights) {
    add(corners, {1 - weights[0] - weights[1], weights[0], weights[1]});
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
