#include "proximity/facets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "proximity/overlap.hpp"

namespace blum::detail {
namespace {

constexpr std::uint32_t no_facet = 0xffffffffU;

/// Positive left of the line from a to b, by the distance from it; 0 where a and b are one point.
double left_of(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& p) {
  const double x = b[0] - a[0];
  const double y = b[1] - a[1];
  const double size = std::hypot(x, y);
  return size > 0 ? (x * (p[1] - a[1]) - y * (p[0] - a[0])) / size : 0;
}

/// The part of a segment, from 0 to 1, that lies more than a margin left of a line.
void keep_left(double from, double to, double margin, double& begin, double& end) {
  from -= margin;
  to -= margin;
  if (from <= 0 && to <= 0) {
    end = -1;
  } else if (from < 0) {
    begin = std::max(begin, from / (from - to));
  } else if (to < 0) {
    end = std::min(end, from / (from - to));
  }
}

}  // namespace

Facets::Facets(const MeshView& mesh, double rounding)
    : rounding_(rounding), facet_of_(mesh.triangles.size(), no_facet) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  const auto by_edge = triangles_at_edges(mesh, all);
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (facet_of_[seed] != no_facet) continue;
    const auto number = static_cast<std::uint32_t>(facets_.size());
    Facet& facet = facets_.emplace_back();
    const std::array<Vec3d, 3> p = triangle_corners(mesh, seed);
    const Vec3d area = cross(p[1] - p[0], p[2] - p[0]);
    const Vec3d along = p[1] - p[0];
    facet.origin = p[0];
    const bool is_flat = !(length(area) > 0) || !(length(along) > 0);
    if (!is_flat) {
      facet.normal = area / length(area);
      facet.u = along / length(along);
      facet.v = cross(facet.normal, facet.u);
    }
    const auto is_in_plane = [&](std::uint32_t t) {
      const std::array<Vec3d, 3> q = triangle_corners(mesh, t);
      return !is_flat && dot(cross(q[1] - q[0], q[2] - q[0]), facet.normal) > 0 &&
             std::all_of(q.begin(), q.end(),
                         [&](const Vec3d& x) { return std::abs(dot(x - facet.origin, facet.normal)) <= rounding; });
    };
    std::vector<std::uint32_t> open{seed};
    facet_of_[seed] = number;
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      const std::array<Vec3d, 3> q = triangle_corners(mesh, t);
      facet.triangles.push_back({facet.seen(q[0]), facet.seen(q[1]), facet.seen(q[2])});
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& both = by_edge.at(std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]));
        const std::uint32_t next = both.size() != 2 ? t : both[0] == t ? both[1] : both[0];
        if (next != t && facet_of_[next] == number) continue;
        if (next != t && facet_of_[next] == no_facet && is_in_plane(next)) {
          facet_of_[next] = number;
          open.push_back(next);
        } else {
          facet.border.push_back({facet.seen(q[k]), facet.seen(q[(k + 1) % 3])});
        }
      }
    }
  }
}

bool Facets::holds(const Facet& facet, const Point& point) const {
  return std::any_of(facet.triangles.begin(), facet.triangles.end(), [&](const std::array<Point, 3>& t) {
    return left_of(t[0], t[1], point) >= -rounding_ && left_of(t[1], t[2], point) >= -rounding_ &&
           left_of(t[2], t[0], point) >= -rounding_;
  });
}

Facets::Lie Facets::lie(const std::array<Vec3d, 3>& points, std::uint32_t triangle) const {
  const Facet& facet = facets_[facet_of_[triangle]];
  Lie out;
  std::array<Point, 3> p{};
  for (std::size_t c = 0; c < 3; ++c) {
    p[c] = facet.seen(points[c]);
    out.furthest = std::max(out.furthest, std::abs(dot(points[c] - facet.origin, facet.normal)));
  }
  if (left_of(p[0], p[1], p[2]) < 0) std::swap(p[1], p[2]);
  double best = 0;
  for (const auto& [a, b] : facet.border) {
    // What of this side of the facet lies within the triangle.
    double begin = 0;
    double end = 1;
    for (std::size_t k = 0; k < 3 && begin < end; ++k) {
      const Point& from = p[k];
      const Point& to = p[(k + 1) % 3];
      keep_left(left_of(from, to, a), left_of(from, to, b), rounding_, begin, end);
    }
    if (!(begin < end)) continue;
    std::array<double, 3> sides{};
    double low = 0;
    double high = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double side = left_of(a, b, facet.seen(points[c]));
      sides[c] = std::abs(side) <= rounding_ ? 0 : side;
      low = std::max(low, -sides[c]);
      high = std::max(high, sides[c]);
    }
    if (!(std::min(low, high) > best)) continue;
    best = std::min(low, high);
    out.is_crossed = true;
    out.sides = sides;
  }
  const Point middle{(p[0][0] + p[1][0] + p[2][0]) / 3, (p[0][1] + p[1][1] + p[2][1]) / 3};
  out.is_over = !out.is_crossed && holds(facet, middle);
  return out;
}

}  // namespace blum::detail
