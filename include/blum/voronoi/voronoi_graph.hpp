// Blum: regions, walls, seams and junctions of a Voronoi diagram. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/voronoi/voronoi_regions.hpp"

namespace blum {

/// A connected part of the border between two regions.
struct VoronoiWall {
  std::int32_t site_a = 0;           ///< of the region on one side: the smaller one
  std::int32_t site_b = 0;           ///< of that on the other
  double area = 0;                   ///< square mesh units
  std::vector<std::uint32_t> seams;  ///< along its border, rising
};

template <>
struct Description<VoronoiWall> {
  static constexpr std::string_view name = "VoronoiWall";
  static constexpr std::string_view doc = "A connected part of the border between two regions";
  static constexpr std::tuple members{
      Member{"site_a", &VoronoiWall::site_a, "", "the region on one side: the smaller site"},
      Member{"site_b", &VoronoiWall::site_b, "", "the region on the other"},
      Member{"area", &VoronoiWall::area, "square mesh units", "of its triangles"},
      Member{"seams", &VoronoiWall::seams, "", "along its border: places in the list of seams"},
  };
};

/// A line in which regions of three or more sites meet.
struct VoronoiSeam {
  std::vector<std::int32_t> sites;       ///< of the regions around it, rising
  double length = 0;                     ///< mesh units
  std::vector<std::uint32_t> walls;      ///< that meet in it, rising
  std::vector<std::uint32_t> junctions;  ///< at which it ends, rising: two, one where it returns, none of a closed line
};

template <>
struct Description<VoronoiSeam> {
  static constexpr std::string_view name = "VoronoiSeam";
  static constexpr std::string_view doc = "A line in which regions of three or more sites meet";
  static constexpr std::tuple members{
      Member{"sites", &VoronoiSeam::sites, "", "of the regions around it"},
      Member{"length", &VoronoiSeam::length, "mesh units", "of its edges"},
      Member{"walls", &VoronoiSeam::walls, "", "that meet in it: places in the list of walls"},
      Member{"junctions", &VoronoiSeam::junctions, "", "at which it ends: places in the list of junctions"},
  };
};

/// A point in which seams meet, or one ends.
struct VoronoiJunction {
  std::uint32_t vertex = 0;          ///< of the complex
  Vec3d position;                    ///< of that vertex, mesh units: within VoronoiReport::hausdorff_bound of the point
  std::vector<std::int32_t> sites;   ///< of the regions around it, rising
  std::vector<std::uint32_t> seams;  ///< that begin or end there, rising
};

template <>
struct Description<VoronoiJunction> {
  static constexpr std::string_view name = "VoronoiJunction";
  static constexpr std::string_view doc = "A point in which seams meet, or one ends";
  static constexpr std::tuple members{
      Member{"vertex", &VoronoiJunction::vertex, "", "of the complex"},
      Member{"position", &VoronoiJunction::position, "mesh units", "of that vertex: near the point, in a cube at it"},
      Member{"sites", &VoronoiJunction::sites, "", "of the regions around it"},
      Member{"seams", &VoronoiJunction::seams, "", "that begin or end there: places in the list of seams"},
  };
};

/// A Voronoi diagram as parts that meet. Numbers of walls, seams and junctions are places in these lists.
struct VoronoiGraph {
  std::vector<VoronoiRegion> regions;      ///< of a complex with its surface, by rising site
  std::vector<VoronoiWall> walls;          ///< by their first triangle
  std::vector<VoronoiSeam> seams;          ///< by their first edge
  std::vector<VoronoiJunction> junctions;  ///< by rising vertex
};

template <>
struct Description<VoronoiGraph> {
  static constexpr std::string_view name = "VoronoiGraph";
  static constexpr std::string_view doc = "A Voronoi diagram as regions, walls, seams and junctions";
  static constexpr std::tuple members{
      Member{"regions", &VoronoiGraph::regions, "", "of a complex with its surface; none without"},
      Member{"walls", &VoronoiGraph::walls, "", "connected parts of borders between two regions"},
      Member{"seams", &VoronoiGraph::seams, "", "lines in which regions of three or more sites meet"},
      Member{"junctions", &VoronoiGraph::junctions, "", "points in which seams meet or end"},
  };
};

/// The parts of what voronoi_complex() makes, as its triangles tell: a wall is made of triangles between the same two
/// sites that share edges, a seam of edges whose triangles name three or more sites, cut at vertices at which not just
/// two of these meet. Parts narrower than a cube may be missing, and junctions closer to each other than that are one.
///
/// @param complex  with the columns `site_a` and `site_b`.
/// @throws InvalidOption where these are missing; InvalidMesh saying problem_of(complex); Cancelled.
/// Cost: O(n log n) in the triangles, about 1 us and 100 bytes each.
[[nodiscard]] VoronoiGraph voronoi_graph(const Complex& complex, const Context& context = {});

}  // namespace blum
