#include "geometry/crossings/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blum/core/vec3.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum::detail {
namespace {

using Signs = std::array<int, 3>;

Signs sides(const ExactSpace& space, const FlatTriangle& plane, const FlatTriangle& of) {
  return {space.side(plane.plane(), of.corners[0]), space.side(plane.plane(), of.corners[1]),
          space.side(plane.plane(), of.corners[2])};
}

/// Collects what edges of one triangle have in common with the other one.
class Collector {
 public:
  Collector(ExactSpace& space, EdgePoints& edge_points, Contact3& out)
      : space_(space), edge_points_(edge_points), out_(out) {}

  void collect(const FlatTriangle& a, const Signs& a_sides, const FlatTriangle& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (a_sides[k] == 0) take_corner(a.corners[k], b);
      if (a_sides[k] * a_sides[next] < 0) take_crossing(a.corners[k], a.corners[next], b);
    }
  }

 private:
  void take(PointId p) {
    for (std::size_t k = 0; k < out_.count; ++k) {
      if (out_.points[k] == p) return;
    }
    if (out_.count < 2) out_.points[out_.count++] = p;
  }

  /// A corner in the plane of b.
  void take_corner(PointId p, const FlatTriangle& b) {
    Signs turns{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (p == b.corners[k]) return take(p);
      turns[k] = b.turn * space_.turn(b.axis, b.corners[k], b.corners[(k + 1) % 3], p);
      if (turns[k] < 0) return;
    }
    take(p);
    for (std::size_t k = 0; k < 3; ++k) {
      if (turns[k] == 0) edge_points_.add(b.corners[k], b.corners[(k + 1) % 3], p);
    }
  }

  /// An edge from one side of b's plane to the other.
  void take_crossing(PointId from, PointId to, const FlatTriangle& b) {
    Signs passes{};
    bool left = false;
    bool right = false;
    for (std::size_t k = 0; k < 3; ++k) {
      passes[k] = orient3d(space_.rounded(from), space_.rounded(to), space_.rounded(b.corners[k]),
                           space_.rounded(b.corners[(k + 1) % 3]));
      left = left || passes[k] > 0;
      right = right || passes[k] < 0;
    }
    if (left && right) return;
    PointId p = 0;
    if (passes[0] == 0 && passes[2] == 0) {
      p = b.corners[0];
    } else if (passes[0] == 0 && passes[1] == 0) {
      p = b.corners[1];
    } else if (passes[1] == 0 && passes[2] == 0) {
      p = b.corners[2];
    } else {
      p = space_.meet(from, to, b.plane());
      for (std::size_t k = 0; k < 3; ++k) {
        if (passes[k] == 0) edge_points_.add(b.corners[k], b.corners[(k + 1) % 3], p);
      }
    }
    edge_points_.add(from, to, p);
    take(p);
  }

  ExactSpace& space_;
  EdgePoints& edge_points_;
  Contact3& out_;
};

}  // namespace

FlatTriangle seen_along(const ExactSpace& space, const Triangle& triangle, std::size_t axis) {
  return {triangle, axis, space.turn(axis, triangle[0], triangle[1], triangle[2])};
}

FlatTriangle flattened(const ExactSpace& space, const Triangle& triangle) {
  const Vec3d& a = space.rounded(triangle[0]);
  const Vec3d normal = cross(space.rounded(triangle[1]) - a, space.rounded(triangle[2]) - a);
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](std::size_t i, std::size_t j) {
    return std::pair(-std::abs(normal[i]), i) < std::pair(-std::abs(normal[j]), j);
  });
  FlatTriangle out;
  for (const std::size_t axis : axes) {
    out = seen_along(space, triangle, axis);
    if (out.turn != 0) break;
  }
  return out;
}

bool contains(const ExactSpace& space, const FlatTriangle& triangle, PointId p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const PointId from = triangle.corners[k];
    const PointId to = triangle.corners[(k + 1) % 3];
    if (p == from || p == to) continue;
    if (triangle.turn * space.turn(triangle.axis, from, to, p) < 0) return false;
  }
  return true;
}

std::uint64_t EdgePoints::key(PointId from, PointId to) {
  return (static_cast<std::uint64_t>(std::min(from, to)) << 32U) | std::max(from, to);
}

bool EdgePoints::add(PointId from, PointId to, PointId p) {
  if (p == from || p == to) return false;
  std::vector<PointId>& points = of_edge_[key(from, to)];
  if (std::find(points.begin(), points.end(), p) != points.end()) return false;
  points.push_back(p);
  return true;
}

std::span<const PointId> EdgePoints::of(PointId from, PointId to) const {
  const auto found = of_edge_.find(key(from, to));
  return found == of_edge_.end() ? std::span<const PointId>{} : found->second;
}

Contact3 contact_of(ExactSpace& space, const FlatTriangle& a, const FlatTriangle& b, EdgePoints& edge_points) {
  Contact3 out;
  const Signs b_sides = sides(space, a, b);
  if (b_sides == Signs{0, 0, 0}) {
    out.is_coplanar = true;
    return out;
  }
  Collector collector(space, edge_points, out);
  collector.collect(a, sides(space, b, a), b);
  collector.collect(b, b_sides, a);
  return out;
}

}  // namespace blum::detail
