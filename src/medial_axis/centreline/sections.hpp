// Blum: sections of labelled voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/vec3.hpp"

namespace blum::centrelines {

/// Part of a plane around a point that lies in a label.
struct Section {
  double area = 0;
  Vec3d centroid{};
};

/// Share of a label at any place: 1 at the centres of its voxels, 0 at those of others, trilinear between. Its integral
/// over a plane across a tube is the tube's section, in the mean over all places of the tube in the grid. The same
/// holds for any smoothing whose weights add up to 1.
class LabelShare {
 public:
  /// @param depth  of each voxel of a box: distance to the closest one outside of the label; 0 outside. It must outlive
  /// this object.
  /// @param size  of the box.
  LabelShare(std::span<const float> depth, const std::array<std::int64_t, 3>& size, const Vec3d& spacing);

  /// Returns the share at a point.
  /// @param point  voxel centres are at the multiples of the spacing.
  [[nodiscard]] double at(const Vec3d& point) const;
  /// Returns the depth at a point, trilinear between voxel centres; 0 outside of the box.
  [[nodiscard]] double depth(const Vec3d& point) const;
  [[nodiscard]] double step() const { return step_; }  ///< shortest side of a voxel

  /// Returns the section by the plane through a point across a direction, as seen from the point. Each ray ends where
  /// the label ends or another part of it begins, at the latest after three depths and two voxels.
  /// @param direction  of length 1.
  [[nodiscard]] Section section(const Vec3d& point, const Vec3d& direction) const;

  /// Returns the distance from a point in the label, along a direction, to where the share falls to 1/2; at most
  /// `most`.
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
