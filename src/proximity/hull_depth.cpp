#include "proximity/hull_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "blum/geometry/orient3d.hpp"

namespace blum::detail {
namespace {

/// Bound on the rounding error of differences and products of coordinates of at most about 1.
constexpr double rounding = 4e-15;

double largest_along(std::span<const Vec3d> points, const Vec3d& direction, std::size_t& at) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double here = dot(points[k], direction);
    if (here > most) {
      most = here;
      at = k;
    }
  }
  return most;
}

/// The Minkowski difference of two hulls: all translations of the first after which it meets the second.
class Difference {
 public:
  Difference(std::span<const Vec3d> first, std::span<const Vec3d> second) : first_(first), second_(second) {}

  struct Support {
    Vec3d point;        ///< point of the difference that is furthest along the direction
    double height = 0;  ///< of the point along the direction
  };
  [[nodiscard]] Support support(const Vec3d& direction) const {
    std::size_t of_first = 0;
    std::size_t of_second = 0;
    const double height = largest_along(second_, direction, of_second) + largest_along(first_, -direction, of_first);
    return {second_[of_second] - first_[of_first], height};
  }

 private:
  std::span<const Vec3d> first_;
  std::span<const Vec3d> second_;
};

/// A polytope in the Minkowski difference, whose vertices are vertices of the difference. The polytope grows where its
/// border is closest to the origin (expanding polytope algorithm, van den Bergen 2001). All decisions about the shape
/// of the polytope are exact.
class GrowingPolytope {
 public:
  explicit GrowingPolytope(const Difference& difference) : difference_(difference) {}

  [[nodiscard]] HullDepth grow(double tolerance, std::size_t most_planes, const Context& context) {
    HullDepth out;
    out.upper = std::numeric_limits<double>::infinity();
    if (!start(out)) return closed(out, 0);
    double lower = 0;
    for (std::size_t k = 0; k < most_planes && !closest_.empty(); ++k) {
      if (k % 256 == 0) throw_if_cancelled(context);
      const auto [distance, number] = closest_.top();
      const Face face = faces_[number];
      if (!face.is_alive) {
        closest_.pop();
        continue;
      }
      const bool is_origin_behind = side(face, {}) < 0;
      lower = is_origin_behind ? std::max(distance, 0.0) : 0;
      if (out.upper - lower <= tolerance * out.upper) break;
      const Difference::Support found = offer(face.normal, out);
      if (!(found.height > 0)) return {};
      if (side(face, found.point) <= 0) break;  // the face belongs to the difference's border
      closest_.pop();
      add(found.point, number);
    }
    return closed(out, lower);
  }

 private:
  struct Face {
    std::array<std::uint32_t, 3> vertices{};
    std::array<std::uint32_t, 3> neighbours{};  ///< across the edge from corner k to the next corner
    Vec3d normal;                               ///< unit vector outwards; 0 if it cannot be computed
    bool is_alive = true;
  };
  using Candidate = std::pair<double, std::uint32_t>;  ///< lower bound on a face's distance from the origin; the face

  static HullDepth closed(HullDepth found, double lower) {
    if (!(found.upper > 0)) return {};  // a plane separates the hulls
    found.upper += rounding;
    found.lower = std::clamp(lower - rounding, 0.0, found.upper);
    return found;
  }

  /// Moves along a direction separate the hulls if they are as long as the difference is high.
  Difference::Support offer(const Vec3d& direction, HullDepth& out) const {
    const Difference::Support found = difference_.support(direction);
    if (found.height < out.upper) {
      out.upper = found.height;
      out.direction = direction;
    }
    return found;
  }

  [[nodiscard]] int side(const Face& face, const Vec3d& point) const {
    return orient3d(points_[face.vertices[0]], points_[face.vertices[1]], points_[face.vertices[2]], point);
  }

  /// Makes a tetrahedron. @return false if the difference seems to have no volume.
  bool start(HullDepth& out) {
    std::vector<Vec3d> found;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const Vec3d direction{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          const double size = length(direction);
          if (size > 0) found.push_back(offer(direction / size, out).point);
        }
      }
    }
    const auto furthest = [&](const auto& measure) {
      return *std::max_element(found.begin(), found.end(),
                               [&](const Vec3d& p, const Vec3d& q) { return measure(p) < measure(q); });
    };
    const Vec3d a = found.front();
    const Vec3d b = furthest([&](const Vec3d& p) { return squared_length(p - a); });
    Vec3d c = furthest([&](const Vec3d& p) { return squared_length(cross(p - a, b - a)); });
    const Vec3d across = cross(b - a, c - a);
    for (const double way : {1.0, -1.0}) {  // a difference that is thin along the directions above
      const double size = length(across);
      if (size > 0) found.push_back(difference_.support(across * (way / size)).point);
    }
    const Vec3d d = furthest([&](const Vec3d& p) { return std::abs(dot(across, p - a)); });
    const int turn = orient3d(a, b, c, d);
    if (turn == 0) return false;
    points_ = {a, b, c, d};
    if (turn > 0) std::swap(points_[1], points_[2]);
    constexpr std::array<std::array<std::uint32_t, 3>, 4> corners{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
    constexpr std::array<std::array<std::uint32_t, 3>, 4> neighbours{{{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}}};
    for (std::size_t k = 0; k < 4; ++k) add_face(corners[k], neighbours[k]);
    return true;
  }

  /// For any unit vector, no point of a triangle is closer to the origin than its lowest corner along the vector. So
  /// the bound also holds if rounding changes the normal.
  void add_face(const std::array<std::uint32_t, 3>& vertices, const std::array<std::uint32_t, 3>& neighbours) {
    Face face{vertices, neighbours, {}, true};
    const auto& [a, b, c] = vertices;
    const Vec3d normal = cross(points_[b] - points_[a], points_[c] - points_[a]);
    const double size = length(normal);
    double distance = std::numeric_limits<double>::infinity();
    if (size > 0) face.normal = normal / size;
    for (const std::uint32_t v : vertices) distance = std::min(distance, dot(face.normal, points_[v]));
    closest_.emplace(distance, static_cast<std::uint32_t>(faces_.size()));
    faces_.push_back(face);
  }

  /// Adds a point outside of a face. Faces that see the point, or whose planes contain it, are replaced.
  void add(const Vec3d& point, std::uint32_t seen) {
    const auto apex = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    std::vector<std::uint32_t> open{seen};
    faces_[seen].is_alive = false;
    struct Edge {
      std::uint32_t from = 0, to = 0, beyond = 0;
    };
    std::vector<Edge> horizon;
    while (!open.empty()) {
      const Face face = faces_[open.back()];
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = face.neighbours[k];
        if (!faces_[next].is_alive) continue;
        if (side(faces_[next], point) >= 0) {
          faces_[next].is_alive = false;
          open.push_back(next);
        } else {
          horizon.push_back({face.vertices[k], face.vertices[(k + 1) % 3], next});
        }
      }
    }
    // If a neighbour of a face was added to the horizon, the face may be visited later only if the neighbour stays.
    std::map<std::uint32_t, std::uint32_t>
        from;  // for each vertex of the horizon: the new face whose edge begins there
    std::map<std::uint32_t, std::uint32_t> to;
    auto number = static_cast<std::uint32_t>(faces_.size());
    for (const Edge& edge : horizon) {
      from[edge.from] = number;
      to[edge.to] = number++;
    }
    for (const Edge& edge : horizon) {
      const auto own = static_cast<std::uint32_t>(faces_.size());
      add_face({edge.from, edge.to, apex}, {edge.beyond, from[edge.to], to[edge.from]});
      Face& beyond = faces_[edge.beyond];
      for (std::size_t k = 0; k < 3; ++k) {
        if (beyond.vertices[k] == edge.to && beyond.vertices[(k + 1) % 3] == edge.from) beyond.neighbours[k] = own;
      }
    }
  }

  const Difference& difference_;
  std::vector<Vec3d> points_;
  std::vector<Face> faces_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> closest_;
};

}  // namespace

HullDepth hull_depth(std::span<const Vec3d> first, std::span<const Vec3d> second, double tolerance,
                     std::size_t most_planes, const Context& context) {
  const Difference difference(first, second);
  return GrowingPolytope(difference).grow(tolerance, most_planes, context);
}

}  // namespace blum::detail
