// Blum: the parts of a triangle that have one closest site. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/vec3.hpp"

namespace blum::surface {

/// A flat convex part of a mesh: a point, a segment, a triangle, or two triangles in one plane.
struct Facet {
  /// A side, from a corner to the next one.
  struct Side {
    Vec3d begin;
    Vec3d along;   ///< of length 1
    Vec3d inward;  ///< of length 1, in the plane of the facet
    double length = 0;
    std::array<std::uint8_t, 2> ends{};  ///< corners
    SiteId site;
  };
  InlineList<Vec3d, 4> corners;
  std::array<SiteId, 4> vertices{};
  InlineList<Side, 4> sides;
  Vec3d normal;            ///< of length 1
  SiteId face;             ///< site of a triangle in the plane
  bool has_plane = false;  ///< false also if the plane of a triangle is inaccurate
};

/// Makes a facet of one to four points.
/// @param corners  of a convex polygon, in order.
/// @param sides    entry k is the site of the side from corner k to the next one.
[[nodiscard]] Facet make_facet(std::span<const Vec3d> corners, std::span<const SiteId> vertices,
                               std::span<const SiteId> sides, SiteId face);

/// A convex part of a triangle.
struct NearestRegion {
  InlineList<Vec3d, 16> corners;
  SiteId site;  ///< the vertex, edge or face that is closest to all points of the part; none(): several, or unknown
};

/// Divides a triangle where the closest facet changes, or the closest part of a facet.
/// @param facets     all that may be closest to a point of the triangle. Their largest coordinate must be about 1.
/// @param most       greatest number of triangles that the parts may be divided into, at least 3.
/// @param tolerance  a site is treated as closest if the square of its distance exceeds the smallest square by at most
///                   this.
/// @param out        receives the parts.
/// Method: docs/theory/surface-maps.md.
void divide_by_nearest(const std::array<Vec3d, 3>& triangle, std::span<const Facet> facets, std::size_t most,
                       double tolerance, std::vector<NearestRegion>& out);

}  // namespace blum::surface
