// Blum: the regions of a Voronoi diagram and their neighbours. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// The wall between a region and another one.
struct VoronoiNeighbour {
  std::int32_t site = 0;  ///< of the other one
  double area = 0;        ///< of the wall, square mesh units
};

template <>
struct Description<VoronoiNeighbour> {
  static constexpr std::string_view name = "VoronoiNeighbour";
  static constexpr std::string_view doc = "The wall between a region and another one";
  static constexpr std::tuple members{
      Member{"site", &VoronoiNeighbour::site, "", "of the other one"},
      Member{"area", &VoronoiNeighbour::area, "square mesh units", "of the wall"},
  };
};

/// What is closest to a site.
struct VoronoiRegion {
  std::int32_t site = 0;
  double volume = 0;                         ///< cubic mesh units; 0 where there is no surface
  double surface_area = 0;                   ///< of its part of the surface, square mesh units
  std::vector<VoronoiNeighbour> neighbours;  ///< by rising site
};

template <>
struct Description<VoronoiRegion> {
  static constexpr std::string_view name = "VoronoiRegion";
  static constexpr std::string_view doc = "What is closest to a site";
  static constexpr std::tuple members{
      Member{"site", &VoronoiRegion::site, "", "as site_a and site_b number them"},
      Member{"volume", &VoronoiRegion::volume, "cubic mesh units", "that its walls and its surface enclose"},
      Member{"surface_area", &VoronoiRegion::surface_area, "square mesh units", "of its part of the surface"},
      Member{"neighbours", &VoronoiRegion::neighbours, "", "the regions beyond its walls"},
  };
};

/// The regions of what voronoi_complex() makes, by rising site: those that triangles bound. Volumes and areas are those
/// of the triangles: off by at most about the area of a region's walls times VoronoiReport::hausdorff_bound, mostly
/// much less. Regions thinner than a cube may have a volume of 0, or a little below.
/// @param complex  with the columns `site_a` and `site_b`; with the surface (VoronoiPart::all), or volumes mean
/// nothing.
/// @throws InvalidOption where these are missing; InvalidMesh saying problem_of(complex).
/// Cost: O(n log n) in the triangles.
[[nodiscard]] std::vector<VoronoiRegion> voronoi_regions(const Complex& complex);

}  // namespace blum
