// Blum: the faces of voxels as the surface of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Border between the voxels of a set and the others. Elements and sites are the other voxels, closed, as linear
/// indices of the set's box. Everything outside of the box counts as far away. The set should therefore stay off the
/// outermost layer of the box. The set must outlive this object.
class VoxelSurface final : public Surface {
 public:
  /// @param grid  of the voxel centres.
  VoxelSurface(const VoxelSet& voxels, const GridSpec& grid);

  /// @param site  the closest voxel of the other kind.
  [[nodiscard]] Footprint footprint(SiteId site, const Vec3d& centre, bool is_inside) const override;
  /// Returns the middle of the voxel, along the axes of the grid.
  [[nodiscard]] std::optional<Vec3d> rough_footprint(SiteId site) const override;
  [[nodiscard]] Footprint follow(const Footprint& start, const Vec3d& query, double reach) const override;
  [[nodiscard]] NearestPoint nearest(const Vec3d& query, const Footprint& near) const override;
  [[nodiscard]] bool is_inside(const Vec3d& /*query*/, const NearestPoint& nearest) const override {
    return nearest.distance > 0;
  }
  [[nodiscard]] SiteId site_of(const Footprint& foot) const override { return SiteId(foot.element); }

 private:
  using VoxelIndex = std::array<std::int64_t, 3>;
  /// Blocks of voxels, twice as long on a side as those of the level before. Bits mark the parts of a block that
  /// contain voxels outside the set. Its eight parts are blocks, or voxels at the lowest level. Bits 0, 1 and 2 of a
  /// bit's number are the sides along x, y and z.
  struct Level {
    VoxelIndex size{};
    std::vector<std::uint8_t> parts;
    [[nodiscard]] std::size_t index(const VoxelIndex& at) const {
      return static_cast<std::size_t>((at[2] * size[1] + at[1]) * size[0] + at[0]);
    }
  };
  struct Axes;
  struct Search;

  /// Returns bits: bit n is set if voxel n - 1 along x from the middle one lies in the box and outside the set.
  [[nodiscard]] unsigned others_in_row(const VoxelIndex& middle) const;
  /// Returns coordinates along the grid's axes, mesh units, from the lower corner of voxel (0, 0, 0).
  [[nodiscard]] Vec3d local(const Vec3d& world) const;
  [[nodiscard]] Vec3d world(const Vec3d& local) const;
  [[nodiscard]] Vec3d closest_in(const VoxelIndex& lower, std::int64_t side, const Vec3d& query) const;
  /// Returns the number of the voxel closest to a local point, of the 27 around one. Returns -1 if none is closer than
  /// a squared distance. The search crosses steps of stairs, but not corners of thin parts.
  [[nodiscard]] int closer_neighbour(const VoxelIndex& voxel, const Vec3d& query, double squared) const;
  [[nodiscard]] int closest_of(const VoxelIndex& voxel, const Axes& axes, double squared) const;
  void search(Search& best, std::size_t level, const VoxelIndex& block) const;

  const VoxelSet& voxels_;
  GridSpec grid_;
  std::vector<Level> levels_;  ///< index 0 is blocks of 2 voxels on a side; the last one has one block
};

}  // namespace blum::detail
