// Blum: how far two triangles are apart, and whether they meet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"

namespace blum {

/// A part of a triangle: corner `index`, the edge from corner `index` to the next one, or the inside (0).
struct TriangleFeature {
  SiteKind kind = SiteKind::vertex;
  std::uint8_t index = 0;
  [[nodiscard]] friend constexpr bool operator==(const TriangleFeature&, const TriangleFeature&) = default;
};

/// How far two triangles are apart, and where.
struct TriangleDistance {
  double distance = 0;  ///< mesh units; 0 just where they have a point in common
  Vec3d first_point;    ///< of the first triangle; where they meet, a point near both
  Vec3d second_point;
  TriangleFeature first_feature;  ///< the smallest part that first_point lies on
  TriangleFeature second_feature;
};

/// The closest points of two triangles. A triangle may have lost its area: it is then a segment, or a point.
///
/// Whether the distance is 0 is exact for the coordinates as they are (of which none may be smaller than 1e-80 of the
/// largest one, unless it is 0): triangles that miss each other are at least 1e-300 of their size apart, and those that
/// have as little as a point in common are not. Other distances are rounded by no more than some 1e-15 of the largest
/// coordinate relative to a corner, whatever the shape of the triangles.
/// @param a, b  corners; finite, of magnitude at most 1e150.
/// @return      the same for the same triangles in the same order; with the two exchanged, the same but for rounding.
/// Cost: about 0.4 microseconds. Method: docs/theory/proximity.md.
[[nodiscard]] TriangleDistance triangle_distance(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

/// Whether two triangles, which may have lost their area, have a point in common: exact, as above.
[[nodiscard]] bool triangles_meet(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

/// The same for many, threaded. @param a, b  as many. @throws InvalidOption where they are not; InvalidMesh where a
/// coordinate is not finite, or beyond 1e150; Cancelled.
[[nodiscard]] std::vector<TriangleDistance> triangle_distances(std::span<const std::array<Vec3d, 3>> a,
                                                               std::span<const std::array<Vec3d, 3>> b,
                                                               const Context& context = {});

}  // namespace blum
