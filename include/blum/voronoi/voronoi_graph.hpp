// Blum: regions, walls, seams and junctions of a Voronoi diagram. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "blum/voronoi/voronoi_regions.hpp"

namespace blum {

/// Connected part of the border between two regions.
struct VoronoiWall {
  std::int32_t site_a = 0;           ///< Site of the region on one side: the smaller site.
  std::int32_t site_b = 0;           ///< Site of the region on the other side.
  double area = 0;                   ///< Square mesh units.
  std::vector<std::uint32_t> seams;  ///< Indices of the seams along the wall's border, ascending.
};

template <>
struct Description<VoronoiWall> {
  static constexpr std::string_view name = "VoronoiWall";
  static constexpr std::string_view doc = "Connected part of the border between two regions";
  static constexpr std::tuple members{
      Member{"site_a", &VoronoiWall::site_a, "", "site of the region on one side: the smaller site"},
      Member{"site_b", &VoronoiWall::site_b, "", "site of the region on the other side"},
      Member{"area", &VoronoiWall::area, "square mesh units", "area of the wall's triangles"},
      Member{"seams", &VoronoiWall::seams, "", "seams along the wall's border: indices into the list of seams"},
  };
};

/// Chain of edges along which regions of three or more sites meet.
struct VoronoiSeam {
  std::vector<std::int32_t> sites;   ///< Sites of the regions around the seam, ascending.
  double length = 0;                 ///< Mesh units.
  std::vector<std::uint32_t> walls;  ///< Indices of the walls that meet along the seam, ascending.
  /// Indices of the junctions at the ends of the seam, ascending. The list has two entries, one entry if both ends
  /// meet in one junction, and none if the seam is a closed line.
  std::vector<std::uint32_t> junctions;
};

template <>
struct Description<VoronoiSeam> {
  static constexpr std::string_view name = "VoronoiSeam";
  static constexpr std::string_view doc = "Chain of edges along which regions of three or more sites meet";
  static constexpr std::tuple members{
      Member{"sites", &VoronoiSeam::sites, "", "sites of the regions around it"},
      Member{"length", &VoronoiSeam::length, "mesh units", "length of the seam's edges"},
      Member{"walls", &VoronoiSeam::walls, "", "walls that meet along the seam: indices into the list of walls"},
      Member{"junctions", &VoronoiSeam::junctions, "",
             "junctions at the ends of the seam: indices into the list of junctions"},
  };
};

/// Point in which several seams meet, or in which one seam ends.
struct VoronoiJunction {
  std::uint32_t vertex = 0;  ///< Index of the junction's vertex in the complex.
  /// Position of the vertex, mesh units. The error of the position is at most VoronoiReport::hausdorff_bound. If the
  /// diagram is traced, the error is about VoronoiReport::joined.
  Vec3d position;
  std::vector<std::int32_t> sites;   ///< Sites of the regions around the junction, ascending.
  std::vector<std::uint32_t> seams;  ///< Indices of the seams that end at the junction, ascending.
};

template <>
struct Description<VoronoiJunction> {
  static constexpr std::string_view name = "VoronoiJunction";
  static constexpr std::string_view doc = "Point in which several seams meet, or in which one seam ends";
  static constexpr std::tuple members{
      Member{"vertex", &VoronoiJunction::vertex, "", "vertex of the complex"},
      Member{"position", &VoronoiJunction::position, "mesh units",
             "position of the vertex, with an error of at most hausdorff_bound, or about joined if traced"},
      Member{"sites", &VoronoiJunction::sites, "", "sites of the regions around it"},
      Member{"seams", &VoronoiJunction::seams, "",
             "seams that begin or end at the junction: indices into the list of seams"},
  };
};

/// Voronoi diagram as a graph of regions, walls, seams and junctions. Indices of walls, seams and junctions refer to
/// the lists of the graph. In a graph of patches, `patches` is not empty. The sites of regions, walls, seams and
/// junctions are then indices of patches in this list.
struct VoronoiGraph {
  std::vector<VoronoiRegion> regions;      ///< By ascending site. Empty if the complex does not contain the surface.
  std::vector<VoronoiWall> walls;          ///< In the order of their first triangles.
  std::vector<VoronoiSeam> seams;          ///< In the order of their first edges.
  std::vector<VoronoiJunction> junctions;  ///< By ascending vertex.
  std::vector<VoronoiPatch> patches;       ///< Patches of a graph of patches; otherwise empty.
};

template <>
struct Description<VoronoiGraph> {
  static constexpr std::string_view name = "VoronoiGraph";
  static constexpr std::string_view doc = "Voronoi diagram as regions, walls, seams and junctions";
  static constexpr std::tuple members{
      Member{"regions", &VoronoiGraph::regions, "", "regions, if the complex includes the surface; otherwise none"},
      Member{"walls", &VoronoiGraph::walls, "", "connected parts of borders between two regions"},
      Member{"seams", &VoronoiGraph::seams, "", "chains of edges along which regions of three or more sites meet"},
      Member{"junctions", &VoronoiGraph::junctions, "", "points in which seams meet or end"},
      Member{"patches", &VoronoiGraph::patches, "",
             "patches, if this is a graph of patches: the sites of all members above are then indices into this list"},
  };
};

/// Returns the regions, walls, seams and junctions of a result of voronoi_complex(). A wall consists of triangles
/// between the same two sites that are connected through vertices. A seam consists of edges whose triangles have three
/// or more sites. A seam ends at each of its vertices that does not belong to exactly two edges of seams. Regions,
/// walls and seams narrower than a cube may be missing. Junctions that are closer together than the side of a cube may
/// become one. If the complex is exact (VoronoiReport::exact), the column `junction` marks the junctions, and nothing
/// is missing.
///
/// @param complex  with the columns `site_a` and `site_b`.
/// @throws InvalidOption if a column is missing; InvalidMesh with the text of problem_of(complex); Cancelled.
/// Cost: O(n log n) for n triangles; about 1 us and 100 bytes per triangle.
[[nodiscard]] VoronoiGraph voronoi_graph(const Complex& complex, const Context& context = {});

/// Returns the graph of a diagram whose sites are patches: all sites of a patch are treated as one site. Walls between
/// two sites of one patch are left out, even where distant parts of the patch face each other. Adjacent walls between
/// different pairs of sites are joined if their pairs of patches are equal. A seam is left out if only two patches meet
/// along it. A junction is left out if one seam passes through it, and no further patch meets it. A closed seam may
/// remain without a junction.
/// @param patches  result of voronoi_patches() for the sites of the complex, or another division of these sites.
/// @throws InvalidOption also if a site of the complex belongs to no patch, or to two.
[[nodiscard]] VoronoiGraph voronoi_graph(const Complex& complex, std::span<const VoronoiPatch> patches,
                                         const Context& context = {});

}  // namespace blum
