// Blum: the planes of a grid of cubes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::detail {

using Place = std::array<std::int32_t, 3>;

/// The coordinates of the planes across each axis, in ascending order and evenly spaced up to rounding. Cube i lies
/// between planes i and i + 1. A point in a plane counts as above it.
class GridPlanes {
 public:
  GridPlanes() = default;
  /// Makes planes `first` to `last` across each axis, both included. Plane i lies at origin + i * spacing.
  /// @param spacing  > 0, and so large that neighbouring planes have different coordinates.
  GridPlanes(const Vec3d& origin, const Vec3d& spacing, const Place& first, const Place& last) : spacing_(spacing) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::int32_t i = first[a]; i <= last[a]; ++i) at_[a].push_back(origin[a] + i * spacing[a]);
    }
  }

  [[nodiscard]] double at(std::size_t axis, std::int64_t plane) const {
    return at_[axis][static_cast<std::size_t>(plane)];
  }
  [[nodiscard]] std::int32_t count(std::size_t axis) const { return static_cast<std::int32_t>(at_[axis].size()); }
  [[nodiscard]] const Vec3d& spacing() const { return spacing_; }
  /// Returns the position of the node with the given indices.
  /// @param place  indices along x, y, z: a Place, or a place of a CellLattice.
  template <class Integer = std::int32_t>
  [[nodiscard]] Vec3d node(const std::array<Integer, 3>& place) const {
    return {at(0, place[0]), at(1, place[1]), at(2, place[2])};
  }
  /// Returns the cube that contains a point between the outermost planes. If the point lies in the last plane, returns
  /// indices beyond the last cube.
  [[nodiscard]] Place cube(const Vec3d& p) const { return {between(0, p.x), between(1, p.y), between(2, p.z)}; }

 private:
  [[nodiscard]] std::int32_t between(std::size_t axis, double coordinate) const {
    auto i = static_cast<std::int32_t>((coordinate - at_[axis].front()) / spacing_[axis]);
    while (i > 0 && coordinate < at(axis, i)) --i;
    while (i + 1 < count(axis) && coordinate >= at(axis, i + 1)) ++i;
    return i;
  }

  Vec3d spacing_;
  std::array<std::vector<double>, 3> at_;
};

}  // namespace blum::detail
