#include "blum/field/image_reference.hpp"

#include <limits>

namespace blum::reference {
namespace {

Vec3d offset(const GridSpec& grid, std::size_t voxel) {
  const auto size_x = static_cast<std::size_t>(grid.size[0]);
  const auto size_y = static_cast<std::size_t>(grid.size[1]);
  return {static_cast<double>(voxel % size_x), static_cast<double>(voxel / size_x % size_y),
          static_cast<double>(voxel / size_x / size_y)};
}

}  // namespace

double squared_distance(const GridSpec& grid, std::size_t a, std::size_t b) {
  const Vec3d d = offset(grid, a) - offset(grid, b);
  return squared_length(Vec3d{d.x * grid.spacing.x, d.y * grid.spacing.y, d.z * grid.spacing.z});
}

NearestVoxel nearest_voxel(const GridSpec& grid, const std::vector<std::uint8_t>& targets, std::size_t voxel) {
  NearestVoxel nearest{std::numeric_limits<double>::infinity(), SiteId::none()};
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i] == 0) continue;
    const double squared = squared_distance(grid, voxel, i);
    if (squared < nearest.squared) nearest = {squared, SiteId(static_cast<std::uint32_t>(i))};
  }
  return nearest;
}

}  // namespace blum::reference
