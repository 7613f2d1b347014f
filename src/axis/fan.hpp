// Blum: triangles around a vertex, and what is left of them without it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// A point of an axis with its radius.
struct AxisPoint {
  Vec3d position;
  double radius = 0;
};

/// Triangles (centre, ring[k], ring[k + 1]) of one sheet around a vertex.
struct Fan {
  std::vector<std::uint32_t> ring;       ///< vertices; of a closed fan, the first one follows the last one
  std::vector<std::uint32_t> triangles;  ///< between ring[k] and ring[k + 1]
  bool is_closed = false;
};

/// How far a sheet or a chain moves, upper bounds.
struct Deviation {
  /// Between what was and what is, either way; and how far radii that are interpolated linearly change.
  double by = 0;
  /// From what is to what was: 0 where only a tip of a sheet goes.
  double beyond = 0;
};

/// How far a sheet moves when the centre of a fan goes to its first ring vertex, so that the other ring vertices are
/// joined to that one. nullopt where triangles would fold over, or turn by much.
/// @param ring  as Fan has it, beginning with the vertex that the centre goes to.
[[nodiscard]] std::optional<Deviation> deviation(const AxisPoint& centre, std::span<const AxisPoint> ring,
                                                 bool is_closed);

/// The same of a point of a chain, which goes: the segment between its neighbours is left.
[[nodiscard]] Deviation deviation(const AxisPoint& point, const AxisPoint& a, const AxisPoint& b);

}  // namespace blum::detail
