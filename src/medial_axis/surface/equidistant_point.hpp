// Blum: the point that is as far from some points as from the others. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// The points near a start whose distances from given points differ least, moved only along the directions in which
/// these say anything.
class EquidistantPoints {
 public:
  EquidistantPoints(std::span<const Vec3d> points, const Vec3d& start);

  /// Moved along the strongest directions only.
  /// @param rank  how many: 1, 2 or 3.
  /// @return      nullopt where the points say less (a direction is weaker than a tenth of the strongest, or all are
  /// one).
  [[nodiscard]] std::optional<Vec3d> of_rank(int rank) const;

 private:
  Vec3d start_;
  std::array<Vec3d, 3> moves_;       ///< by falling strength
  std::array<double, 3> strengths_;  ///< squares
};

}  // namespace blum::detail
