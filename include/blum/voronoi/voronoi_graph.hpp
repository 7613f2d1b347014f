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

/// Connected part of the border between two regions.
struct VoronoiWall {
  std::int32_t site_a = 0;           ///< Site of the region on one side: the smaller one.
  std::int32_t site_b = 0;           ///< Site of the region on the other side.
  double area = 0;                   ///< Square mesh units.
  std::vector<std::uint32_t> seams;  ///< Seams along its border, ascending.
};

template <>
struct Description<VoronoiWall> {
  static constexpr std::string_view name = "VoronoiWall";
  static constexpr std::string_view doc = "Connected part of the border between two regions";
  static constexpr std::tuple members{
      Member{"site_a", &VoronoiWall::site_a, "", "site of the region on one side: the smaller site"},
      Member{"site_b", &VoronoiWall::site_b, "", "site of the region on the other side"},
      Member{"area", &VoronoiWall::area, "square mesh units", "area of its triangles"},
      Member{"seams", &VoronoiWall::seams, "", "seams along its border: places in the list of seams"},
  };
};

/// Line in which regions of three or more sites meet.
struct VoronoiSeam {
  std::vector<std::int32_t> sites;       ///< Sites of the regions around it, ascending.
  double length = 0;                     ///< Mesh units.
  std::vector<std::uint32_t> walls;      ///< Walls that meet in it, ascending.
  std::vector<std::uint32_t> junctions;  ///< Its ends, ascending: two; one if it returns to it; none for a closed line.
};

template <>
struct Description<VoronoiSeam> {
  static constexpr std::string_view name = "VoronoiSeam";
  static constexpr std::string_view doc = "Line in which regions of three or more sites meet";
  static constexpr std::tuple members{
      Member{"sites", &VoronoiSeam::sites, "", "sites of the regions around it"},
      Member{"length", &VoronoiSeam::length, "mesh units", "length of its edges"},
      Member{"walls", &VoronoiSeam::walls, "", "walls that meet in it: places in the list of walls"},
      Member{"junctions", &VoronoiSeam::junctions, "", "junctions at which it ends: places in the list of junctions"},
  };
};

/// Point in which seams meet, or one ends.
struct VoronoiJunction {
  std::uint32_t vertex = 0;          ///< Vertex of the complex.
  Vec3d position;                    ///< Position of the vertex, mesh units, off by at most
                                     ///< VoronoiReport::hausdorff_bound.
  std::vector<std::int32_t> sites;   ///< Sites of the regions around it, ascending.
  std::vector<std::uint32_t> seams;  ///< Seams that begin or end there, ascending.
};

template <>
struct Description<VoronoiJunction> {
  static constexpr std::string_view name = "VoronoiJunction";
  static constexpr std::string_view doc = "Point in which seams meet, or one ends";
  static constexpr std::tuple members{
      Member{"vertex", &VoronoiJunction::vertex, "", "vertex of the complex"},
      Member{"position", &VoronoiJunction::position, "mesh units",
             "position of that vertex: near the point, in a cube at it"},
      Member{"sites", &VoronoiJunction::sites, "", "sites of the regions around it"},
      Member{"seams", &VoronoiJunction::seams, "", "seams that begin or end there: places in the list of seams"},
  };
};

/// Voronoi diagram as a graph of parts that meet. Numbers of walls, seams and junctions are indices into these lists.
struct VoronoiGraph {
  std::vector<VoronoiRegion> regions;      ///< Regions of a complex with its surface, by ascending site.
  std::vector<VoronoiWall> walls;          ///< By their first triangle.
  std::vector<VoronoiSeam> seams;          ///< By their first edge.
  std::vector<VoronoiJunction> junctions;  ///< By ascending vertex.
};

template <>
struct Description<VoronoiGraph> {
  static constexpr std::string_view name = "VoronoiGraph";
  static constexpr std::string_view doc = "Voronoi diagram as regions, walls, seams and junctions";
  static constexpr std::tuple members{
      Member{"regions", &VoronoiGraph::regions, "", "regions of a complex with its surface; none without"},
      Member{"walls", &VoronoiGraph::walls, "", "connected parts of borders between two regions"},
      Member{"seams", &VoronoiGraph::seams, "", "lines in which regions of three or more sites meet"},
      Member{"junctions", &VoronoiGraph::junctions, "", "points in which seams meet or end"},
  };
};

/// Returns the parts of a result of voronoi_complex(). A wall consists of triangles between the same two sites that
/// share edges. A seam consists of edges whose triangles name three or more sites. It is cut at vertices at which not
/// exactly two such edges meet. Parts narrower than a cube may be missing, and junctions closer together than a cube
/// are one.
///
/// @param complex  with the columns `site_a` and `site_b`.
/// @throws InvalidOption if these are missing; InvalidMesh with the text of problem_of(complex); Cancelled.
/// Cost: O(n log n) in the triangles, about 1 us and 100 bytes each.
[[nodiscard]] VoronoiGraph voronoi_graph(const Complex& complex, const Context& context = {});

}  // namespace blum
