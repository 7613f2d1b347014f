// Blum: distances to the faces of voxels, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "certificate/box_hierarchy.hpp"

namespace blum::verifier {

/// The faces between voxels in a set and voxels that are not in it.
class VoxelFaces {
 public:
  using Voxel = std::array<std::int64_t, 3>;
  /// The lower face of a voxel along an axis. The voxel may lie just beyond the box of the set.
  struct Face {
    Voxel voxel{0, 0, 0};
    std::size_t axis = 0;
  };

  /// The voxels must outlive this object.
  /// @throws Cancelled.
  VoxelFaces(const VoxelSet& voxels, const GridSpec& grid, const Context& context);

  struct Nearest {
    double distance = HUGE_VAL;
    Face face;
  };
  /// Returns the face closest to a point in world coordinates, and the exact distance; HUGE_VAL if there is no face.
  [[nodiscard]] Nearest nearest(const Vec3d& p) const;
  [[nodiscard]] double distance(const Vec3d& p) const { return nearest(p).distance; }
  /// Returns the voxel of the set that contains a point, or one of them where voxels meet; nullopt outside.
  [[nodiscard]] std::optional<Voxel> voxel_at(const Vec3d& p) const;
  [[nodiscard]] bool contains(const Vec3d& p) const { return voxel_at(p).has_value(); }

  /// Returns the number of bricks of 4 x 4 x 4 voxels that have faces.
  [[nodiscard]] std::size_t brick_count() const { return bricks_.size(); }
  /// Calls use(face) for each face of a brick.
  template <class Use>
  void for_each_face(std::size_t brick, const Use& use) const;

  /// Checks that a segment lies in the voxels of the set, boundaries included, and returns one of the voxels that it
  /// meets. Returns nullopt if the segment leaves the set, or if rounding leaves this open.
  [[nodiscard]] std::optional<Voxel> held(const Vec3d& from, const Vec3d& to) const;

  /// Returns the rectangle of a face, along the axes of the grid and relative to its first node.
  [[nodiscard]] Box3 rectangle(const Face& face) const;
  [[nodiscard]] const GridSpec& grid() const { return grid_; }
  [[nodiscard]] const VoxelSet& voxels() const { return voxels_; }
  /// Returns the box of the faces, along the axes of the grid.
  [[nodiscard]] const Box3& box() const { return box_; }

 private:
  using Brick = std::array<std::int32_t, 3>;  ///< indices of a brick along x, y, z
  /// The voxels of a brick and those just before it along each axis. Bit x of entry y + 5 * z is voxel
  /// (x - 1, y - 1, z - 1) of the brick.
  using Window = std::array<std::uint8_t, 25>;

  [[nodiscard]] Window window(const Brick& brick) const;
  /// Calls use(x, y, z, axis) for the faces in a window. Voxels are counted from the brick's first voxel.
  template <class Use>
  static void for_each_face(const Window& in, const Use& use);
  /// Squared distances of a point from the planes and the slabs of a brick's voxels, along each axis.
  struct Apart;
  [[nodiscard]] Apart apart(const Vec3d& q, const Brick& brick) const;
  [[nodiscard]] std::uint8_t five_bits(std::int64_t i, std::int64_t j, std::int64_t k) const;
  void find_bricks(std::int32_t layer, std::vector<Brick>& found) const;
  /// Returns a voxel of the set that contains both points; nullopt if none does.
  /// @param a  like b, in units of voxels; a voxel extends from one integer to the next.
  [[nodiscard]] std::optional<Voxel> voxel_around(const Vec3d& a, const Vec3d& b) const;
  /// Returns a point in units of voxels, with the centres of voxels at integers.
  [[nodiscard]] Vec3d in_voxels(const Vec3d& p) const {
    const Vec3d q = local(p);
    return {q.x / grid_.spacing.x, q.y / grid_.spacing.y, q.z / grid_.spacing.z};
  }
  [[nodiscard]] Vec3d local(const Vec3d& p) const { return grid_.direction.transposed_times(p - grid_.origin); }

  const VoxelSet& voxels_;
  GridSpec grid_;
  std::vector<Brick> bricks_;    ///< in the tree's order
  std::vector<Window> windows_;  ///< for each brick
  std::vector<Box3> boxes_;      ///< for each brick: box of its faces
  BoxHierarchy tree_;
  Box3 box_;
};

template <class Use>
void VoxelFaces::for_each_face(const Window& in, const Use& use) {
  for (std::size_t z = 1; z < 5; ++z) {
    for (std::size_t y = 1; y < 5; ++y) {
      const unsigned row = in[y + 5 * z];
      const std::array<unsigned, 3> before{row << 1U, in[y - 1 + 5 * z], in[y + 5 * (z - 1)]};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (unsigned differ = (row ^ before[axis]) & 0x1eU; differ != 0; differ &= differ - 1) {
          use(static_cast<std::size_t>(std::countr_zero(differ)) - 1, y - 1, z - 1, axis);
        }
      }
    }
  }
}

template <class Use>
void VoxelFaces::for_each_face(std::size_t brick, const Use& use) const {
  const Brick& at = bricks_[brick];
  for_each_face(windows_[brick], [&](std::size_t x, std::size_t y, std::size_t z, std::size_t axis) {
    use(Face{
        {4 * std::int64_t{at[0]} + static_cast<std::int64_t>(x), 4 * std::int64_t{at[1]} + static_cast<std::int64_t>(y),
         4 * std::int64_t{at[2]} + static_cast<std::int64_t>(z)},
        axis});
  });
}

}  // namespace blum::verifier
