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

/// Cluster of convex sites: up to three corners each, and up to two unit directions between which their domains lie.
/// Corners and directions that a site lacks repeat another one.
struct alignas(64) ReachInput {
  std::array<SixteenVectors, 3> corner;
  std::array<SixteenVectors, 2> direction;
};

/// Finds upper bounds on the distance at which a site can still be closest, for sixteen sites. Let p be the corners of
/// a site, and w the directions of its domain. Beyond this rho a surface point y is closer:
///   rho = max over p of |y - p|^2 / (2 min over p, w of w . (y - p)).
/// The reason: |y - (p + r w)|^2 < r^2 is linear in r, p varies over a convex set, and w over a cone. The search takes
/// the smallest rho over some dozens of vertices near `rank` on the Morton curve; far_away if none gives one.
/// @param both  If true, both directions bound the same wedge, and `first` is for it. If false, each direction is a
///              domain of its own (the two sides of a face), with its own result.
void find_reaches(const ReachInput& input, const SurfacePoints& points, std::size_t rank, bool both,
                  SixteenFloats& first, SixteenFloats& second);

}  // namespace blum::cpu
