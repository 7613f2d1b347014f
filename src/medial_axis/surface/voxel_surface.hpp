// Blum: the faces of voxels as the surface of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Border between the voxels of a set and the other voxels of its box. Elements and sites are the other voxels, as
/// closed boxes; their numbers are linear indices. Voxels outside of the box are ignored, so no voxel of the set should
/// lie in the outermost layer of the box. The set must outlive this object.
class VoxelSurface final : public Surface {
 public:
  /// @param grid  its nodes are the voxel centres.
  VoxelSurface(const VoxelSet& voxels, const GridSpec& grid);

  /// @param site  the closest voxel of the other kind: outside the set if `centre` is inside, and inside the set
  /// otherwise.
  [[nodiscard]] Footprint footprint(SiteId site, const Vec3d& centre, bool is_inside) const override;
  /// Returns the middle of the voxel `site`, in coordinates along the axes of the grid.
  [[nodiscard]] std::optional<Vec3d> rough_footprint(SiteId site) const override;
  [[nodiscard]] Footprint follow(const Footprint& start, const Vec3d& query, double reach) const override;
  [[nodiscard]] NearestPoint nearest(const Vec3d& query, const Footprint& near) const override;
  [[nodiscard]] bool is_inside(const Vec3d& /*query*/, const NearestPoint& nearest) const override {
    return nearest.distance > 0;
  }
  [[nodiscard]] SiteId site_of(const Footprint& foot) const override { return SiteId(foot.element); }

 private:
  using VoxelIndex = std::array<std::int64_t, 3>;
  /// Blocks of voxels, each twice as long on a side as the blocks of the level before. A block has eight parts: blocks
  /// of the level before, or voxels at the lowest level. A bit of `parts` is set if that part contains a voxel outside
  /// the set. Bits 0, 1 and 2 of the bit's number are 1 for parts on the upper side along x, y and z.
  struct Level {
    VoxelIndex size{};
    std::vector<std::uint8_t> parts;
    [[nodiscard]] std::size_t index(const VoxelIndex& at) const {
      return static_cast<std::size_t>((at[2] * size[1] + at[1]) * size[0] + at[0]);
    }
  };
  struct Axes;
  struct Search;

  /// Returns three bits: bit n is set if the voxel n - 1 steps along x from `middle` lies in the box and outside the
  /// set.
  [[nodiscard]] unsigned others_in_row(const VoxelIndex& middle) const;
  /// Returns the coordinates of a point along the grid's axes, mesh units, relative to the lower corner of voxel (0, 0,
  /// 0).
  [[nodiscard]] Vec3d local(const Vec3d& world) const;
  [[nodiscard]] Vec3d world(const Vec3d& local) const;
  [[nodiscard]] Vec3d closest_in(const VoxelIndex& lower, std::int64_t side, const Vec3d& query) const;
  /// Searches, among the 27 voxels around and including `voxel`, the voxel outside the set that is closest to a local
  /// point. Returns its number, 0 to 26, or -1 if no squared distance is below `squared`. The search passes over steps
  /// of a staircase, but not around corners of thin parts.
  [[nodiscard]] int closer_neighbour(const VoxelIndex& voxel, const Vec3d& query, double squared) const;
  [[nodiscard]] int closest_of(const VoxelIndex& voxel, const Axes& axes, double squared) const;
  void search(Search& best, std::size_t level, const VoxelIndex& block) const;

  const VoxelSet& voxels_;
  GridSpec grid_;
  std::vector<Level> levels_;  ///< level 0 has blocks of 2 voxels on a side; the last level has one block
};

}  // namespace blum::detail
