// Blum: footprints of the voxels of a solid, and walls around a point. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "blum/core/inline_list.hpp"
#include "medial_axis/cells/voxel_solid.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Greatest number of walls around a point: eight for the footprints of the eight voxels around a corner, and eight
/// more. In round solids, those voxels may miss walls.
inline constexpr std::size_t most_walls = 16;
/// Two footprints lie on different walls if the squared difference of the unit directions to them is at least this: 6
/// degrees.
inline constexpr double two_walls = 0.01;

/// Walls around a point, and the closest point on each wall. A wall is a part of the surface around a footprint.
class Walls {
 public:
  struct Wall {
    Footprint start;
    Vec3d outwards;       ///< direction away from the solid at `start`; zero if unknown
    Footprint foot;       ///< footprint of the point on this wall
    double distance = 0;  ///< of the point from the wall; negative if it is beyond, as at corners next to thin parts
  };

  /// @param reach  greatest distance that a footprint may move from its start, mesh units.
  Walls(const Surface& surface, double reach) : surface_(&surface), reach_(reach) {}

  [[nodiscard]] bool is_full() const { return walls_.is_full(); }
  void add(const Footprint& start, const Vec3d& outwards) { walls_.push_back({start, outwards, start, 0}); }

  /// Moves the point to x, and each footprint to the closest point of x on its wall. Two walls whose footprints become
  /// equal are merged.
  void follow_to(const Vec3d& x) {
    std::size_t kept = 0;
    closest_ = 0;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      Wall wall = walls_[w];
      wall.foot = surface_->follow(wall.start, x, reach_);
      const Vec3d away = x - wall.foot.point;
      wall.distance = dot(away, wall.outwards) > 0 ? -length(away) : length(away);
      const auto meets = [&](const Wall& other) {
        return other.foot.element == wall.foot.element && other.distance == wall.distance;
      };
      if (std::any_of(walls_.begin(), walls_.begin() + kept, meets)) continue;
      if (wall.distance < walls_[closest_].distance || kept == 0) closest_ = kept;
      walls_[kept++] = wall;
    }
    walls_.shrink(kept);
  }

  /// Returns the walls after the last call of follow_to().
  [[nodiscard]] std::span<const Wall> all() const { return walls_.span(); }
  [[nodiscard]] const Wall& closest() const { return walls_[closest_]; }
  /// Returns true if the point lies on one of the walls.
  [[nodiscard]] bool touch() const {
    return std::any_of(all().begin(), all().end(), [](const Wall& wall) { return wall.distance == 0; });
  }

 private:
  const Surface* surface_;
  double reach_;
  InlineList<Wall, most_walls> walls_;
  std::size_t closest_ = 0;
};

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// Centre of a voxel, or another point, and its footprint.
struct Governor {
  Vec3d centre;
  Footprint foot;
  /// Unit vector along the line to the footprint, out of the solid; zero if the point is on the surface.
  Vec3d direction;
  bool is_inside = false;
};

/// Returns the angle at x between two points, in degrees.
inline double angle_at(const Vec3d& x, const Vec3d& p, const Vec3d& q) {
  const Vec3d a = p - x;
  const Vec3d b = q - x;
  return std::atan2(length(cross(a, b)), dot(a, b)) * degrees_per_radian;
}

/// Governors of the eight voxels around a lattice node. Bits 0, 1 and 2 of the index are 1 for voxels on the upper side
/// along x, y and z.
using GovernorsAround = std::array<Governor, 8>;

class GovernorField {
 public:
  GovernorField(const VoxelSolid& solid, const Surface& surface) : solid_(solid), surface_(surface) {}

  [[nodiscard]] Governor at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    Governor g;
    const std::size_t voxel = solid_.grid.index(i, j, k);
    g.centre = solid_.grid.position(i, j, k);
    g.is_inside = solid_.depth[voxel] > 0;
    g.foot = surface_.footprint(solid_.site[voxel], g.centre, g.is_inside);
    const Vec3d out = g.is_inside ? g.foot.point - g.centre : g.centre - g.foot.point;
    const double size = length(out);
    if (size > 0) g.direction = out / size;
    return g;
  }
  [[nodiscard]] GovernorsAround around(const std::array<std::int64_t, 3>& node) const {
    GovernorsAround out;
    for (std::int64_t v = 0; v < 8; ++v) {
      out[static_cast<std::size_t>(v)] = at(node[0] - 1 + (v & 1), node[1] - 1 + (v >> 1 & 1), node[2] - 1 + (v >> 2));
    }
    return out;
  }

  [[nodiscard]] const VoxelSolid& solid() const { return solid_; }
  [[nodiscard]] const Surface& surface() const { return surface_; }
  /// Returns the longest side of a voxel, mesh units.
  [[nodiscard]] double longest_voxel() const {
    const Vec3d& h = solid_.grid.spacing;
    return std::max({h.x, h.y, h.z});
  }
  /// Returns the shortest side of a voxel, mesh units.
  [[nodiscard]] double voxel() const {
    const Vec3d& h = solid_.grid.spacing;
    return std::min({h.x, h.y, h.z});
  }

 private:
  const VoxelSolid& solid_;
  const Surface& surface_;
};

}  // namespace blum::detail
