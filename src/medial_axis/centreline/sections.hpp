// Blum: sections of labelled voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/vec3.hpp"

namespace blum::centrelines {

/// The part of a plane, around a point, that lies in a label.
struct Section {
  double area = 0;
  Vec3d centroid{};
};

/// Share of a label at any point: 1 at the centres of its voxels, 0 at the centres of other voxels, trilinear between.
/// Integrated over a plane across a tube and averaged over all positions of the tube in the grid, the share yields the
/// section's area. The statement holds for any interpolation whose weights add up to 1.
class LabelShare {
 public:
  /// @param depth  for each voxel of a box: distance to the closest voxel outside of the label; 0 for voxels outside.
  /// It must outlive this object.
  /// @param size  number of voxels of the box along each axis.
  LabelShare(std::span<const float> depth, const std::array<std::int64_t, 3>& size, const Vec3d& spacing);

  /// Returns the share at a point.
  /// @param point  in coordinates in which voxel (i, j, k) has its centre at (i, j, k) times the spacing.
  [[nodiscard]] double at(const Vec3d& point) const;
  /// Returns the depth at a point, trilinear between voxel centres; 0 outside of the box.
  [[nodiscard]] double depth(const Vec3d& point) const;
  [[nodiscard]] double step() const { return step_; }  ///< shortest side of a voxel

  /// Returns the section in the plane through a point, perpendicular to a direction. It is sampled along rays from the
  /// point. Each ray ends where the label ends or another part of it begins, at most three times the point's depth plus
  /// two voxels away.
  /// @param direction  of length 1.
  [[nodiscard]] Section section(const Vec3d& point, const Vec3d& direction) const;

  /// Returns the distance from a point in the label, along a direction, to the first point where the share is 1/2. If
  /// there is none within `most`, it returns `most`.
  [[nodiscard]] double way_out(const Vec3d& point, const Vec3d& direction, double most) const;

 private:
  struct Corner;
  [[nodiscard]] bool locate(const Vec3d& point, Corner& corner) const;

  std::span<const float> depth_;
  std::array<std::int64_t, 3> size_;
  Vec3d spacing_;
  Vec3d inverse_;
  double step_;
};

}  // namespace blum::centrelines
