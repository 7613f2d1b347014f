// Proves that Voronoi complexes have known numbers and are certified on generated solids, also rotated ones. Their
// points lie on walls, and threads change nothing. Invalid input is rejected.
#include "blum/voronoi/voronoi_complex.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "support/labelled_solid.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::LabelledSolid;

TEST(VoronoiComplex, OfABox) {
  const VoronoiComplex found = voronoi_complex(make_box());
  EXPECT_TRUE(found.report.certified);
  EXPECT_EQ(found.report.faces, 6U);
  EXPECT_EQ(found.report.reflex_edges, 0U);
  EXPECT_EQ(found.report.found, (BettiNumbers{1, 0, 6})) << "six regions";
  EXPECT_TRUE(problem_of(found.complex).empty());
  const auto radius = found.complex.vertex_columns.get<double>("radius");
  EXPECT_NEAR(*std::max_element(radius.begin(), radius.end()), 0.5, 1e-9) << "the junction in the middle";
  EXPECT_EQ(*std::min_element(radius.begin(), radius.end()), 0) << "the surface";
}

TEST(VoronoiComplex, OfABoxWithAVoid) {
  const VoronoiComplex found = voronoi_complex(test::box_with_void());
  EXPECT_TRUE(found.report.certified);
  EXPECT_EQ(found.report.faces, 12U);
  EXPECT_EQ(found.report.reflex_edges, 12U);
  EXPECT_EQ(found.report.reflex_vertices, 8U);
  EXPECT_EQ(found.report.found, (BettiNumbers{1, 0, 33})) << "32 regions and the void";
}

struct Case {
  std::string name;
  TriangleMesh mesh;
};

void PrintTo(const Case& of, std::ostream* out) {
  *out << of.name;
}

std::vector<Case> cases() {
  std::vector<Case> out;
  const auto add = [&](const std::string& name, const TriangleMesh& mesh, int turns) {
    out.push_back({name, mesh});
    for (int turn = 1; turn <= turns; ++turn) {
      out.push_back({name + "_turned_" + std::to_string(turn), test::turned(out.back().mesh)});
    }
  };
  constexpr int turns = 4;
  add("box", make_box(), turns);
  add("box_with_void", test::box_with_void(), turns);
  add("wedge", make_wedge(), turns);
  add("star", make_star(), turns);
  for (const int sides : {3, 5, 12, 64}) {
    add("cylinder_of_" + std::to_string(sides), make_cylinder({.sides = sides}), sides > 12 ? 1 : turns);
  }
  add("menger", make_menger({.level = 1}), turns);
  add("bodies", make_bodies(), 1);
  add("plate", make_plate(), 1);
  add("bracket", make_bracket(), 2);
  add("gear", make_gear(), 1);
  add("void_cube", make_void_cube({.frequency = 1}), 1);
  add("torus", make_torus({.ring_segments = 12, .tube_segments = 8}), 2);
  add("sphere", make_sphere({.frequency = 3}), 1);
  return out;
}

class Shapes : public testing::TestWithParam<Case> {};

void expect_certified(const VoronoiReport& report) {
  EXPECT_TRUE(report.certified);
  EXPECT_EQ(report.found, report.expected);
  EXPECT_EQ(report.failing.size(), 0U);
  EXPECT_EQ(report.undecided_lines, 0U);
  EXPECT_EQ(report.contradictions, 0U);
}

TEST_P(Shapes, AreCertified) {
  for (const VoronoiMethod method : {VoronoiMethod::automatic, VoronoiMethod::cubes}) {
    expect_certified(voronoi_complex(GetParam().mesh, {.method = method, .resolution = 1}).report);
  }
}

/// Without the surface, faces have no regions, and their holes have no tunnels.
TEST_P(Shapes, HaveWalls) {
  const BettiNumbers solid = *topology(GetParam().mesh).betti;
  for (const VoronoiMethod method : {VoronoiMethod::automatic, VoronoiMethod::cubes}) {
    const VoronoiReport report =
        voronoi_complex(GetParam().mesh, {.part = VoronoiPart::walls, .method = method, .resolution = 1}).report;
    expect_certified(report);
    const std::size_t regions = report.reflex_edges + report.reflex_vertices - report.thin_vertices;
    EXPECT_EQ(report.found, (BettiNumbers{solid[0], solid[1], solid[2] + static_cast<std::int64_t>(regions)}));
  }
}

TEST_P(Shapes, HaveMedialAxesWithTheirTopology) {
  for (const VoronoiMethod method : {VoronoiMethod::automatic, VoronoiMethod::cubes}) {
    const VoronoiReport report =
        voronoi_complex(GetParam().mesh, {.part = VoronoiPart::medial_axis, .method = method, .resolution = 1}).report;
    expect_certified(report);
    EXPECT_EQ(report.found, *topology(GetParam().mesh).betti);
  }
}

INSTANTIATE_TEST_SUITE_P(Solids, Shapes, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

/// Moved corners bend faces by any amount, as rounding to 32 bits or a modeller's tolerance does. Some edges at reflex
/// vertices become convex. Parts of the closed medial axis then meet only in a vertex, and the complex keeps them
/// apart.
TEST(VoronoiComplex, OfFacesBentByAnyAmount) {
  for (const double by : {0.3, 0.03, 1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-11, 1e-13, 1e-15}) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
      TriangleMesh mesh = test::box_with_void();
      Random random(seed);
      for (Vec3d& p : mesh.vertices) p += (random.in_cube() - Vec3d{0.5, 0.5, 0.5}) * by;
      for (const VoronoiPart part : {VoronoiPart::all, VoronoiPart::walls, VoronoiPart::medial_axis}) {
        SCOPED_TRACE(std::to_string(by) + ", " + std::to_string(seed) + ", " + std::string(to_string(part)));
        expect_certified(voronoi_complex(mesh, {.part = part, .method = VoronoiMethod::cubes, .resolution = 1}).report);
      }
    }
  }
}

/// Returns a box of side 1 with n x n squares on each side. Vertices of the upper side are lowered so that slopes are
/// about `slope`. They form separate pits, around which all edges are reflex, or rough ground.
TriangleMesh dented_box(std::uint32_t n, double slope, bool is_rough, std::uint64_t seed) {
  TriangleMesh mesh;
  const auto add_side = [&](const Vec3d& origin, const Vec3d& along, const Vec3d& up) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t i = 0; i <= n; ++i)
        mesh.vertices.push_back(origin + along * (1.0 * i / n) + up * (1.0 * j / n));
    }
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t p = first + j * (n + 1) + i;
        mesh.triangles.push_back({p, p + 1, p + n + 2});
        mesh.triangles.push_back({p, p + n + 2, p + n + 1});
      }
    }
  };
  const Vec3d x{1, 0, 0};
  const Vec3d y{0, 1, 0};
  const Vec3d z{0, 0, 1};
  add_side({}, y, x);
  add_side(z, x, y);
  add_side({}, x, z);
  add_side(y, z, x);
  add_side({}, z, y);
  add_side(x, y, z);
  mesh = weld(mesh);
  Random random(seed);
  for (Vec3d& p : mesh.vertices) {
    const bool is_within = p.z == 1 && std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) < 0.49;
    const bool is_apart = std::lround(p.x * n) % 2 == 1 && std::lround(p.y * n) % 2 == 1;
    if (is_within && (is_rough ? random.uniform() < 0.6 : is_apart)) p.z -= slope / n * (0.7 - random.uniform() * 0.5);
  }
  return mesh;
}

/// Regions of vertices that are too narrow for the grid count as parts of walls.
TEST(VoronoiComplex, OfShallowDents) {
  for (const double slope : {3e-2, 3e-4, 1e-4, 1e-6, 1e-8, 1e-11, 1e-13}) {
    for (const bool is_rough : {false, true}) {
      const TriangleMesh mesh = dented_box(4, slope, is_rough, 2);
      for (const VoronoiPart part : {VoronoiPart::all, VoronoiPart::walls, VoronoiPart::medial_axis}) {
        SCOPED_TRACE(std::to_string(slope) + ", " + std::to_string(is_rough) + ", " + std::string(to_string(part)));
        const VoronoiReport report =
            voronoi_complex(mesh, {.part = part, .method = VoronoiMethod::cubes, .resolution = 8}).report;
        expect_certified(report);
        EXPECT_GT(report.reflex_vertices, 2U);
        EXPECT_EQ(report.thin_vertices == report.reflex_vertices, slope < 5e-4);
      }
    }
  }
}

/// On a fine grid, grid edges meet some of these regions. The medial axis must omit parts of them in squares and cubes.
/// Without that, a piece of one region stood alone.
TEST(VoronoiComplex, OfShallowDentsOnAFineGrid) {
  TriangleMesh mesh = dented_box(4, 3e-4, true, 8);
  for (Vec3d& p : mesh.vertices) p.z = p.z > 0.9 ? p.z - 0.5 : p.z * 0.5;
  const VoronoiOptions options{
      .part = VoronoiPart::medial_axis, .method = VoronoiMethod::cubes, .resolution = 48, .grids = 1};
  const VoronoiReport report = voronoi_complex(test::turned(mesh), options).report;
  expect_certified(report);
  EXPECT_EQ(report.thin_vertices, 7U);
}

/// The box's sides have many triangles, rotated and rounded to 32 bits, as in .stl files. Faces, edges and vertices
/// bent by 1e-7 meet in lines over the vertices. The border of each square suffices to resolve them.
TEST(VoronoiComplex, OfManyTrianglesInSinglePrecision) {
  const TriangleMesh mesh = test::in_single_precision(test::turned(dented_box(6, 0, false, 1)));
  for (const VoronoiPart part : {VoronoiPart::all, VoronoiPart::walls, VoronoiPart::medial_axis}) {
    const VoronoiReport report =
        voronoi_complex(mesh, {.part = part, .method = VoronoiMethod::cubes, .resolution = 1}).report;
    expect_certified(report);
    EXPECT_GT(report.faces, 200U);
    EXPECT_LT(report.cubes, 20000U);
    const VoronoiReport of_planes = voronoi_complex(mesh, {.part = part}).report;
    expect_certified(of_planes);
    EXPECT_EQ(of_planes.faces, 6U) << "the bends are those of rounding";
  }
}

/// A cube may pass before one of its squares is split for a neighbour. Here the cube failed after the split, and the
/// medial axis had two holes.
TEST(VoronoiComplex, RetestsCubesWhoseSquaresAreSplit) {
  const TriangleMesh mesh{{{-0.222702465, -1.480812526, 0.087165795},
                           {-1.446244102, 0.390766112, 0.075364739},
                           {1.143270779, -0.060162025, -0.969181359},
                           {1.446244102, -0.390766112, -0.075364739},
                           {-1.143270779, 0.060162025, 0.969181359},
                           {-0.284959487, 0.450322214, 0.07018292},
                           {0.363221234, -0.942334058, 0.087728284},
                           {0.363090195, -0.942411033, 0.087744236},
                           {0.362860048, -0.942443194, 0.087810352}},
                          {{0, 1, 2},
                           {0, 2, 3},
                           {2, 1, 4},
                           {2, 4, 5},
                           {1, 0, 4},
                           {0, 3, 6},
                           {3, 4, 6},
                           {0, 6, 7},
                           {6, 4, 7},
                           {0, 7, 8},
                           {7, 4, 8},
                           {8, 4, 0},
                           {4, 3, 5},
                           {3, 2, 5}},
                          {},
                          {}};
  for (const int resolution : {1, 8}) {
    expect_certified(
        voronoi_complex(mesh,
                        {.part = VoronoiPart::medial_axis, .method = VoronoiMethod::cubes, .resolution = resolution})
            .report);
  }
}

/// The first corner of each triangle lies on a grid edge and, up to rounding, on the wall. Its distance from the
/// surface equals its radius.
TEST(VoronoiComplex, CrossesGridLinesOnWalls) {
  const TriangleMesh mesh = make_bracket();
  const Complex complex = voronoi_complex(mesh).complex;
  const SiteTable table(mesh);
  const Bvh bvh(mesh, table);
  const double size = 6;
  const auto radius = complex.vertex_columns.get<double>("radius");
  double largest = 0;
  for (const auto& triangle : complex.triangles) {
    const auto nearest = bvh.nearest(complex.positions[triangle[0]]);
    ASSERT_TRUE(nearest);
    largest = std::max(largest, std::abs(nearest->distance - radius[triangle[0]]));
  }
  EXPECT_LE(largest, 1e-9 * size);
}

/// At a point within e of a wall, two distances differ by at most 2 e. Each point of a wall has a point of the complex
/// nearby.
TEST(VoronoiComplex, IsWithinTheReportedDistanceOfTheWalls) {
  for (const double tolerance : {0.5, 0.1, 0.05}) {
    const VoronoiComplex walls = voronoi_complex(
        make_box(),
        {.part = VoronoiPart::walls, .method = VoronoiMethod::cubes, .resolution = 1, .tolerance = tolerance});
    ASSERT_TRUE(walls.report.certified);
    EXPECT_LE(walls.report.hausdorff_bound, tolerance);
    EXPECT_GT(walls.report.hausdorff_bound, 0);
    const Complex& complex = walls.complex;
    for (const auto& [a, b, c] : complex.triangles) {
      const Vec3d middle = (complex.positions[a] + complex.positions[b] + complex.positions[c]) * (1.0 / 3);
      std::array<double, 6> distances{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        distances[2 * axis] = 0.5 - middle[axis];
        distances[2 * axis + 1] = 0.5 + middle[axis];
      }
      std::sort(distances.begin(), distances.end());
      ASSERT_LE(distances[1] - distances[0], 2 * walls.report.hausdorff_bound);
    }
    // The wall between the faces towards +x and +y.
    for (int k = 0; k <= 20; ++k) {
      const Vec3d on_wall{0.5 * k / 20, 0.5 * k / 20, 0.4 * k / 20};
      double nearest = 1;
      for (const Vec3d& p : complex.positions) nearest = std::min(nearest, length(p - on_wall));
      EXPECT_LE(nearest, walls.report.hausdorff_bound);
    }
  }
  EXPECT_THROW((void)voronoi_complex(make_box(), {.tolerance = 0.0}), InvalidOption);
  EXPECT_THROW((void)voronoi_complex(make_box(), {.method = VoronoiMethod::cubes, .tolerance = 1e-9}), InvalidOption);
  EXPECT_THROW((void)voronoi_complex(make_box(), {.tolerance = std::nan("")}), InvalidOption);
}

TEST(VoronoiRegions, OfABox) {
  const std::vector<VoronoiRegion> regions = voronoi_regions(voronoi_complex(make_box()).complex);
  ASSERT_EQ(regions.size(), 6U);
  for (std::int32_t k = 0; k < 6; ++k) {
    const VoronoiRegion& region = regions[static_cast<std::size_t>(k)];
    EXPECT_EQ(region.site, k);
    EXPECT_NEAR(region.volume, 1.0 / 6, 0.01) << "a pyramid";
    EXPECT_NEAR(region.surface_area, 1, 0.02);
    ASSERT_EQ(region.neighbours.size(), 4U) << "the opposite one touches it in a point";
    for (const VoronoiNeighbour& neighbour : region.neighbours) EXPECT_NEAR(neighbour.area, std::sqrt(0.125), 0.02);
  }
}

/// Each triangle bounds two regions, one on each side. The volumes of all regions add up to that of the solid.
TEST(VoronoiRegions, FillTheSolid) {
  for (const TriangleMesh& mesh : {make_bracket(), test::turned(make_bracket()), test::box_with_void(), make_star(),
                                   make_torus({.ring_segments = 12, .tube_segments = 8})}) {
    const VoronoiComplex found = voronoi_complex(mesh);
    const std::vector<VoronoiRegion> regions = voronoi_regions(found.complex);
    const VoronoiReport& report = found.report;
    EXPECT_EQ(regions.size(), report.faces + report.reflex_edges + report.reflex_vertices - report.thin_vertices);
    double volume = 0;
    double surface = 0;
    for (const VoronoiRegion& region : regions) {
      volume += region.volume;
      surface += region.surface_area;
    }
    const SiteTable table(mesh);
    const Orientation facts = orientation(mesh, table);
    EXPECT_NEAR(volume, facts.signed_volume, 0.01 * facts.signed_volume);
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      area += 0.5 * length(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
    }
    EXPECT_NEAR(surface, area, 0.05 * area);
    // Regions thinner than a cube have volumes near 0, of either sign. No region is inside out.
    const double least = -0.01 * facts.signed_volume;
    for (const VoronoiRegion& region : regions) EXPECT_GT(region.volume, least) << region.site;
  }
}

/// Returns how often the triangles of each site wind around a point: exits of a ray from its region minus entries. The
/// count is exact; nullopt if the ray meets an edge.
std::optional<std::map<std::int32_t, int>> turns_around(const Complex& complex, const Bvh& triangles, const Ray& ray) {
  const auto site_a = complex.triangle_columns.get<std::int32_t>("site_a");
  const auto site_b = complex.triangle_columns.get<std::int32_t>("site_b");
  std::map<std::int32_t, int> out;
  for (const RayCrossing& crossing : triangles.crossings(ray)) {
    if (crossing.on_border) return std::nullopt;
    // Corners run counterclockwise as seen from the region of site_b, which a ray along the normal enters.
    out[site_a[crossing.triangle.value]] += crossing.side;
    out[site_b[crossing.triangle.value]] -= crossing.side;
  }
  std::erase_if(out, [](const auto& of_site) { return of_site.first < 0 || of_site.second == 0; });
  return out;
}

double distance_from(const LabelledSolid& solid, const voronoi::Label& label, const Vec3d& q) {
  const auto vertex = [&](std::uint32_t v) { return solid.mesh.vertices[v]; };
  switch (label.kind) {
    case SiteKind::face:
      return length(closest_point_on_triangle(q, triangle_corners(solid.mesh, label.index)) - q);
    case SiteKind::edge: {
      const Segment& ends = solid.table.edges()[label.index];
      return length(closest_point_on_segment(q, vertex(ends[0]), vertex(ends[1])) - q);
    }
    default:
      return length(vertex(label.index) - q);
  }
}

/// The site that is closest to a point by brute force, and how much further the next one is.
struct Closest {
  std::size_t site = 0;
  double distance = 0;
  double lead = 0;
};

Closest closest_site(const LabelledSolid& solid, const Vec3d& q) {
  std::vector<double> distances(solid.labels.site_count(), std::numeric_limits<double>::infinity());
  for (const voronoi::Label& label : solid.labels.all()) {
    double& least = distances[solid.labels.site_of(label)];
    least = std::min(least, distance_from(solid, label, q));
  }
  const auto closest = std::min_element(distances.begin(), distances.end());
  const Closest out{static_cast<std::size_t>(closest - distances.begin()), *closest, 0};
  *closest = std::numeric_limits<double>::infinity();
  return {out.site, out.distance, *std::min_element(distances.begin(), distances.end()) - out.distance};
}

/// At about 100,000 random points, one site is closer than all others by more than the complex's error. By its oriented
/// triangles, the region of that site contains the point, and no other region does.
TEST(VoronoiRegions, HoldWhatIsClosest) {
  struct Tried {
    TriangleMesh mesh;
    std::size_t points = 0;
  };
  const std::vector<Tried> all{{make_box(), 40000},
                               {test::box_with_void(), 50000},
                               {make_void_cube({.frequency = 1}), 10000},
                               {test::turned(make_cylinder({.sides = 6})), 50},
                               {test::turned(make_wedge()), 50}};
  for (const auto& [mesh, wanted] : all) {
    const LabelledSolid solid(mesh);
    const VoronoiComplex found = voronoi_complex(mesh, {.method = VoronoiMethod::cubes, .resolution = 40});
    ASSERT_TRUE(found.report.certified);
    const double off = found.report.hausdorff_bound;
    const WindingNumber inside(mesh);
    const TriangleMesh triangles{found.complex.positions, found.complex.triangles, {}, {}};
    const SiteTable table(triangles);
    const Bvh bvh(triangles, table);
    const Box3 box = bounds(mesh);
    Random random(5);
    std::size_t tested = 0;
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < 40 * wanted + 40000 && tested < wanted; ++k) {
      const Vec3d part = random.in_cube();
      Vec3d q = box.lower;
      for (std::size_t axis = 0; axis < 3; ++axis) q[axis] += part[axis] * box.size()[axis];
      const Vec3d way = random.in_cube() - Vec3d{0.5, 0.5, 0.5};
      const Closest closest = closest_site(solid, q);
      if (closest.distance <= 2 * off || closest.lead <= 2 * off || !inside.is_inside(q)) continue;
      const auto turns = turns_around(found.complex, bvh, {q, way});
      if (!turns) continue;
      ++tested;
      const std::map<std::int32_t, int> expected{{static_cast<std::int32_t>(closest.site), 1}};
      if (*turns != expected) ++wrong;
    }
    EXPECT_EQ(tested, wanted);
    EXPECT_EQ(wrong, 0U);
  }
}

TEST(VoronoiRegions, RejectComplexesWithoutSites) {
  EXPECT_THROW((void)voronoi_regions(Complex{{{0, 0, 0}}, {}, {}, Columns(1), {}, {}}), InvalidOption);
}

TEST(VoronoiComplex, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = make_bracket();
  Context context;
  context.threads = 1;
  for (const VoronoiPart part : {VoronoiPart::all, VoronoiPart::walls, VoronoiPart::medial_axis}) {
    context.threads = 1;
    const VoronoiComplex one = voronoi_complex(mesh, {.part = part}, context);
    for (const int threads : {2, 7}) {
      context.threads = threads;
      const VoronoiComplex more = voronoi_complex(mesh, {.part = part}, context);
      EXPECT_EQ(one.complex.positions, more.complex.positions);
      EXPECT_EQ(one.complex.triangles, more.complex.triangles);
      EXPECT_EQ(one.complex.vertex_columns, more.complex.vertex_columns);
      EXPECT_EQ(one.complex.triangle_columns, more.complex.triangle_columns);
    }
  }
}

/// With few splits, some cubes do not pass. The report lists them.
TEST(VoronoiComplex, ReportsFailingCells) {
  const VoronoiReport report =
      voronoi_complex(make_gear(), {.method = VoronoiMethod::cubes, .resolution = 1, .depth = 3}).report;
  EXPECT_FALSE(report.certified);
  ASSERT_FALSE(report.failing.empty());
  for (const FailingVoronoiCell& cell : report.failing) {
    EXPECT_NE(cell.obstacle, VoronoiObstacle::none);
    EXPECT_LT(cell.low.x, cell.high.x);
  }
}

/// A finer grid has the same homology.
TEST(VoronoiComplex, OfAFinerGrid) {
  const VoronoiComplex coarse = voronoi_complex(make_star(), {.method = VoronoiMethod::cubes, .resolution = 1});
  const VoronoiComplex fine = voronoi_complex(make_star(), {.method = VoronoiMethod::cubes, .resolution = 16});
  EXPECT_TRUE(fine.report.certified);
  EXPECT_EQ(coarse.report.found, fine.report.found);
  EXPECT_GT(fine.report.cubes, 10 * coarse.report.cubes);
}

TEST(VoronoiComplex, RejectsNonSolidsAndInvalidOptions) {
  TriangleMesh open = make_box();
  open.triangles.pop_back();
  EXPECT_THROW((void)voronoi_complex(open), InvalidMesh);
  EXPECT_THROW((void)voronoi_complex(TriangleMesh{}), InvalidMesh);
  TriangleMesh crossing = make_box();
  append(crossing, test::moved(make_box(), 1, {0.5, 0.25, 0.125}));
  EXPECT_THROW((void)voronoi_complex(crossing), InvalidMesh);  // the triangles of the sites would be ambiguous
  crossing.triangles.pop_back();
  EXPECT_THROW((void)voronoi_complex(Solid::of(crossing)), InvalidMesh);
  EXPECT_THROW((void)voronoi_complex(make_box(), {.resolution = 0}), InvalidOption);
  EXPECT_THROW((void)voronoi_complex(make_box(), {.depth = 25}), InvalidOption);
  EXPECT_THROW((void)voronoi_complex(make_box(), {.grids = 0}), InvalidOption);
  EXPECT_THROW((void)voronoi_complex(make_box(), {.max_cubes = 1}), InvalidOption);
}

/// Triangles that face the wrong way are reversed, which changes no site.
TEST(VoronoiComplex, OfAMeshThatFacesInwards) {
  TriangleMesh inside_out = test::box_with_void();
  reverse_triangles(inside_out);
  std::swap(inside_out.triangles[3][0], inside_out.triangles[3][1]);
  const VoronoiComplex turned = voronoi_complex(inside_out);
  const VoronoiComplex given = voronoi_complex(test::box_with_void());
  EXPECT_TRUE(turned.report.certified);
  EXPECT_EQ(turned.report.found, given.report.found);
  EXPECT_EQ(turned.complex.triangle_columns, given.complex.triangle_columns);
}

/// If a mesh crosses itself, the diagram is that of the solid without the crossings.
TEST(VoronoiComplex, OfASolidWhoseMeshCrossesItself) {
  TriangleMesh crossing = make_box();
  append(crossing, test::moved(make_box(), 1, {0.5, 0.25, 0.125}));
  const Solid solid = Solid::of(crossing);
  ASSERT_TRUE(solid.resolved());
  const VoronoiComplex of_solid = voronoi_complex(solid);
  const VoronoiComplex of_surface = voronoi_complex(solid.surface().mesh);
  EXPECT_TRUE(of_solid.report.certified);
  EXPECT_EQ(of_solid.complex.positions, of_surface.complex.positions);
  EXPECT_EQ(of_solid.report.expected, of_surface.report.expected);
}

/// Bodies that share a point are one as a point set, but two by their triangles.
TEST(VoronoiComplex, RefusesBodiesThatTouch) {
  TriangleMesh touching = make_box();
  append(touching, test::moved(make_box(), 1, {1, 1, 1}));
  EXPECT_THROW((void)voronoi_complex(touching), InvalidMesh);
  TriangleMesh apart = make_box();
  append(apart, test::moved(make_box(), 1, {1.25, 1.25, 1.25}));
  EXPECT_TRUE(voronoi_complex(apart).report.certified);
}

TEST(VoronoiComplex, OfSolidsFarFromTheOrigin) {
  for (const double offset : {1e3, 1e5, 1e7}) {
    const VoronoiComplex far = voronoi_complex(test::moved(test::box_with_void(), 1, {offset, -offset, offset / 3}));
    EXPECT_TRUE(far.report.certified) << offset;
  }
  EXPECT_THROW((void)voronoi_complex(test::moved(make_box(), 1, {1e10, 0, 0})), InvalidMesh);
}

/// A face in a plane of the grid causes ties all over squares. Another position of the grid passes.
TEST(VoronoiComplex, OfAFaceInAPlaneOfTheGrid) {
  constexpr double plane = 0.5464101615137754;  // the first grid's middle for a box from 0 to 1
  const std::vector<Point2> outline{{0, 0}, {1, 0}, {1, plane}, {0.5, plane}, {0.5, 1}, {0, 1}};
  TriangleMesh mesh = make_extrusion(outline, {});
  for (Vec3d& v : mesh.vertices) v = Vec3d{v.z + 0.5, v.x, v.y};
  const VoronoiReport report = voronoi_complex(mesh).report;
  EXPECT_TRUE(report.certified);
  EXPECT_LE(report.undecided_lines, 0U);
}

TEST(VoronoiComplex, Stops) {
  std::stop_source stop;
  stop.request_stop();
  Context context;
  context.cancel = stop.get_token();
  EXPECT_THROW((void)voronoi_complex(make_box(), {}, context), Cancelled);
}

}  // namespace
}  // namespace blum
