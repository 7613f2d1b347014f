// Blum: bounds on the distance to which a Voronoi region extends from its site. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "field/cpu/site_records.hpp"

namespace blum::cpu {

/// Coordinates of the surface's vertices, sorted along the Morton curve, in the normalised frame.
struct SurfacePoints {
  std::array<std::vector<float>, 3> coordinate;

  [[nodiscard]] std::size_t count() const { return coordinate[0].size(); }
};

using SixteenFloats = std::array<float, cluster_size>;
using SixteenVectors = std::array<SixteenFloats, 3>;

/// Sixteen convex sites. Each has up to three corners, and up to two unit directions that bound its domain. Missing
/// corners and directions are filled with copies of existing ones.
struct alignas(64) ReachInput {
  std::array<SixteenVectors, 3> corner;
  std::array<SixteenVectors, 2> direction;
};

/// For sixteen sites, finds upper bounds on the distance from the site at which it can still be closest. Let p be the
/// corners of a site, and w the directions of its domain. Then a surface point y is closer beyond the distance rho:
///   rho = max over p of |y - p|^2 / (2 min over p, w of w . (y - p)).
/// The reason: for a point p + r w of the domain, |y - (p + r w)|^2 < r^2 is linear in r. Here p varies over a convex
/// set, and w over a cone. The search takes the smallest rho over a few dozen vertices near `rank` on the Morton curve.
/// If none gives a bound, the result is far_away.
/// @param both  If true, both directions bound one wedge, and `first` receives its result. If false, each direction is
///              a separate domain (the two sides of a face): `first` and `second` receive their results.
void find_reaches(const ReachInput& input, const SurfacePoints& points, std::size_t rank, bool both,
                  SixteenFloats& first, SixteenFloats& second);

}  // namespace blum::cpu
