// Blum: how far a bent curve can be followed before other sites are as close. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "blum/core/vec3.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// Points of a curve in planes at right angles to one direction, at Chebyshev nodes of the way along it.
struct CurveSamples {
  static constexpr std::size_t count = 9;
  double length = 0;  ///< of the way, mesh units
  std::array<Vec3d, count> points;

  /// Returns the way to a point, as a part of the length.
  static double share(std::size_t k);
};

/// A path length along a curve.
struct ClearWay {
  double length = 0;                       ///< path length before which no other site is as close, mesh units
  std::optional<TracedSites::Index> site;  ///< may be as close a little further on
};

/// Finds how far a curve stays apart from other sites. Distances along a short piece of a curve are nearly polynomials
/// of low degree, so interpolation finds where they become equal.
/// @param own     sites of the curve.
/// @param others  all other sites that the piece may reach.
/// @return nothing if interpolation is not as precise as the tolerance of distances, or the piece leaves the domain of
///   an own site.
[[nodiscard]] std::optional<ClearWay> clear_way(const TracedSites& sites, const CurveSamples& samples,
                                                std::span<const TracedSites::Index> own,
                                                std::span<const TracedSites::Index> others);

}  // namespace blum::voronoi
