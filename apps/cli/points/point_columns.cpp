#include "points/point_columns.hpp"

#include <cstdint>
#include <limits>
#include <optional>

namespace blum::cli {

Complex points_with_distances(std::span<const Vec3d> points, std::span<const ClosestPoint> found,
                              std::span<const std::optional<Vec3d>> gradients) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Complex out;
  out.positions.assign(points.begin(), points.end());
  out.vertex_columns = Columns(points.size());
  const auto distance = out.vertex_columns.add<double>("distance");
  const auto gradient = out.vertex_columns.add<double>("gradient", 3, nan);
  const auto closest = out.vertex_columns.add<double>("closest", 3);
  const auto site = out.vertex_columns.add<std::int32_t>("site");
  const auto triangle = out.vertex_columns.add<std::int32_t>("triangle");
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ClosestPoint& one = found[k];
    const std::optional<Vec3d>& direction = gradients[k];
    distance[k] = one.distance;
    site[k] = one.site.to_file();
    triangle[k] = one.triangle.to_file();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      closest[3 * k + axis] = one.point[axis];
      if (direction) gradient[3 * k + axis] = (*direction)[axis];
    }
  }
  return out;
}

}  // namespace blum::cli
