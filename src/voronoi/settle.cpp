#include "voronoi/settle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace blum::voronoi {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// The solution of a x = b for a symmetric positive definite matrix, by Gaussian elimination.
Vec3d solve(Matrix a, Vec3d b) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = k + 1; i < 3; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < 3; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 3; k-- > 0;) {
    for (std::size_t j = k + 1; j < 3; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

struct Distance {
  double value = 0;
  Vec3d slope;
};

Distance distance_from(const PlacedLabel& label, const Vec3d& q) {
  if (label.kind == SiteKind::face) return {label.height(q), label.direction};
  const Vec3d away = q - label.foot(q);
  const double value = length(away);
  return {value, value > 0 ? away / value : Vec3d{}};
}

}  // namespace

std::optional<Vec3d> settle(const LabelGeometry& geometry, std::span<const LabelIndex> labels, bool on_surface,
                            const Vec3d& start, const PlacedBox& box) {
  const double reach = length(box.high - box.low);
  const double enough = 1e-12 * geometry.size();
  Vec3d q = start;
  std::vector<Distance> distances(labels.size());
  constexpr int most_steps = 24;
  for (int step = 0; step < most_steps; ++step) {
    double mean = 0;
    Vec3d mean_slope;
    for (std::size_t k = 0; k < labels.size(); ++k) {
      distances[k] = distance_from(geometry[labels[k]], q);
      mean += distances[k].value / static_cast<double>(labels.size());
      mean_slope += distances[k].slope / static_cast<double>(labels.size());
    }
    if (on_surface) {
      mean = 0;
      mean_slope = {};
    }
    Matrix normal{};
    Vec3d right;
    double largest = 0;
    for (const Distance& distance : distances) {
      Vec3d row = distance.slope - mean_slope;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.low[axis] == box.high[axis]) row[axis] = 0;
      }
      const double residual = distance.value - mean;
      largest = std::max(largest, std::abs(residual));
      right -= row * residual;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) normal[i][j] += row[i] * row[j];
      }
    }
    if (largest <= enough) {
      // Outside of the box from the nearest point in it on: to and fro it comes to a point of both, where there is one.
      const Vec3d inside = max(box.low, min(box.high, q));
      if (inside == q) return q;
      q = inside;
      continue;
    }
    // A little of the identity keeps steps short along directions that nothing is known of.
    const double trace = normal[0][0] + normal[1][1] + normal[2][2];
    for (std::size_t i = 0; i < 3; ++i) normal[i][i] += 1e-10 * trace + 1e-300;
    const Vec3d move = solve(normal, right);
    if (!is_finite(move) || length(move) > 2 * reach) return std::nullopt;
    q += move;
    if (length(q - start) > 2 * reach) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace blum::voronoi
