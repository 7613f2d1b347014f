// Blum: regions of a Voronoi diagram and their neighbours. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Neighbour of a region, and the wall between the two regions.
struct VoronoiNeighbour {
  std::int32_t site = 0;  ///< Site of the neighbour.
  double area = 0;        ///< Area of the wall, square mesh units.
};

template <>
struct Description<VoronoiNeighbour> {
  static constexpr std::string_view name = "VoronoiNeighbour";
  static constexpr std::string_view doc = "Wall between a region and another one";
  static constexpr std::tuple members{
      Member{"site", &VoronoiNeighbour::site, "", "site of the other region"},
      Member{"area", &VoronoiNeighbour::area, "square mesh units", "area of the wall"},
  };
};

/// Region of one site: the points that are closest to the site.
struct VoronoiRegion {
  std::int32_t site = 0;
  double volume = 0;                         ///< Cubic mesh units; 0 if the complex has no surface.
  double surface_area = 0;                   ///< Area of the region's part of the surface, square mesh units.
  std::vector<VoronoiNeighbour> neighbours;  ///< By ascending site.
};

template <>
struct Description<VoronoiRegion> {
  static constexpr std::string_view name = "VoronoiRegion";
  static constexpr std::string_view doc = "Region of the points that are closest to a site";
  static constexpr std::tuple members{
      Member{"site", &VoronoiRegion::site, "", "site, numbered as site_a and site_b"},
      Member{"volume", &VoronoiRegion::volume, "cubic mesh units",
             "volume that the walls and the surface of the region enclose"},
      Member{"surface_area", &VoronoiRegion::surface_area, "square mesh units",
             "area of the region's part of the surface"},
      Member{"neighbours", &VoronoiRegion::neighbours, "", "regions on the other side of the region's walls"},
  };
};

/// Returns the regions of a result of voronoi_complex() that have triangles in their border, by ascending site. Volumes
/// and areas are computed from the triangles. The error of a volume is at most about the area of the region's walls
/// times VoronoiReport::hausdorff_bound, and usually much smaller. If the diagram is traced, the error is about the
/// area times VoronoiReport::chord. Regions thinner than a cube may have a volume of 0, or slightly below 0.
/// @param complex  with the columns `site_a` and `site_b`. Volumes are meaningful only if the complex contains the
/// surface (VoronoiPart::all).
/// @throws InvalidOption if a column is missing; InvalidMesh with the text of problem_of(complex).
/// Cost: O(n log n) for n triangles.
[[nodiscard]] std::vector<VoronoiRegion> voronoi_regions(const Complex& complex);

}  // namespace blum
