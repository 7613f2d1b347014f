#include "medial_axis/centreline/sections.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace blum::centrelines {
namespace {

constexpr int least_rays = 16;
constexpr int most_rays = 64;

}  // namespace

/// Box between eight voxel centres, and the position of a point in the box.
struct LabelShare::Corner {
  std::size_t index = 0;  ///< linear index of the voxel at the lower corner
  Vec3d share{};          ///< position in the box: 0 to 1 along each axis
};

LabelShare::LabelShare(std::span<const float> depth, const std::array<std::int64_t, 3>& size, const Vec3d& spacing)
    : depth_(depth),
      size_(size),
      spacing_(spacing),
      inverse_{1 / spacing.x, 1 / spacing.y, 1 / spacing.z},
      step_(std::min({spacing.x, spacing.y, spacing.z})) {}

bool LabelShare::locate(const Vec3d& point, Corner& corner) const {
  std::array<std::int64_t, 3> low{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = point[a] * inverse_[a];
    if (!(at >= 0) || at >= static_cast<double>(size_[a] - 1)) return false;
    low[a] = static_cast<std::int64_t>(at);
    corner.share[a] = at - static_cast<double>(low[a]);
  }
  corner.index = static_cast<std::size_t>((low[2] * size_[1] + low[1]) * size_[0] + low[0]);
  return true;
}

namespace {

/// Interpolates between eight values, trilinearly.
/// @param value  callable: returns the value at a linear index.
template <class Value>
double blend(std::size_t index, std::size_t row, std::size_t layer, const Vec3d& share, const Value& value) {
  const auto along = [&](std::size_t at) { return value(at) + share.x * (value(at + 1) - value(at)); };
  const double low = along(index) + share.y * (along(index + row) - along(index));
  const double high = along(index + layer) + share.y * (along(index + layer + row) - along(index + layer));
  return low + share.z * (high - low);
}

}  // namespace

double LabelShare::at(const Vec3d& point) const {
  Corner corner;
  if (!locate(point, corner)) return 0;
  const auto row = static_cast<std::size_t>(size_[0]);
  return blend(corner.index, row, row * static_cast<std::size_t>(size_[1]), corner.share,
               [this](std::size_t voxel) { return depth_[voxel] > 0 ? 1.0 : 0.0; });
}

double LabelShare::depth(const Vec3d& point) const {
  Corner corner;
  if (!locate(point, corner)) return 0;
  const auto row = static_cast<std::size_t>(size_[0]);
  return blend(corner.index, row, row * static_cast<std::size_t>(size_[1]), corner.share,
               [this](std::size_t voxel) { return static_cast<double>(depth_[voxel]); });
}

Section LabelShare::section(const Vec3d& point, const Vec3d& direction) const {
  const std::size_t least = std::abs(direction.x) <= std::abs(direction.y)
                                ? (std::abs(direction.x) <= std::abs(direction.z) ? 0 : 2)
                                : (std::abs(direction.y) <= std::abs(direction.z) ? 1 : 2);
  Vec3d aside{};
  aside[least] = 1;
  Vec3d u = cross(direction, aside);
  u = u / length(u);
  const Vec3d v = cross(direction, u);
  const double deep = depth(point);
  const double most = 3 * deep + 2 * step_;
  const int rays = std::clamp(static_cast<int>(std::ceil(2 * std::numbers::pi * deep / step_)), least_rays, most_rays);
  const double step = step_ / 2;
  Section out;
  Vec3d moment{};
  for (int r = 0; r < rays; ++r) {
    const double angle = 2 * std::numbers::pi * (r + 0.5) / rays;
    const Vec3d ray = std::cos(angle) * u + std::sin(angle) * v;
    double before = 1;
    for (double s = step / 2; s < most; s += step) {
      const double share = at(point + s * ray);
      if (share <= 0 || (before < 0.5 && share > before)) break;
      out.area += share * s;
      moment += (share * s * s) * ray;
      before = share;
    }
  }
  const double weight = step * 2 * std::numbers::pi / rays;
  out.centroid = out.area > 0 ? point + moment / out.area : point;
  out.area *= weight;
  return out;
}

double LabelShare::way_out(const Vec3d& point, const Vec3d& direction, double most) const {
  const double step = step_ / 4;
  double before = 1;
  for (double s = step; s < most; s += step) {
    const double share = at(point + s * direction);
    if (share <= 0.5) return s - step * (0.5 - share) / std::max(before - share, 1e-9);
    before = share;
  }
  return most;
}

}  // namespace blum::centrelines
