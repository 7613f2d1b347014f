#include "voronoi/wall_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace blum::voronoi {

double separation_angle(const Vec3d& at, const Vec3d& first, const Vec3d& second) {
  const Vec3d a = first - at;
  const Vec3d b = second - at;
  return std::atan2(length(cross(a, b)), dot(a, b)) * (180 / std::numbers::pi);
}

WallPoint wall_point(const LabelGeometry& geometry, std::span<const LabelIndex> among, const Vec3d& q) {
  struct Near {
    LabelIndex label = outside;
    Vec3d point;
    double distance = 0;
  };
  std::vector<Near> all;
  double least = std::numeric_limits<double>::infinity();
  for (const LabelIndex label : among) {
    const double reach = least + 1e-9 * geometry.size();
    if (geometry[label].squared_distance(q) > reach * reach) continue;  // no more than its distance
    const Vec3d point = geometry.closest_point(label, q);
    all.push_back({label, point, length(point - q)});
    least = std::min(least, all.back().distance);
  }
  const double most = least + 1e-9 * geometry.size();
  std::erase_if(all, [&](const Near& near) { return near.distance > most; });
  std::sort(all.begin(), all.end(), [](const Near& a, const Near& b) { return a.distance < b.distance; });
  WallPoint out;
  if (all.empty()) return out;
  out.radius = least;
  out.footprints = {all[0].point, all[0].point};
  out.labels = {all[0].label, all[0].label};
  if (least <= 1e-9 * geometry.size()) return out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      const double angle = separation_angle(q, all[i].point, all[k].point);
      if (angle <= out.separation_angle) continue;
      out.separation_angle = angle;
      out.footprints = {all[i].point, all[k].point};
      out.labels = {all[i].label, all[k].label};
    }
  }
  return out;
}

}  // namespace blum::voronoi
