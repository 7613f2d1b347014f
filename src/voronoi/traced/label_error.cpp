#include "voronoi/traced/label_error.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/closest_point.hpp"

namespace blum::voronoi {
namespace {

using Corners = std::array<Vec3d, 3>;

Vec3d centre_of(const Corners& c) {
  return (c[0] + c[1] + c[2]) / 3.0;
}

/// A part of a wall's triangle, with the larger distances of its corners from the wall's sites.
struct Part {
  Corners corners;
  std::array<double, 3> radii{};
};

/// Returns the best of several lower bounds on d_k - A over a part.
double gap(const Part& part, const Corners& border) {
  const Corners& c = part.corners;
  const auto& r = part.radii;
  double best = -std::max({r[0], r[1], r[2]});
  for (const Vec3d& y :
       {centre_of(c), c[0], c[1], c[2], (c[0] + c[1]) * 0.5, (c[1] + c[2]) * 0.5, (c[2] + c[0]) * 0.5}) {
    const Vec3d way = y - closest_point_on_triangle(y, border);
    const double distance = length(way);
    if (!(distance > 0)) continue;
    const Vec3d slope = way / distance;
    double least = distance + dot(slope, c[0] - y) - r[0];
    for (const std::size_t k : {1U, 2U}) least = std::min(least, distance + dot(slope, c[k] - y) - r[k]);
    best = std::max(best, least);
    if (best >= 0) break;
  }
  return best;
}

class ErrorBound {
 public:
  ErrorBound(const TracedSites& sites, const MeshView& border, const Bvh& tree, double target)
      : sites_(sites), border_(border), tree_(tree), target_(target) {}

  [[nodiscard]] double of(const WallTriangle& wall) const {
    Part whole{wall.corners, {}};
    for (std::size_t k = 0; k < 3; ++k) whole.radii[k] = radius(wall, wall.corners[k]);
    const Vec3d centre = centre_of(wall.corners);
    double size = 0;
    for (const Vec3d& corner : wall.corners) size = std::max(size, length(corner - centre));
    // Triangles further away than this are further than A all over the wall's triangle.
    const double reach = std::max({whole.radii[0], whole.radii[1], whole.radii[2]}) + size;
    std::vector<Corners> near;
    tree_.for_each_within(centre + sites_.origin(), reach, [&](const NearestPrimitive& found) {
      const auto& [a, b, c] = border_.triangles[found.primitive];
      near.push_back({sites_.vertices()[a], sites_.vertices()[b], sites_.vertices()[c]});
      return true;
    });
    return error_of(wall, whole, near, 0);
  }

 private:
  [[nodiscard]] double radius(const WallTriangle& wall, const Vec3d& at) const {
    return std::max(sites_.distance(wall.sites[0], at), sites_.distance(wall.sites[1], at));
  }

  [[nodiscard]] double error_of(const WallTriangle& wall, const Part& part, const std::vector<Corners>& near,
                                int depth) const {
    double error = 0;
    std::vector<Corners> close;
    for (const Corners& border : near) {
      const double least = gap(part, border);
      if (least >= 0) continue;
      close.push_back(border);
      error = std::max(error, -least);
    }
    constexpr int most_depth = 5;
    if (error <= target_ || depth == most_depth) return error;
    const Corners& c = part.corners;
    const auto& r = part.radii;
    const Corners m{(c[0] + c[1]) * 0.5, (c[1] + c[2]) * 0.5, (c[2] + c[0]) * 0.5};
    const std::array<double, 3> s{radius(wall, m[0]), radius(wall, m[1]), radius(wall, m[2])};
    double divided = 0;
    for (const Part& child :
         {Part{{c[0], m[0], m[2]}, {r[0], s[0], s[2]}}, Part{{m[0], c[1], m[1]}, {s[0], r[1], s[1]}},
          Part{{m[2], m[1], c[2]}, {s[2], s[1], r[2]}}, Part{{m[0], m[1], m[2]}, {s[0], s[1], s[2]}}}) {
      divided = std::max(divided, error_of(wall, child, close, depth + 1));
    }
    return std::min(error, divided);
  }

  const TracedSites& sites_;
  const MeshView& border_;
  const Bvh& tree_;
  const double target_;
};

}  // namespace

double label_error(const TracedSites& sites, const MeshView& border, const SiteTable& table,
                   std::span<const WallTriangle> triangles, double target, const Context& context) {
  const Bvh tree(border, table, context);
  const ErrorBound bound(sites, border, tree, target);
  constexpr std::size_t grain = 64;
  std::vector<double> errors(triangles.size() / grain + 1, 0.0);
  parallel_for(context, triangles.size(), grain, "errors", [&](const WorkRange& range) {
    double& most = errors[range.begin / grain];
    for (std::size_t t = range.begin; t < range.end; ++t) most = std::max(most, bound.of(triangles[t]));
  });
  return *std::max_element(errors.begin(), errors.end());
}

}  // namespace blum::voronoi
