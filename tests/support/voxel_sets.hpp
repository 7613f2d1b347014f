// Blum: sets of voxels and grids for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "blum/core/random.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::test {

/// Calls visit(i, j, k) for the voxels of a box, except the outermost `margin` layers.
template <class Visit>
void for_each_voxel(const std::array<std::int64_t, 3>& size, std::int64_t margin, const Visit& visit) {
  for (std::int64_t k = margin; k + margin < size[2]; ++k) {
    for (std::int64_t j = margin; j + margin < size[1]; ++j) {
      for (std::int64_t i = margin; i + margin < size[0]; ++i) visit(i, j, k);
    }
  }
}

/// The voxels for which is_in(i, j, k) is true, except in the outermost layer.
template <class IsIn>
VoxelSet voxels_where(const std::array<std::int64_t, 3>& size, const IsIn& is_in) {
  VoxelSet voxels(size);
  for_each_voxel(size, 1, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    if (is_in(i, j, k)) voxels.insert(i, j, k);
  });
  return voxels;
}

/// A random set that contains each voxel with the same probability, except the outermost layer.
inline VoxelSet random_voxels(const std::array<std::int64_t, 3>& size, double density, Random& random) {
  return voxels_where(size, [&](auto...) { return random.uniform() < density; });
}

/// A rotated grid whose voxels have three different side lengths.
inline GridSpec turned_grid(const std::array<std::int64_t, 3>& size) {
  const double c = std::cos(0.7);
  const double s = std::sin(0.7);
  GridSpec grid{{3, -20, 7}, {0.5, 1.25, 2}, size, {}};
  grid.direction.columns[0] = {c, s, 0};
  grid.direction.columns[1] = {-s * c, c * c, s};
  grid.direction.columns[2] = {s * s, -c * s, c};
  return grid;
}

}  // namespace blum::test
