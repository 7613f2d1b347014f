// Blum: the faces of voxels as the surface of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// The border between the voxels of a set and the others. Elements, and sites, are the others: linear indices of the
/// set's box, of closed voxels. Everything outside of the box is as if it were far away, so the set should stay off the
/// box's outermost layer. The set must outlive it.
class VoxelSurface final : public Surface {
 public:
  /// @param grid  of the voxel centres.
  VoxelSurface(const VoxelSet& voxels, const GridSpec& grid);

  /// @param site  the closest voxel of the other kind.
  [[nodiscard]] Footprint footprint(SiteId site, const Vec3d& centre, bool is_inside) const override;
  /// The middle of the voxel, along the grid's axes.
  [[nodiscard]] std::optional<Vec3d> rough_footprint(SiteId site) const override;
  [[nodiscard]] Footprint follow(const Footprint& start, const Vec3d& query, double reach) const override;
  [[nodiscard]] NearestPoint nearest(const Vec3d& query, const Footprint& near) const override;
  [[nodiscard]] bool is_inside(const Vec3d& /*query*/, const NearestPoint& nearest) const override {
    return nearest.distance > 0;
  }
  [[nodiscard]] SiteId site_of(const Footprint& foot) const override { return SiteId(foot.element); }

 private:
  using VoxelIndex = std::array<std::int64_t, 3>;
  /// Blocks of voxels, twice as long on a side as those of the level before: which of the eight blocks (or voxels, at
  /// the lowest level) in each hold voxels that are not in the set. Bit 0 of a bit's number tells the side along x.
  struct Level {
    VoxelIndex size{};
    std::vector<std::uint8_t> parts;
    [[nodiscard]] std::size_t index(const VoxelIndex& at) const {
      return static_cast<std::size_t>((at[2] * size[1] + at[1]) * size[0] + at[0]);
    }
  };
  struct Axes;
  struct Search;

  /// Bit n is set where voxel n - 1 along x from the middle one lies in the box and beyond the surface.
  [[nodiscard]] unsigned others_in_row(const VoxelIndex& middle) const;
  /// Coordinates along the grid's axes, mesh units, from the lower corner of voxel (0, 0, 0).
  [[nodiscard]] Vec3d local(const Vec3d& world) const;
  [[nodiscard]] Vec3d world(const Vec3d& local) const;
  [[nodiscard]] Vec3d closest_in(const VoxelIndex& lower, std::int64_t side, const Vec3d& query) const;
  /// Which of the 27 voxels around one is closest to a local point, if it is closer than a squared distance; else -1.
  /// Steps are jumped over: that of a stair, but not the corner of a thin part.
  [[nodiscard]] int closer_neighbour(const VoxelIndex& voxel, const Vec3d& query, double squared) const;
  [[nodiscard]] int closest_of(const VoxelIndex& voxel, const Axes& axes, double squared) const;
  void search(Search& best, std::size_t level, const VoxelIndex& block) const;

  const VoxelSet& voxels_;
  GridSpec grid_;
  std::vector<Level> levels_;  ///< index 0 is blocks of 2 voxels on a side; the last one has one block
};

}  // namespace blum::detail
