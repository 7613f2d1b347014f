// Proves that patches of sites are those of a slow search. Columns and graphs name these patches. Graphs of prisms over
// fine polygons are those of the smooth solids. Wrong arguments are refused.
#include "blum/voronoi/voronoi_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "blum/axis/axis_graph.hpp"
#include "blum/axis/collapse_axis.hpp"
#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_graph.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using Sizes = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>;

Sizes sizes_of(const VoronoiGraph& graph) {
  return {graph.patches.size(), graph.walls.size(), graph.seams.size(), graph.junctions.size()};
}

/// Returns a prism over a regular polygon with radius 1.
TriangleMesh prism(std::size_t sides, double height) {
  TriangleMesh out;
  for (const double z : {0.0, height}) {
    for (std::size_t k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(k) + 0.25) / static_cast<double>(sides);
      out.vertices.push_back({std::cos(angle), std::sin(angle), z});
    }
  }
  const auto count = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t next = (k + 1) % count;
    out.triangles.push_back({k, next, next + count});
    out.triangles.push_back({k, next + count, k + count});
  }
  for (std::uint32_t k = 1; k + 1 < count; ++k) {
    out.triangles.push_back({0, k + 1, k});
    out.triangles.push_back({count, count + k, count + k + 1});
  }
  return out;
}

VoronoiGraph graph_of(const TriangleMesh& mesh, double patch_angle, VoronoiPart part) {
  const VoronoiComplex found = voronoi_complex(mesh, {.part = part});
  EXPECT_TRUE(found.report.exact);
  const std::vector<VoronoiSite> sites = voronoi_sites(mesh, found.report);
  return voronoi_graph(found.complex, voronoi_patches(mesh, sites, {patch_angle}));
}

/// The region of the side of a high cylinder meets each cap's region in a cone. In a flat cylinder, a disc between the
/// caps ends in a seam, which is a closed line.
TEST(VoronoiPatches, PrismsOverFinePolygonsAreCylinders) {
  for (const std::size_t sides : {16U, 33U, 128U, 256U}) {
    const double bend = 360 / static_cast<double>(sides);
    for (const TriangleMesh& high : {prism(sides, 3), test::turned(prism(sides, 3))}) {
      EXPECT_EQ(sizes_of(graph_of(high, bend, VoronoiPart::walls)), Sizes(3, 2, 0, 0)) << sides;
      const std::size_t own = std::get<0>(sizes_of(graph_of(high, 0.99 * bend, VoronoiPart::walls)));
      EXPECT_EQ(own, sides + 2) << "a smaller angle joins no sides";
    }
    for (const TriangleMesh& flat : {prism(sides, 0.5), test::turned(prism(sides, 0.5))}) {
      const VoronoiGraph graph = graph_of(flat, 30, VoronoiPart::all);
      ASSERT_EQ(sizes_of(graph), Sizes(3, 3, 1, 0)) << sides;
      EXPECT_EQ(graph.seams[0].sites, (std::vector<std::int32_t>{0, 1, 2}));
      EXPECT_EQ(graph.seams[0].walls, (std::vector<std::uint32_t>{0, 1, 2}));
      const double inner =
          std::cos(std::numbers::pi / static_cast<double>(sides)) - 0.25;  // radius of the seam's polygon
      const double perimeter =
          2 * static_cast<double>(sides) * inner * std::tan(std::numbers::pi / static_cast<double>(sides));
      EXPECT_NEAR(graph.seams[0].length, perimeter, 1e-9);
      const double base =
          0.5 * static_cast<double>(sides) * std::sin(2 * std::numbers::pi / static_cast<double>(sides));
      ASSERT_EQ(graph.regions.size(), 3U);
      double volume = 0;
      for (const VoronoiRegion& region : graph.regions) volume += region.volume;
      EXPECT_NEAR(volume, 0.5 * base, 1e-9);
      EXPECT_NEAR(graph.regions[1].volume, graph.regions[2].volume, 1e-9) << "the caps are equal";
      EXPECT_NEAR(graph.regions[1].surface_area, base, 1e-9);
      EXPECT_EQ(graph.regions[0].neighbours.size(), 2U);
    }
  }
}

/// Returns the patches of faces by a slow search: bends of all pairs of triangles with two common vertices decide.
std::set<std::set<std::int32_t>> slow_patches(const TriangleMesh& mesh, const std::vector<VoronoiSite>& sites,
                                              double angle) {
  std::vector<std::int32_t> patch(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) patch[s] = static_cast<std::int32_t>(s);
  const auto normal_of = [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3d n = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    return n / length(n);
  };
  const auto is_smooth = [&](std::uint32_t s, std::uint32_t t) {
    std::size_t common = 0;
    for (const std::uint32_t v : mesh.triangles[s]) {
      common += static_cast<std::size_t>(std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), v));
    }
    const double bend = std::acos(std::clamp(dot(normal_of(s), normal_of(t)), -1.0, 1.0)) * 180 / std::numbers::pi;
    return common == 2 && bend <= angle;
  };
  const auto join = [&](std::size_t a, std::size_t b) {
    const std::int32_t from = patch[b], to = patch[a];
    std::replace(patch.begin(), patch.end(), from, to);
  };
  for (std::size_t a = 0; a < sites.size(); ++a) {
    for (std::size_t b = a + 1; b < sites.size(); ++b) {
      for (const std::uint32_t s : sites[a].triangles) {
        for (const std::uint32_t t : sites[b].triangles) {
          if (is_smooth(s, t)) join(a, b);
        }
      }
    }
  }
  std::map<std::int32_t, std::set<std::int32_t>> found;
  for (std::size_t s = 0; s < sites.size(); ++s) {
    if (sites[s].kind == SiteKind::face) found[patch[s]].insert(static_cast<std::int32_t>(s));
  }
  std::set<std::set<std::int32_t>> out;
  for (const auto& [number, all] : found) out.insert(all);
  return out;
}

/// Random angles differ from all bends of these solids. Reflex edges inside a patch belong to it, all others do not.
TEST(VoronoiPatches, AreThoseOfASlowSearch) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angles(0.5, 100);
  for (const TriangleMesh& mesh : {make_star(), make_bracket(), make_wedge(), test::turned(make_gear()), prism(7, 1)}) {
    const std::vector<VoronoiSite> sites = voronoi_sites(mesh);
    for (int k = 0; k < 4; ++k) {
      const double angle = angles(random);
      std::set<std::set<std::int32_t>> found;
      std::vector<int> patches_of(sites.size(), 0);
      bool is_ordered = true;
      std::int32_t previous = -1;
      for (const VoronoiPatch& patch : voronoi_patches(mesh, sites, {angle})) {
        std::set<std::int32_t> faces;
        for (const std::int32_t site : patch.sites) {
          ++patches_of[static_cast<std::size_t>(site)];
          if (sites[static_cast<std::size_t>(site)].kind == SiteKind::face) faces.insert(site);
        }
        EXPECT_TRUE(std::is_sorted(patch.sites.begin(), patch.sites.end()));
        is_ordered = is_ordered && patch.sites.front() > previous;
        previous = patch.sites.front();
        EXPECT_EQ(patch.kind == SiteKind::face, !faces.empty());
        if (!faces.empty()) found.insert(faces);
      }
      EXPECT_TRUE(is_ordered);
      EXPECT_EQ(found, slow_patches(mesh, sites, angle)) << angle;
      EXPECT_EQ(std::count(patches_of.begin(), patches_of.end(), 1), static_cast<std::ptrdiff_t>(sites.size()));
    }
  }
}

/// Without joined sites, the graph of patches is that of the sites, and names of sites become names of patches.
TEST(VoronoiPatches, OfOneSiteEachGiveTheGraphOfSites) {
  const auto cubes = VoronoiMethod::cubes;
  const auto traced = VoronoiMethod::traced;
  for (const auto& [mesh, method] : std::vector<std::pair<TriangleMesh, VoronoiMethod>>{
           {make_star(), cubes}, {make_bracket(), traced}, {make_box(), traced}}) {
    const VoronoiComplex found = voronoi_complex(mesh, {.method = method});
    const std::vector<VoronoiSite> sites = voronoi_sites(mesh, found.report);
    std::vector<VoronoiPatch> patches;
    for (std::size_t s = 0; s < sites.size(); ++s) patches.push_back({sites[s].kind, {static_cast<std::int32_t>(s)}});
    const VoronoiGraph own = voronoi_graph(found.complex);
    const VoronoiGraph same = voronoi_graph(found.complex, patches);
    ASSERT_EQ(same.walls.size(), own.walls.size());
    ASSERT_EQ(same.seams.size(), own.seams.size());
    ASSERT_EQ(same.junctions.size(), own.junctions.size());
    for (std::size_t w = 0; w < own.walls.size(); ++w) {
      EXPECT_EQ(same.walls[w].site_a, own.walls[w].site_a);
      EXPECT_EQ(same.walls[w].site_b, own.walls[w].site_b);
      EXPECT_EQ(same.walls[w].seams, own.walls[w].seams);
    }
    for (std::size_t j = 0; j < own.junctions.size(); ++j) EXPECT_EQ(same.junctions[j].vertex, own.junctions[j].vertex);
    ASSERT_EQ(same.regions.size(), own.regions.size());
    for (std::size_t r = 0; r < own.regions.size(); ++r) EXPECT_EQ(same.regions[r].volume, own.regions[r].volume);
  }
}

TEST(VoronoiPatches, ColumnsNameThePatchesOnBothSides) {
  const TriangleMesh mesh = make_bracket();
  VoronoiComplex found = voronoi_complex(mesh, {.method = VoronoiMethod::cubes});
  const std::vector<VoronoiSite> sites = voronoi_sites(mesh, found.report);
  const std::vector<VoronoiPatch> patches = voronoi_patches(mesh, sites);
  ASSERT_LT(patches.size(), sites.size());
  for (int repeat = 0; repeat < 2; ++repeat) add_patch_columns(found.complex, patches);
  const Columns& columns = found.complex.triangle_columns;
  const auto has = [&](std::int32_t patch, std::int32_t site) {
    if (patch < 0) return site < 0;
    const std::vector<std::int32_t>& all = patches[static_cast<std::size_t>(patch)].sites;
    return std::binary_search(all.begin(), all.end(), site);
  };
  for (std::size_t t = 0; t < found.complex.triangles.size(); ++t) {
    const std::int32_t a = columns.get<std::int32_t>("patch_a")[t], b = columns.get<std::int32_t>("patch_b")[t];
    const std::int32_t s = columns.get<std::int32_t>("site_a")[t], r = columns.get<std::int32_t>("site_b")[t];
    ASSERT_LE(a, b);
    ASSERT_TRUE((has(a, s) && has(b, r)) || (has(a, r) && has(b, s)));
  }
}

/// The medial axis of a flat cylinder has three sheets, and a closed seam. Names of vertices are those of the axis.
TEST(VoronoiPatches, AxesHaveSheetsOfPatches) {
  const TriangleMesh mesh = prism(48, 0.5);
  VoronoiComplex found = voronoi_complex(mesh, {.part = VoronoiPart::medial_axis});
  const std::vector<VoronoiPatch> patches = voronoi_patches(mesh, voronoi_sites(mesh, found.report));
  add_patch_columns(found.complex, patches);
  const Complex axis = collapse_axis(found.complex, 1);
  AxisGraphOptions options;
  options.of_patches = true;
  const AxisGraph graph = axis_graph(axis, mesh, options);
  EXPECT_EQ(graph.patches.size(), patches.size());
  ASSERT_EQ(graph.sheets.size(), 3U);
  ASSERT_EQ(graph.seams.size(), 1U);
  EXPECT_TRUE(graph.curves.empty());
  EXPECT_TRUE(graph.junctions.empty());
  EXPECT_TRUE(graph.seams[0].closed);
  for (std::size_t k = 0; k < graph.seams[0].vertices.size(); ++k) {
    EXPECT_EQ(axis.positions[graph.seams[0].vertices[k]], graph.seams[0].points[k]);
  }
  const auto sheets = axis.triangle_columns.get<std::int32_t>("patch_sheet");
  const auto patch_a = axis.triangle_columns.get<std::int32_t>("patch_a");
  const auto patch_b = axis.triangle_columns.get<std::int32_t>("patch_b");
  std::set<std::array<std::uint32_t, 2>> sides;
  for (const AxisSheet& sheet : graph.sheets) {
    ASSERT_TRUE(sheet.sides);
    sides.insert(*sheet.sides);
    ASSERT_FALSE(sheet.patch_pairs.empty());
    EXPECT_EQ(
        static_cast<std::size_t>(std::count(sheets.begin(), sheets.end(), static_cast<std::int32_t>(sheet.sheet))),
        sheet.triangles);
    for (std::size_t t = 0; t < sheets.size(); ++t) {
      if (sheets[t] != static_cast<std::int32_t>(sheet.sheet)) continue;
      EXPECT_EQ(static_cast<std::uint32_t>(patch_a[t]), (*sheet.sides)[0]);
      EXPECT_EQ(static_cast<std::uint32_t>(patch_b[t]), (*sheet.sides)[1]);
    }
  }
  EXPECT_EQ(sides, (std::set<std::array<std::uint32_t, 2>>{{0, 1}, {0, 2}, {1, 2}}));
  for (std::size_t t = 0; t < sheets.size(); ++t) EXPECT_EQ(sheets[t] < 0, patch_a[t] == patch_b[t]);
  EXPECT_GT(axis_graph(axis, mesh).sheets.size(), 48U) << "the graph of sites keeps all sheets";
  EXPECT_FALSE(axis_graph(axis, mesh).sheets[0].sides);
  const Complex without = collapse_axis(voronoi_complex(mesh, {.part = VoronoiPart::medial_axis}).complex, 1);
  EXPECT_THROW((void)axis_graph(without, mesh, options), InvalidOption);
}

template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InvalidOption& error) {
    return error.what();
  }
  return "";
}

TEST(VoronoiPatches, WrongArgumentsAreRefused) {
  const TriangleMesh mesh = make_box();
  const std::vector<VoronoiSite> sites = voronoi_sites(mesh);
  const auto with = [&](const auto& change) {
    std::vector<VoronoiSite> changed = sites;
    change(changed);
    return refusal([&] { (void)voronoi_patches(mesh, changed); });
  };
  EXPECT_NE(refusal([&] { (void)voronoi_patches(mesh, sites, {181}); }).find("patch_angle"), std::string::npos);
  EXPECT_NE(with([](auto& all) { all[1].triangles = all[0].triangles; }).find("two faces"), std::string::npos);
  EXPECT_NE(with([](auto& all) { all[1].triangles.clear(); }).find("no face"), std::string::npos);
  EXPECT_NE(with([](auto& all) { all[1].triangles[0] = 99; }).find("triangle 99"), std::string::npos);
  EXPECT_NE(with([](auto& all) { all.push_back({SiteKind::vertex, {}, {99}}); }).find("vertex 99"), std::string::npos);
  EXPECT_NE(with([](auto& all) { all.push_back({SiteKind::edge, {}, {0}}); }).find("number of vertices"),
            std::string::npos);
  EXPECT_NE(with([](auto& all) { all.push_back({SiteKind::edge, {}, {0, 0}}); }).find("does not exist"),
            std::string::npos);

  Complex complex = voronoi_complex(mesh).complex;
  const std::vector<VoronoiPatch> patches = voronoi_patches(mesh, sites);
  ASSERT_EQ(patches.size(), 6U);
  const std::vector<VoronoiPatch> few(patches.begin(), patches.begin() + 3);
  EXPECT_NE(refusal([&] { (void)voronoi_graph(complex, few); }).find("no patch has site"), std::string::npos);
  EXPECT_NE(refusal([&] { add_patch_columns(complex, few); }).find("no patch has site"), std::string::npos);
  const std::vector<VoronoiPatch> twice{{SiteKind::face, {0, 1}}, {SiteKind::face, {1}}};
  EXPECT_NE(refusal([&] { (void)voronoi_graph(complex, twice); }).find("two patches"), std::string::npos);
  EXPECT_NE(
      refusal([&] { (void)voronoi_graph(complex, std::vector<VoronoiPatch>{{SiteKind::face, {-1}}}); }).find("-1"),
      std::string::npos);
}

}  // namespace
}  // namespace blum
