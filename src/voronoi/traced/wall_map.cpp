#include "voronoi/traced/wall_map.hpp"

#include <cmath>
#include <utility>

#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

double touching_radius(const TracedSite& site, const Vec3d& p, const Vec3d& w) {
  const Vec3d y = p - site.point;
  if (site.kind == SiteKind::face) return dot(site.direction, y) / (1 - dot(site.direction, w));
  if (site.kind == SiteKind::vertex) return squared_length(y) / (-2 * dot(w, y));
  // Across the line: |y + r w|^2 = r^2.
  const double along = dot(site.direction, w);
  const Vec3d y_across = y - site.direction * dot(site.direction, y);
  const double half = dot(y_across, w);
  const double square = squared_length(y_across);
  const double root = std::sqrt(half * half + along * along * square);
  // The positive root of along^2 r^2 - 2 half r - square = 0, without cancellation.
  return half > 0 ? (half + root) / (along * along) : square / (root - half);
}

WallMap::WallMap(const TracedSites& sites, TracedSites::Index first, TracedSites::Index second,
                 std::optional<Vec3d> normal, std::span<const Vec3d> sample)
    : sites_(sites), from_(first), to_(second), is_planar_(normal.has_value()), origin_(sample[0]) {
  if (sites_[from_].kind < sites_[to_].kind) std::swap(from_, to_);
  const TracedSite& site = sites_[from_];
  if (is_planar_) {
    axes_ = axes_across(*normal);
  } else if (site.kind == SiteKind::face) {
    origin_ = site.point;
    axes_ = site.axes;
  } else {
    Vec3d middle;
    double radius = 0;
    for (const Vec3d& x : sample) {
      const double d = sites_.distance(from_, x);
      if (d > sites_.tolerance()) middle += (x - sites_.foot(from_, x)) / d;
      radius = std::max(radius, d);
    }
    origin_ = site.point;
    axes_[0] = unit(middle - site.direction * dot(middle, site.direction));
    axes_[1] = cross(site.direction, axes_[0]);
    scale_ = radius > 0 ? 0.5 * radius : 1;
  }
}

WallMap::Point WallMap::to_plane(const Vec3d& x) const {
  const Vec3d step = x - origin_;
  const TracedSite& site = sites_[from_];
  if (is_planar_ || site.kind == SiteKind::face) return {dot(axes_[0], step), dot(axes_[1], step)};
  const double a = dot(axes_[0], step), b = dot(axes_[1], step);
  return {dot(site.direction, step), a == 0 && b == 0 ? 0 : scale_ * std::atan2(b, a)};
}

Vec3d WallMap::from_plane(const Point& p) const {
  const TracedSite& site = sites_[from_];
  if (is_planar_) return origin_ + axes_[0] * p[0] + axes_[1] * p[1];
  if (site.kind == SiteKind::face) {
    const Vec3d foot = origin_ + axes_[0] * p[0] + axes_[1] * p[1];
    return foot + site.direction * touching_radius(sites_[to_], foot, site.direction);
  }
  const Vec3d foot = origin_ + site.direction * p[0];
  const Vec3d w = axes_[0] * std::cos(p[1] / scale_) + axes_[1] * std::sin(p[1] / scale_);
  return foot + w * touching_radius(sites_[to_], foot, w);
}

}  // namespace blum::voronoi
