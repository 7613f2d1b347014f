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

/// Feature of a triangle: corner `index`, the edge from corner `index` to the next corner, or the open face (with
/// `index` 0).
struct TriangleFeature {
  SiteKind kind = SiteKind::vertex;
  std::uint8_t index = 0;
  [[nodiscard]] friend constexpr bool operator==(const TriangleFeature&, const TriangleFeature&) = default;
};

/// Distance of two triangles, and a pair of points at this distance.
struct TriangleDistance {
  double distance = 0;  ///< mesh units; 0 if and only if the triangles have a common point
  Vec3d first_point;    ///< point of the first triangle; if the triangles meet, a point near both triangles
  Vec3d second_point;
  TriangleFeature first_feature;  ///< feature of the lowest dimension that contains first_point
  TriangleFeature second_feature;
};

/// Returns the closest points of two triangles. A triangle may have no area: it is then a segment or a point.
///
/// The distance is 0 if and only if the triangles have a common point. Otherwise it is at least the smallest normal
/// double. The guarantees for distance 0 and positive distances require that the magnitude of each coordinate is 0 or
/// at least 1e-80 times the largest magnitude. Positive distances have an error of a few 1e-15 times the largest
/// coordinate relative to a corner of the triangles. The error does not depend on the shape of the triangles.
/// @param a, b  corners of the triangles; finite, of magnitude at most 1e150.
/// @return      closest points and their distance. If the two triangles are exchanged, the result is the same up to
///              rounding.
/// Cost: about 0.4 microseconds. Method: docs/theory/proximity.md.
[[nodiscard]] TriangleDistance triangle_distance(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

/// Returns true if two triangles have a common point. Triangles may have no area. The answer is exact if coordinates
/// satisfy the condition for the guarantees of triangle_distance().
[[nodiscard]] bool triangles_meet(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

/// Returns the distances of many pairs, computed with threads.
/// @param a, b  lists of the same length; pair k is (a[k], b[k]).
/// @throws InvalidOption if the sizes differ; InvalidMesh if a coordinate is not finite, or beyond 1e150; Cancelled.
[[nodiscard]] std::vector<TriangleDistance> triangle_distances(std::span<const std::array<Vec3d, 3>> a,
                                                               std::span<const std::array<Vec3d, 3>> b,
                                                               const Context& context = {});

}  // namespace blum
