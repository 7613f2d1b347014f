// Blum: how far from its site a Voronoi region can extend. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "field/cpu/site_records.hpp"

namespace blum::cpu {

/// Coordinates of the surface's vertices along the Morton curve, in the normalised frame.
struct SurfacePoints {
  std::array<std::vector<float>, 3> coordinate;

  [[nodiscard]] std::size_t count() const { return coordinate[0].size(); }
};

using SixteenFloats = std::array<float, cluster_size>;
using SixteenVectors = std::array<SixteenFloats, 3>;

/// A cluster of convex sites: up to three corners each, and up to two unit directions between which their domains lie.
/// Corners and directions that a site lacks repeat another one.
struct alignas(64) ReachInput {
  std::array<SixteenVectors, 3> corner;
  std::array<SixteenVectors, 2> direction;
};

/// Upper bounds on the distance at which a site can still be closest, for sixteen sites: beyond rho from a site with
/// corners p, along its domain's directions w, a surface point y is closer, if
///   rho = max over p of |y - p|^2 / (2 min over p, w of w . (y - p)),
/// because |y - (p + r w)|^2 < r^2 is linear in r, p varies over a convex set, and w over a cone. The smallest rho over
/// some dozens of vertices near `rank` on the Morton curve is taken; far_away where there is none.
/// @param both  true: both directions bound the same wedge, and first is for it. false: each direction is a domain of
/// its
///              own (the two sides of a face), with its own result.
void find_reaches(const ReachInput& input, const SurfacePoints& points, std::size_t rank, bool both,
                  SixteenFloats& first, SixteenFloats& second);

}  // namespace blum::cpu
