// Blum: points that are equally far from given points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Points near a start that are, by least squares, equally far from given points. They differ from the start only along
/// directions that the given points determine.
class EquidistantPoints {
 public:
  EquidistantPoints(std::span<const Vec3d> points, const Vec3d& start);

  /// Returns the start, moved along the `rank` strongest directions only.
  /// @param rank  1, 2 or 3.
  /// @return      nullopt if one of these directions is weaker than a tenth of the strongest, or if all given points
  /// coincide.
  [[nodiscard]] std::optional<Vec3d> of_rank(int rank) const;

 private:
  Vec3d start_;
  std::array<Vec3d, 3> moves_;       ///< move along each direction, by descending strength
  std::array<double, 3> strengths_;  ///< squared strength of each direction
};

}  // namespace blum::detail
