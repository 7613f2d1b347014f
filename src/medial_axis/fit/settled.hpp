// Blum: vertices that a step of fitting need not look at again. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_set>

#include "medial_axis/shape/axis_vertex.hpp"

namespace blum {

/// A hash of what a step sees, of 64 bits: another sight has the same one of 10^6 in 10^-7 of all runs.
class SightHash {
 public:
  void add(std::uint64_t word) {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;  // of the golden ratio
    state_ = std::rotl(state_ ^ word, 29) * odd;
    state_ ^= state_ >> 32U;
  }
  void add(const Vec3d& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) add(std::bit_cast<std::uint64_t>(v[axis]));
  }
  void add(const AxisVertex& vertex) {
    add(vertex.position);
    add(vertex.footprints[0]);
    add(vertex.footprints[1]);
    add(std::bit_cast<std::uint64_t>(vertex.separation_angle));
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

/// Hashes of what a step saw where it left the vertex as it was.
using Settled = std::unordered_set<std::uint64_t>;

/// Whether a vertex is the same but for rounding. @param voxel  mesh units.
inline bool is_same_vertex(const AxisVertex& a, const AxisVertex& b, double voxel) {
  constexpr double next_to_nothing = 1e-6;  // voxels, degrees
  const double most = next_to_nothing * voxel;
  return a.sites == b.sites && squared_length(a.position - b.position) <= most * most &&
         std::abs(a.radius - b.radius) <= most && std::abs(a.separation_angle - b.separation_angle) <= next_to_nothing;
}

}  // namespace blum
