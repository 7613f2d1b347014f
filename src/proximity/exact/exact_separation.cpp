#include "proximity/exact/exact_separation.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "proximity/exact/moving_points.hpp"
#include "proximity/exact/real_roots.hpp"

namespace blum::detail {
namespace {

/// Two parts of features (a vertex, the inside of an edge or a face) that are no further apart than the distance where
/// `excess` is not positive, `parts` are not negative, as the closest points lie on the parts, and `size` is positive.
struct Parts {
  Polynomial excess;
  std::vector<Polynomial> inside;
  Polynomial size;
};

class Approach {
 public:
  explicit Approach(const IntegerPoints& points)
      : points_(points), square_{points.distance * points.distance}, one_{Integer(1)} {}

  void add_vertices(std::size_t a, std::size_t b) {
    const MovingVector between = vector(a, b);
    parts_.push_back({dot(between, between) - square_, {}, one_});
  }
  /// A point, and the line from one to another.
  void add_vertex_and_edge(std::size_t point, std::size_t from, std::size_t to) {
    const MovingVector edge = vector(from, to);
    const MovingVector way = vector(from, point);
    const Polynomial size = dot(edge, edge);
    const Polynomial along = dot(edge, way);
    const PolynomialVector area = cross(edge, way);
    parts_.push_back({dot(area, area) - square_ * size, {along, size - along}, size});
  }
  void add_vertex_and_face() { add_insides(vector(1, 2), vector(1, 3), vector(1, 0), true); }
  void add_edge_and_edge() { add_insides(vector(0, 1), vector(2, 3), vector(0, 2), false); }

  /// They are close for the first time at the start, or where two parts are exactly as far apart as the distance; of
  /// those that always are, where the closest points come to lie on them.
  [[nodiscard]] std::optional<double> first(double tolerance) const {
    const RealRoots start(Polynomial{0, 1});
    const auto holds_at_start = [&](const Parts& parts) { return holds(parts, start, start.all().front()); };
    if (std::any_of(parts_.begin(), parts_.end(), holds_at_start)) return 0.0;
    std::optional<double> best;
    for (const Parts& parts : parts_) {
      if (!parts.excess.is_zero()) {
        look_at_roots_of(parts.excess, parts, tolerance, best);
        continue;
      }
      for (const Polynomial& one : parts.inside) look_at_roots_of(one, parts, tolerance, best);
      look_at_roots_of(parts.size, parts, tolerance, best);
    }
    return best;
  }

 private:
  [[nodiscard]] MovingVector vector(std::size_t from, std::size_t to) const {
    return points_.at[to] - points_.at[from];
  }

  /// Features that are a + s u and, w further on, b + r v; of a face, a point w from a + s u + r v.
  void add_insides(const MovingVector& u, const MovingVector& v, const MovingVector& w, bool is_face) {
    const PolynomialVector normal = cross(u, v);
    const Polynomial size = dot(normal, normal);
    const Polynomial volume = dot(normal, w);
    const Polynomial s = dot(normal, cross(w, v));
    const Polynomial r = dot(normal, is_face ? cross(u, w) : cross(w, u));
    std::vector<Polynomial> inside{s, r};
    if (is_face) {
      inside.push_back(size - s - r);
    } else {
      inside.insert(inside.end(), {size - s, size - r});
    }
    parts_.push_back({volume * volume - square_ * size, std::move(inside), size});
  }

  [[nodiscard]] static bool holds(const Parts& parts, const RealRoots& roots, const RealRoot& root) {
    return roots.sign_at(root, parts.excess) <= 0 && roots.sign_at(root, parts.size) > 0 &&
           std::all_of(parts.inside.begin(), parts.inside.end(),
                       [&](const Polynomial& one) { return roots.sign_at(root, one) >= 0; });
  }

  static void look_at_roots_of(const Polynomial& polynomial, const Parts& parts, double tolerance,
                               std::optional<double>& best) {
    if (polynomial.degree() <= 0) return;
    const RealRoots roots(polynomial);
    for (const RealRoot& isolated : roots.all()) {
      const RealRoot root = roots.refined(isolated, depth_of(tolerance));
      if (best && root.lower_bound() >= *best) return;
      if (!holds(parts, roots, root)) continue;
      best = root.lower_bound();
      return;
    }
  }

  const IntegerPoints& points_;
  Polynomial square_;
  Polynomial one_;
  std::vector<Parts> parts_;
};

}  // namespace

std::optional<double> exact_vertex_face_approach(const FourMovingPoints& points, double distance, double tolerance) {
  const IntegerPoints integers = integer_points(points, distance);
  Approach approach(integers);
  for (std::size_t k = 1; k < 4; ++k) {
    approach.add_vertices(0, k);
    approach.add_vertex_and_edge(0, k, k % 3 + 1);
  }
  approach.add_vertex_and_face();
  return approach.first(tolerance);
}

std::optional<double> exact_edge_edge_approach(const FourMovingPoints& points, double distance, double tolerance) {
  const IntegerPoints integers = integer_points(points, distance);
  Approach approach(integers);
  for (const std::size_t a : {0U, 1U}) {
    for (const std::size_t b : {2U, 3U}) approach.add_vertices(a, b);
    approach.add_vertex_and_edge(a, 2, 3);
    approach.add_vertex_and_edge(a + 2, 0, 1);
  }
  approach.add_edge_and_edge();
  return approach.first(tolerance);
}

}  // namespace blum::detail
