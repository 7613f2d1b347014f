// Blum: exact contact and distance of two triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"

namespace blum {

/// Part of a triangle: corner `index`, the edge from corner `index` to the next one, or the inside (0).
struct TriangleFeature {
  SiteKind kind = SiteKind::vertex;
  std::uint8_t index = 0;
  [[nodiscard]] friend constexpr bool operator==(const TriangleFeature&, const TriangleFeature&) = default;
};

/// Distance of two triangles and their closest points.
struct TriangleDistance {
  double distance = 0;  ///< mesh units; 0 exactly if they have a common point
  Vec3d first_point;    ///< on the first triangle; if they meet, a point near both
  Vec3d second_point;
  TriangleFeature first_feature;  ///< smallest part that contains first_point
  TriangleFeature second_feature;
};

/// Returns the closest points of two triangles. A triangle may have no area: it is then a segment or a point.
///
/// The distance is 0 exactly if the triangles have a common point. Otherwise it is at least the smallest normal double.
/// This holds for the given coordinates, if these are 0 or at least 1e-80 of the largest one. Positive distances have
/// an error of some 1e-15 of the largest coordinate relative to a corner, whatever the shape of the triangles.
/// @param a, b  corners; finite, of magnitude at most 1e150.
/// @return      the same for the same triangles in the same order. With the two exchanged, the same up to rounding.
/// Cost: about 0.4 microseconds. Method: docs/theory/proximity.md.
[[nodiscard]] TriangleDistance triangle_distance(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

/// Returns true if two triangles have a common point. They may have no area. The answer is exact, as above.
[[nodiscard]] bool triangles_meet(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

/// Returns the distances of many pairs, computed with threads.
/// @param a, b  of equal size.
/// @throws InvalidOption if the sizes differ; InvalidMesh if a coordinate is not finite, or beyond 1e150; Cancelled.
[[nodiscard]] std::vector<TriangleDistance> triangle_distances(std::span<const std::array<Vec3d, 3>> a,
                                                               std::span<const std::array<Vec3d, 3>> b,
                                                               const Context& context = {});

}  // namespace blum
