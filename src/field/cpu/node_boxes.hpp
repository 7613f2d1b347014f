// Blum: boxes of nodes and their division into eight children. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "field/cpu/tile_kernel.hpp"

namespace blum::cpu {

/// Length by which boxes are widened (normalised units). This length covers all rounding in the tests that cull sites
/// against boxes.
inline constexpr float box_slack = 3e-6F;

/// Box around nodes: centre and half-sizes in the normalised frame.
struct CenteredBox {
  Vec3f center;
  Vec3f half;  ///< reaches to the outermost nodes; not widened
};

inline CenteredBox centered(const FieldJob& job, const NodeBox& box) {
  CenteredBox out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half_steps = 0.5 * static_cast<double>(box.count[axis] - 1);
    out.center[axis] = static_cast<float>(job.first_node[axis] +
                                          job.spacing[axis] * (static_cast<double>(box.first[axis]) + half_steps));
    out.half[axis] = static_cast<float>(job.spacing[axis] * half_steps);
  }
  return out;
}

/// The up to eight children of a box of `size` nodes per side (clipped by the grid), in symmetric form. The centre of
/// child c is middle +- offset: plus along axis a if bit a of c is set, else minus. All nodes of child c lie within
/// `half` of its centre.
struct Halving {
  std::array<NodeBox, 8> child{};
  std::array<bool, 8> exists{};
  Vec3f middle, offset, half;

  /// Returns the largest distance, per axis, of the box's nodes from `middle`.
  [[nodiscard]] Vec3f reach() const { return offset + half; }
};

inline Halving halve(const FieldJob& job, const NodeBox& box, std::int64_t size) {
  Halving out;
  const std::int64_t half_size = size / 2;
  std::array<std::array<std::int64_t, 2>, 3> counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts[axis] = {std::min(half_size, box.count[axis]), std::max<std::int64_t>(box.count[axis] - half_size, 0)};
    const auto middle_of = [&](std::int64_t first, std::int64_t count) {
      return job.first_node[axis] +
             job.spacing[axis] * (static_cast<double>(first) + 0.5 * static_cast<double>(count - 1));
    };
    const double low = middle_of(box.first[axis], counts[axis][0]);
    const double high = counts[axis][1] > 0 ? middle_of(box.first[axis] + half_size, counts[axis][1]) : low;
    out.middle[axis] = static_cast<float>(0.5 * (low + high));
    out.offset[axis] = static_cast<float>(0.5 * (high - low));
    const auto longest = static_cast<double>(std::max(counts[axis][0], counts[axis][1]) - 1);
    out.half[axis] = static_cast<float>(0.5 * longest * job.spacing[axis]) + box_slack;
  }
  for (std::size_t c = 0; c < 8; ++c) {
    out.exists[c] = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t side = (c >> axis) & 1;
      out.child[c].first[axis] = box.first[axis] + (side != 0 ? half_size : 0);
      out.child[c].count[axis] = counts[axis][side];
      out.exists[c] = out.exists[c] && counts[axis][side] > 0;
    }
  }
  return out;
}

}  // namespace blum::cpu
