// Blum: medial axes as complexes of vertices, edges and triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Where a vertex or edge of a medial axis lies.
enum class MedialRole : std::uint8_t {
  sheet,     ///< inside a sheet: all around it is surface
  rim,       ///< on the free border of a sheet
  seam,      ///< where three or more triangles meet
  curve,     ///< on no triangle
  junction,  ///< a vertex where seams or curves begin, end or meet, or sheets touch
};
[[nodiscard]] std::string_view to_string(MedialRole role);

/// A vertex of a medial axis: the centre of a ball that the solid holds.
struct MedialVertex {
  Vec3d position;
  double radius = 0;  ///< exact distance from the position to the surface, mesh units
  /// The closest point of the surface, and that of the other wall; the same point twice where only one wall is near.
  std::array<Vec3d, 2> footprints;
  std::array<SiteId, 2> sites;  ///< of the input mesh, or voxels of the input image, that the footprints lie on
  double separation_angle = 0;  ///< between the footprints as the position sees them, degrees
  MedialRole role = MedialRole::sheet;
};

/// An edge that is no inner edge of a sheet.
struct MedialEdge {
  std::array<std::uint32_t, 2> vertices;
  float separation_angle = 0;  ///< degrees; 0 where only homotopy keeps the edge
  MedialRole role = MedialRole::curve;
};

struct MedialTriangle {
  std::array<std::uint32_t, 3> vertices;
  float separation_angle = 0;  ///< degrees; 0 where only homotopy keeps the triangle
  /// Sheets are the triangles joined through edges that exactly two triangles share; next to a seam, not through edges
  /// where these are 37 degrees from flat, or more.
  std::uint32_t sheet = 0;
};

/// A medial axis: the vertices, the edges, the triangles, and the edges and vertices of these.
struct MedialComplex {
  std::vector<MedialVertex> vertices;
  std::vector<MedialEdge> edges;  ///< curves, rims and seams
  std::vector<MedialTriangle> triangles;
  std::uint32_t sheet_count = 0;
};

/// How many of each there are.
struct MedialCounts {
  std::size_t vertices = 0, triangles = 0, sheets = 0;
  std::size_t curve_edges = 0, rim_edges = 0, seam_edges = 0, junctions = 0;
};
[[nodiscard]] MedialCounts count(const MedialComplex& complex);

}  // namespace blum
