// Proves that graphs of Voronoi diagrams of boxes and prisms are the known ones. In all graphs, walls, seams and
// junctions list each other, and walls are the borders of regions.
#include "blum/voronoi/voronoi_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// A box of sides 1, 2, 3 has a wall at each edge and one between the largest sides. At each corner three walls meet in
/// a seam, and four more seams bound the wall in the middle.
TEST(VoronoiGraph, OfABox) {
  const TriangleMesh mesh = test::box_between({-0.5, -1, -1.5}, {0.5, 1, 1.5});
  const VoronoiComplex found = voronoi_complex(mesh);
  const VoronoiGraph graph = voronoi_graph(found.complex);
  EXPECT_EQ(graph.regions.size(), 6U);
  EXPECT_EQ(graph.walls.size(), 13U);
  EXPECT_EQ(graph.seams.size(), 12U);
  ASSERT_EQ(graph.junctions.size(), 12U);
  std::size_t corners = 0;
  for (const VoronoiJunction& junction : graph.junctions) {
    if (junction.seams.size() == 1) {
      ++corners;
      EXPECT_EQ(junction.sites.size(), 3U);
      continue;
    }
    EXPECT_EQ(junction.seams.size(), 4U);
    EXPECT_EQ(junction.sites.size(), 4U);
    const Vec3d exact{0, std::copysign(0.5, junction.position.y), std::copysign(1, junction.position.z)};
    EXPECT_LE(length(junction.position - exact), found.report.hausdorff_bound);
  }
  EXPECT_EQ(corners, 8U);
  const auto is_middle = [](const VoronoiWall& wall) { return wall.seams.size() == 4 && wall.area > 1.9; };
  EXPECT_EQ(std::count_if(graph.walls.begin(), graph.walls.end(), is_middle), 1);
}

void expect_consistent(const VoronoiGraph& graph, const std::vector<VoronoiRegion>& regions) {
  std::map<std::array<std::int32_t, 2>, double> areas;
  for (std::uint32_t w = 0; w < graph.walls.size(); ++w) {
    const VoronoiWall& wall = graph.walls[w];
    EXPECT_LT(wall.site_a, wall.site_b);
    areas[{wall.site_a, wall.site_b}] += wall.area;
    for (const std::uint32_t s : wall.seams) {
      EXPECT_TRUE(std::binary_search(graph.seams[s].walls.begin(), graph.seams[s].walls.end(), w));
    }
  }
  for (std::uint32_t s = 0; s < graph.seams.size(); ++s) {
    const VoronoiSeam& seam = graph.seams[s];
    EXPECT_GE(seam.sites.size(), 3U);
    EXPECT_GE(seam.walls.size(), 2U);
    EXPECT_GT(seam.length, 0);
    EXPECT_LE(seam.junctions.size(), 2U);
    for (const std::uint32_t w : seam.walls) {
      for (const std::int32_t site : {graph.walls[w].site_a, graph.walls[w].site_b}) {
        EXPECT_TRUE(std::binary_search(seam.sites.begin(), seam.sites.end(), site));
      }
    }
    for (const std::uint32_t j : seam.junctions) {
      EXPECT_TRUE(std::binary_search(graph.junctions[j].seams.begin(), graph.junctions[j].seams.end(), s));
    }
  }
  for (const VoronoiRegion& region : regions) {
    for (const VoronoiNeighbour& other : region.neighbours) {
      const auto at = areas.find({std::min(region.site, other.site), std::max(region.site, other.site)});
      ASSERT_NE(at, areas.end());
      EXPECT_NEAR(at->second, other.area, 1e-9 * (1 + other.area));
    }
  }
}

TEST(VoronoiGraph, PartsNameEachOther) {
  for (const TriangleMesh& mesh : {make_box(), make_star(), make_bracket(), test::turned(make_wedge())}) {
    const VoronoiComplex found = voronoi_complex(mesh);
    const VoronoiGraph graph = voronoi_graph(found.complex);
    expect_consistent(graph, voronoi_regions(found.complex));
    EXPECT_EQ(graph.regions.size(), voronoi_regions(found.complex).size());
  }
}

/// Walls alone have no regions, because regions need the surface.
TEST(VoronoiGraph, OfWallsAlone) {
  const VoronoiComplex walls = voronoi_complex(make_star(), {.part = VoronoiPart::walls});
  const VoronoiGraph graph = voronoi_graph(walls.complex);
  EXPECT_TRUE(graph.regions.empty());
  EXPECT_GT(graph.seams.size(), 10U);
  expect_consistent(graph, {});
}

TEST(VoronoiGraph, NeedsSites) {
  EXPECT_THROW((void)voronoi_graph(Complex{{{0, 0, 0}}, {}, {}, Columns(1), {}, {}}), InvalidOption);
}

}  // namespace
}  // namespace blum
