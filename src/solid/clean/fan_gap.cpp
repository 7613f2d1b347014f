#include "solid/clean/fan_gap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace blum::detail {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// More corners are not compared pair by pair.
constexpr std::size_t most_pairwise = 40;
// Parts of the square of the extent. Areas in the plane are wrong by 2e-15 of it at most.
constexpr double clear_area = 1e-12;  ///< of triangles that certainly turn to the left
constexpr double clear_side = 1e-14;  ///< of points that certainly lie beside a line
constexpr double steep_area = 1e-9;   ///< above, quotients of areas are right to 4e-6
constexpr double quotient_error = 1e-5;
constexpr double height_error = 1e-14;  ///< part of the extent

/// Twice the area of the triangle from the origin, in the plane: points have their heights over it in z.
double area(const Vec3d& a, const Vec3d& b) {
  return a.x * b.y - a.y * b.x;
}

/// Both fans over a plane that suits the one from the apex, which is the origin.
class Fans {
 public:
  Fans(std::span<const Vec3d> ring, const Vec3d& apex, bool closed) : closed_(closed), points_(ring.size()) {
    Vec3d normal{};
    const std::size_t sides = ring.size() - (closed ? 0 : 1);
    for (std::size_t k = 0; k < sides; ++k) normal += cross(ring[k] - apex, ring[(k + 1) % ring.size()] - apex);
    const double size = length(normal);
    if (!(size > 0)) return;
    normal *= 1 / size;
    const Vec3d other = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    Vec3d across = cross(normal, other);
    across *= 1 / length(across);
    const Vec3d along = cross(normal, across);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec3d from_apex = ring[k] - apex;
      points_[k] = {dot(from_apex, across), dot(from_apex, along), dot(from_apex, normal)};
      extent_ = std::max(extent_, std::abs(from_apex.x) + std::abs(from_apex.y) + std::abs(from_apex.z));
      lowest_ = std::min(lowest_, points_[k].z);
      highest_ = std::max(highest_, points_[k].z);
    }
    square_ = extent_ * extent_;
  }

  /// Whether both fans are graphs of functions over the inside of the polygon in the plane.
  [[nodiscard]] bool are_graphs() const {
    if (!(square_ > 0)) return false;
    const std::size_t last = points_.size() - 1;
    const double least = clear_area * square_;
    std::size_t turns = 0;
    for (std::size_t k = 0; k + (closed_ ? 0 : 1) <= last; ++k) {
      const Vec3d& a = points_[k];
      const Vec3d& b = points_[k == last ? 0 : k + 1];
      if (!(area(a, b) > least)) return false;
      if (a.y < 0 && b.y >= 0) ++turns;
    }
    for (std::size_t k = 1; k + 1 <= last; ++k) {
      if (!(area(points_[k] - points_[0], points_[k + 1] - points_[0]) > least)) return false;
      // Seen from a side, all corners lie within half a turn.
      if (!closed_ && !(area(points_[0], points_[k]) > least)) return false;
    }
    return !closed_ || turns == 1;
  }

  /// What no two points over one place can be further apart.
  [[nodiscard]] double slab() const { return (highest_ - lowest_) + height_error * extent_; }

  /// The largest distance of the two over one place: both are linear between the places looked at here.
  [[nodiscard]] double gap() const {
    double most = closed_ ? gap_at_apex() : 0;
    const std::size_t last = points_.size() - 1;
    const std::size_t end = closed_ ? last + 1 : last;
    for (std::size_t i = 1; i < end && most < infinity; ++i) {
      for (std::size_t j = 2; j < last; ++j) {
        if (i != j) most = std::max(most, gap_at_crossing(points_[i], points_[j]));
      }
    }
    return std::min(slab(), most + quotient_error * (highest_ - lowest_) + height_error * extent_);
  }

 private:
  [[nodiscard]] double gap_at_apex() const {
    const Vec3d& w = points_[0];
    const Vec3d apex = -w;
    double most = infinity;
    for (std::size_t k = 1; k + 1 < points_.size(); ++k) {
      const Vec3d a = points_[k] - w;
      const Vec3d b = points_[k + 1] - w;
      const double of_b = area(a, apex);
      const double of_a = area(apex, b);
      if (of_a < -clear_side * square_ || of_b < -clear_side * square_) continue;
      const double whole = area(a, b);
      if (whole < steep_area * square_) return infinity;
      const double found = std::abs(w.z + (of_a * a.z + of_b * b.z) / whole);
      most = most == infinity ? found : std::max(most, found);
    }
    return most;
  }

  /// Of the edge from the apex to p and the one from the first corner to q; 0 where they do not cross.
  [[nodiscard]] double gap_at_crossing(const Vec3d& p, const Vec3d& q) const {
    const Vec3d& w = points_[0];
    const double clear = clear_side * square_;
    const double w_side = area(p, w);
    const double q_side = area(p, q);
    if ((w_side > clear && q_side > clear) || (w_side < -clear && q_side < -clear)) return 0;
    const Vec3d way = q - w;
    const double apex_side = area(way, -w);
    const double p_side = area(way, p - w);
    if ((apex_side > clear && p_side > clear) || (apex_side < -clear && p_side < -clear)) return 0;
    const double turn = area(p, way);
    if (std::abs(turn) < steep_area * square_) return infinity;
    const double s = std::clamp(area(w, way) / turn, 0.0, 1.0);
    const double t = std::clamp(-w_side / turn, 0.0, 1.0);
    return std::abs(s * p.z - (w.z + t * way.z));
  }

  bool closed_;
  std::vector<Vec3d> points_;
  double extent_ = 0;
  double square_ = 0;
  double lowest_ = 0;
  double highest_ = 0;
};

}  // namespace

double fan_gap(std::span<const Vec3d> ring, const Vec3d& apex, bool closed, double enough) {
  // A polygon of two corners, or of three with the apex on a side, is one triangle or none, whatever the apex.
  if (ring.size() < 3) return 0;
  const Fans fans(ring, apex, closed);
  if (!fans.are_graphs()) return infinity;
  if (ring.size() > most_pairwise || fans.slab() <= enough) return fans.slab();
  return fans.gap();
}

}  // namespace blum::detail
