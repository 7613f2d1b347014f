// Blum: the middle of what is round. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "blum/core/vec3.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum {

/// A point in the middle of a round tube near by; of a ball, if it is next to its middle.
struct RoundCentre {
  Vec3d position;
  std::vector<Footprint> feet;  ///< on the surface all around, about as far from it
};

/// What round_centre() looks for.
struct RoundLimits {
  double voxel = 0;  ///< mesh units: feet count as equally far within 0.02 of it
  double reach = 0;  ///< mesh units, from the start
  double theta = 0;  ///< degrees: the middle sees this, or more
};

/// The point that the surface all around is equally far from, by least squares over the closest points of places beside
/// it. Facets of round things meet in no one point, but for next to nothing of them, so walls are not told apart.
/// @param start  within the reach.
/// @return       nullopt where the surface is not all around, as beside a sheet.
/// Cost: some 80 closest points, 2 or 8 where nothing is round for the most part.
[[nodiscard]] std::optional<RoundCentre> round_centre(const Surface& surface, const Vec3d& start,
                                                      const RoundLimits& limits);

}  // namespace blum
