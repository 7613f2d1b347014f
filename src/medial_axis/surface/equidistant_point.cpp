#include "medial_axis/surface/equidistant_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace blum::detail {
namespace {

/// Least squared strength of a direction, relative to that of the strongest direction.
constexpr double weakest = 0.01;
/// Least squared strength of a direction, relative to the sum of squared distances of the points from the start. If
/// points differ by less than a millionth of their distance, the differences are rounding errors.
constexpr double rounding = 1e-12;

struct Symmetric {
  double a[3][3] = {};
};

/// Computes eigenvectors as columns of v and eigenvalues on the diagonal of m, by Jacobi rotations.
void diagonalise(Symmetric& m, Symmetric& v) {
  v.a[0][0] = v.a[1][1] = v.a[2][2] = 1;
  // Off-diagonal entries below this are smaller than the rounding error of the largest eigenvalue.
  const double negligible = 1e-16 * (m.a[0][0] + m.a[1][1] + m.a[2][2]);
  bool is_done = false;
  for (int sweep = 0; sweep < 8 && !is_done; ++sweep) {
    is_done = true;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (std::abs(m.a[p][q]) <= negligible) continue;
        is_done = false;
        const double theta = (m.a[q][q] - m.a[p][p]) / (2 * m.a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1);
        const double s = t * c;
        for (auto& row : m.a) {
          const double kp = row[p];
          const double kq = row[q];
          row[p] = c * kp - s * kq;
          row[q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const double pk = m.a[p][k];
          const double qk = m.a[q][k];
          m.a[p][k] = c * pk - s * qk;
          m.a[q][k] = s * pk + c * qk;
          const double vp = v.a[k][p];
          const double vq = v.a[k][q];
          v.a[k][p] = c * vp - s * vq;
          v.a[k][q] = s * vp + c * vq;
        }
      }
    }
  }
}

}  // namespace

EquidistantPoints::EquidistantPoints(std::span<const Vec3d> points, const Vec3d& start) : start_(start) {
  Vec3d mean;
  double mean_square = 0;
  for (const Vec3d& p : points) {
    mean += p - start;
    mean_square += squared_length(p - start);
  }
  const double n = static_cast<double>(points.size());
  mean *= 1 / n;
  mean_square /= n;
  // If |x - p|^2 is equal for all p, then 2 (p - mean) . x = |p|^2 - mean |p|^2.
  Symmetric normal;
  std::array<double, 3> right{};
  for (const Vec3d& p : points) {
    const Vec3d row = (p - start - mean) * 2.0;
    const double value = squared_length(p - start) - mean_square;
    for (std::size_t i = 0; i < 3; ++i) {
      right[i] += row[i] * value;
      for (std::size_t j = 0; j < 3; ++j) normal.a[i][j] += row[i] * row[j];
    }
  }
  Symmetric vectors;
  diagonalise(normal, vectors);
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return normal.a[a][a] > normal.a[b][b]; });
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = order[k];
    strengths_[k] = normal.a[i][i] > rounding * n * mean_square ? normal.a[i][i] : 0;
    const Vec3d direction{vectors.a[0][i], vectors.a[1][i], vectors.a[2][i]};
    moves_[k] =
        direction * ((direction.x * right[0] + direction.y * right[1] + direction.z * right[2]) / strengths_[k]);
  }
}

std::optional<Vec3d> EquidistantPoints::of_rank(int rank) const {
  Vec3d x = start_;
  for (std::size_t k = 0; k < static_cast<std::size_t>(rank); ++k) {
    if (!(strengths_[k] > weakest * strengths_[0])) return std::nullopt;
    x += moves_[k];
  }
  return x;
}

}  // namespace blum::detail
