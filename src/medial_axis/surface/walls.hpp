// Blum: walls of a solid around a point. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "blum/core/inline_list.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// The eight voxels around a corner see not all walls of round things: as many others may turn up.
inline constexpr std::size_t most_walls = 16;
/// Squared difference of the directions to two footprints from which they count as two walls: 6 degrees.
inline constexpr double two_walls = 0.01;

/// The walls around a point, and what is closest to it on each.
class Walls {
 public:
  struct Wall {
    Footprint start;
    Vec3d outwards;       ///< at the start; zero where it is not known
    Footprint foot;       ///< of the point
    double distance = 0;  ///< from it; negative beyond the wall, as corners next to thin parts are
  };

  /// @param reach  how far a footprint may move from its start, mesh units.
  Walls(const Surface& surface, double reach) : surface_(&surface), reach_(reach) {}

  [[nodiscard]] bool is_full() const { return walls_.is_full(); }
  void add(const Footprint& start, const Vec3d& outwards) { walls_.push_back({start, outwards, start, 0}); }

  /// Two walls whose footprints meet are one from then on.
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

  /// What follow_to() found.
  [[nodiscard]] std::span<const Wall> all() const { return walls_.span(); }
  [[nodiscard]] const Wall& closest() const { return walls_[closest_]; }
  /// Whether the point is on one of them.
  [[nodiscard]] bool touch() const {
    return std::any_of(all().begin(), all().end(), [](const Wall& wall) { return wall.distance == 0; });
  }

 private:
  const Surface* surface_;
  double reach_;
  InlineList<Wall, most_walls> walls_;
  std::size_t closest_ = 0;
};

}  // namespace blum::detail
