// Proves that every generated shape has the topology that the catalog states and a volume near its analytic value.
// Invalid parameters are rejected.
#include "blum/shapes/generators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/shapes/shape_catalog.hpp"

namespace blum {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A shape of the catalog, with parameters to test besides the defaults.
struct Case {
  std::string name;
  ShapeParameters parameters;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const ShapeInfo& shape : shape_catalog()) all.push_back({shape.name, {}});
  const std::vector<Case> more = {
      {"sphere", {{"radius", 3}, {"frequency", 1}}},
      {"sphere", {{"frequency", 2}}},
      {"sphere", {{"frequency", 3}}},
      {"ellipsoid", {{"radius_x", 1e-3}, {"frequency", 7}}},
      {"uv_sphere", {{"longitudes", 3}, {"latitudes", 2}}},
      {"cylinder", {{"sides", 3}, {"stacks", 5}}},
      {"torus", {{"ring_segments", 3}, {"tube_segments", 3}}},
      {"torus", {{"tube_radius", 0.99}}},
      {"torus_knot", {{"p", 3}, {"q", 2}}},
      {"torus_knot", {{"p", 5}, {"q", 7}, {"tube_radius", 0.02}}},
      {"torus_knot", {{"p", 1}, {"q", 1}, {"curve_segments", 16}}},
      {"linked_tori", {{"count", 1}}},
      {"linked_tori", {{"count", 7}, {"tube_radius", 0.33}}},
      {"ridged_rod", {{"ridges", 0}}},
      {"ridged_rod", {{"ridges", 1}, {"segments_per_ridge", 4}, {"sides", 3}}},
      {"spoon", {{"stations", 16}, {"sides", 8}}},
      {"spoon", {{"thickness", 0.01}, {"bowl_depth", 1.2}}},
      {"organic", {{"frequency", 20}, {"seed", 7}}},
      {"organic", {{"frequency", 30}, {"detail", 0.05}}},
      {"organic", {{"frequency", 30}, {"holes", 5}}},
      {"box", {{"size_x", 5}, {"segments", 1}}},
      {"box", {{"segments", 2}}},
      {"box", {{"segments", 7}}},
      {"wedge", {{"angle", 1e-3}}},
      {"wedge", {{"angle", 179}}},
      {"star", {{"spikes", 2}, {"inner_radius", 0.01}}},
      {"star", {{"spikes", 100}}},
      {"plate", {{"holes_x", 0}}},
      {"plate", {{"holes_x", 1}, {"holes_y", 1}, {"hole_segments", 4}}},
      {"plate", {{"holes_x", 10}, {"holes_y", 10}, {"hole_radius", 0.49}}},
      {"bracket", {{"holes", 0}}},
      {"bracket", {{"holes", 0}, {"ribs", 0}}},
      {"bracket", {{"holes", 1}, {"ribs", 0}}},
      {"bracket", {{"holes", 5}, {"hole_radius", 0.1}, {"width", 7}}},
      {"gear", {{"openings", 0}, {"bore_radius", 0}}},
      {"gear", {{"openings", 0}}},
      {"gear", {{"openings", 1}, {"bore_radius", 0}}},
      {"gear", {{"teeth", 4}, {"openings", 3}}},
      {"gear", {{"teeth", 200}, {"openings", 12}, {"opening_radius", 0.1}, {"hole_segments", 64}}},
      {"void_cube", {{"segments", 1}, {"frequency", 1}, {"void_radius", 0.499}}},
      {"nested_shells", {{"shells", 1}}},
      {"nested_shells", {{"shells", 2}}},
      {"nested_shells", {{"shells", 20}, {"frequency", 2}}},
      {"bodies", {{"count", 1}}},
      {"bodies", {{"count", 1000}}},
      {"bodies", {{"count", 30}, {"frequency", 3}}},
      {"menger", {{"level", 0}}},
      {"menger", {{"level", 1}}},
      {"menger", {{"level", 3}}},
      {"fan_part", {{"resolution", 1}}},
      {"fan_part", {{"resolution", 4}, {"size", 100}}},
  };
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string describe(const Case& c) {
  std::string text = c.name;
  for (const auto& [name, value] : c.parameters) text += " " + name + "=" + std::to_string(value);
  return text;
}

TEST(Generators, HaveTheTopologyOfTheirCatalogEntry) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(describe(c));
    const ShapeInfo& shape = find_shape(c.name);
    const ShapeParameters parameters = complete_parameters(shape, c.parameters);
    const TriangleMesh mesh = make_shape(c.name, c.parameters);
    ASSERT_NO_THROW(validate(mesh));
    const Topology t = topology(mesh);
    EXPECT_EQ(t.betti, shape.betti(parameters));
    if (!shape.betti(parameters).has_value()) continue;
    EXPECT_EQ(t.named_vertices, t.vertices);
    EXPECT_TRUE(t.closed && t.oriented && t.manifold && t.faces_outwards);
    EXPECT_EQ(t.boundary_edges + t.nonmanifold_edges + t.nonmanifold_vertices + t.inconsistent_edges, 0U);
    EXPECT_EQ(t.degenerate_triangles, 0U);
    EXPECT_EQ(t.duplicate_triangles, 0U);
    EXPECT_GT(t.signed_volume, 0);
    const Orientation o = orientation(mesh, SiteTable(mesh));
    EXPECT_TRUE(o.closed && o.oriented && o.outward);
    EXPECT_EQ(o.components, t.shells.size());
    EXPECT_DOUBLE_EQ(o.signed_volume, t.signed_volume);
  }
}

TEST(Generators, NoTwoVerticesCoincide) {
  for (const Case& c : cases()) {
    if (!find_shape(c.name).betti(complete_parameters(find_shape(c.name), c.parameters))) continue;
    const TriangleMesh mesh = make_shape(c.name, c.parameters);
    std::set<std::array<double, 3>> places;
    for (const Vec3d& p : mesh.vertices) places.insert({p.x, p.y, p.z});
    EXPECT_EQ(places.size(), mesh.vertices.size()) << describe(c);
  }
}

double volume(const TriangleMesh& mesh) {
  return topology(mesh).signed_volume;
}

TEST(Generators, HaveTheirAnalyticVolume) {
  const double torus = 2 * pi * pi * 0.3 * 0.3;
  EXPECT_NEAR(volume(make_sphere({2, 40})), 4.0 / 3 * pi * 8, 0.002 * 4.0 / 3 * pi * 8);
  EXPECT_NEAR(volume(make_uv_sphere({1, 200, 100})), 4.0 / 3 * pi, 0.002);
  EXPECT_NEAR(volume(make_ellipsoid({{1, 2, 3}, 40})), 4.0 / 3 * pi * 6, 0.05);
  EXPECT_NEAR(volume(make_cylinder({0.5, 3, 400, 2})), pi * 0.25 * 3, 0.001);
  EXPECT_NEAR(volume(make_torus({1, 0.3, 400, 200})), torus, 0.002);
  EXPECT_NEAR(volume(make_linked_tori({3, 1, 0.3, 400, 200})), 3 * torus, 0.006);
  EXPECT_NEAR(volume(make_box({{1, 2, 3}, {3, 1, 4}})), 6, 1e-12);
  EXPECT_NEAR(volume(make_wedge({30, 2, 3})), 0.5 * 4 * std::sin(pi / 6) * 3, 1e-12);
  EXPECT_NEAR(volume(make_void_cube({2, 0.5, 3, 40})), 8 - 4.0 / 3 * pi * 0.125, 0.001);
  EXPECT_NEAR(volume(make_bodies({100, 0.5, 0.6, 0})), 100 * 0.125, 1e-9);
  EXPECT_NEAR(volume(make_plate({3, 2, 1, 0.3, 0.25, 400})), (6 - 6 * pi * 0.09) * 0.25, 1e-3);
  EXPECT_NEAR(volume(make_menger({3, 2})), 8 * std::pow(20.0 / 27, 3), 1e-9);
  // Pappus: a rod whose squared radius has the mean r^2 + h^2 / 2.
  EXPECT_NEAR(volume(make_ridged_rod({4, 0.5, 0.1, 10, 200, 40})), pi * (0.25 + 0.005) * 4, 0.005);
  // A tube around a curve has the volume of its circle times the curve's length.
  const TorusKnotOptions knot{2, 3, 1, 0.4, 0.1, 2000, 100};
  double curve_length = 0;
  for (int s = 0; s < 100000; ++s) {
    const double wind = 2 * pi * 3 * s / 100000;
    curve_length += 2 * pi * std::hypot(2 * (1 + 0.4 * std::cos(wind)), 3 * 0.4) / 100000;
  }
  EXPECT_NEAR(volume(make_torus_knot(knot)), pi * 0.01 * curve_length, 0.002);
  // Foot, wall and three ribs, less four holes.
  const double bracket = 3 * 3 * 0.4 + 2.6 * 3 * 0.4 + 3 * 0.24 * 0.5 * 1.04 * 1.04 - 4 * pi * 0.09 * 0.4;
  EXPECT_NEAR(volume(make_bracket({3, 3, 3, 0.4, 2, 0.3, true, 400})), bracket, 1e-3);
}

TEST(Generators, SizesAreAsStated) {
  const auto size = [](const TriangleMesh& mesh) { return bounds(mesh).size(); };
  EXPECT_NEAR(size(make_spoon({})).x, 6, 1e-12);
  EXPECT_NEAR(size(make_spoon({})).y, 1.4, 0.01);
  EXPECT_EQ(size(make_bracket({})), (Vec3d{3, 3, 3}));
  EXPECT_NEAR(size(make_gear({})).x, 2, 0.02);
  EXPECT_NEAR(size(make_gear({})).z, 0.3, 1e-12);
  EXPECT_EQ(make_organic({}).triangles.size(), 69620U);
  EXPECT_EQ(make_fan_part({}).triangles.size(), 12288U);
  EXPECT_GT(size(make_fan_part({})).x, 0.7);
  EXPECT_LT(bounds(make_fan_part({})).diagonal(), 2);
}

TEST(Generators, HolesOfTheOrganicShapeAreItsBoundaryLoops) {
  for (const int holes : {1, 5, 12}) {
    const Topology t = topology(make_organic({1, 59, 0.006, holes, 1}));
    EXPECT_EQ(t.boundary_loops, static_cast<std::size_t>(holes));
    EXPECT_TRUE(t.manifold && t.oriented && !t.closed);
    EXPECT_EQ(t.components, 1U);
    EXPECT_EQ(t.euler_characteristic, 2 - holes);
  }
}

TEST(Generators, ExtrusionTakesHolesAndEitherDirection) {
  const std::vector<Point2> outline = {{0, 0}, {0, 4}, {4, 4}, {4, 0}};  // clockwise
  const std::vector<std::vector<Point2>> holes = {{{1, 1}, {2, 1}, {2, 2}, {1, 2}}, {{3, 3}, {2.5, 3}, {3, 2.5}}};
  const Topology t = topology(make_extrusion(outline, holes, {2, 3}));
  EXPECT_EQ(t.betti, (std::array<std::int64_t, 3>{1, 2, 0}));
  EXPECT_NEAR(t.signed_volume, 2 * (16 - 1 - 0.125), 1e-12);
}

TEST(Generators, ExtrusionOfHardPolygonsKeepsAreaAndTopology) {
  // A grid of square holes whose corners are collinear with each other, and a comb with collinear tips.
  std::vector<std::vector<Point2>> holes;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double x = 2.0 * i + 1;
      const double y = 2.0 * j + 1;
      holes.push_back({{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}});
    }
  }
  const Topology grid = topology(make_extrusion(std::vector<Point2>{{0, 0}, {13, 0}, {13, 13}, {0, 13}}, holes, {}));
  EXPECT_EQ(grid.betti, (std::array<std::int64_t, 3>{1, 36, 0}));
  EXPECT_NEAR(grid.signed_volume, 169 - 36, 1e-10);
  std::vector<Point2> comb = {{20, 0}, {20, 1}};
  for (int tooth = 9; tooth >= 0; --tooth) {
    comb.insert(comb.end(), {{2.0 * tooth + 1, 1}, {2.0 * tooth + 1, 5}, {2.0 * tooth, 5}, {2.0 * tooth, 1}});
  }
  comb.push_back({0, 0});
  const Topology teeth = topology(make_extrusion(comb, {}, {}));
  EXPECT_EQ(teeth.betti, (std::array<std::int64_t, 3>{1, 0, 0}));
  EXPECT_NEAR(teeth.signed_volume, 20 + 40, 1e-10);
}

TEST(Generators, ExtrusionOfRandomStarPolygonsKeepsArea) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::vector<Point2> outline;
    std::uint64_t state = seed;
    const auto next = [&] {
      return static_cast<double>((state = state * 6364136223846793005u + 1442695040888963407u) >> 40) * 0x1p-24;
    };
    double area = 0;
    for (int k = 0; k < 60; ++k) {
      const double radius = 0.4 + next();
      outline.push_back({radius * std::cos(2 * pi * k / 60), radius * std::sin(2 * pi * k / 60)});
    }
    for (std::size_t k = 0; k < 60; ++k) {
      const Point2& a = outline[k];
      const Point2& b = outline[(k + 1) % 60];
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    const std::vector<std::vector<Point2>> holes = {{{0.1, 0}, {0, 0.1}, {-0.1, 0}, {0, -0.1}}};
    const Topology t = topology(make_extrusion(outline, holes, {}));
    EXPECT_EQ(t.betti, (std::array<std::int64_t, 3>{1, 1, 0})) << seed;
    EXPECT_NEAR(t.signed_volume, area - 0.02, 1e-9) << seed;
  }
}

TEST(Generators, ExtrusionCanBeCancelled) {
  const std::vector<Point2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(static_cast<void>(make_extrusion(square, {}, {}, {.cancel = stop.get_token()})), Cancelled);
}

TEST(Generators, CrossingOutlineIsRefused) {
  const std::vector<Point2> bow_tie = {{0, 0}, {2, 2}, {2, 0}, {0, 1}};
  EXPECT_THROW(static_cast<void>(make_extrusion(bow_tie, {}, {})), InvalidOption);
  const std::vector<Point2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<std::vector<Point2>> touching = {{{0.5, 0.5}, {0.7, 0.5}, {1, 0.7}}};
  EXPECT_THROW(static_cast<void>(make_extrusion(square, touching, {})), InvalidOption);
  const std::vector<std::vector<Point2>> in_hole = {{{0.1, 0.1}, {0.9, 0.1}, {0.5, 0.9}},
                                                    {{0.4, 0.2}, {0.6, 0.2}, {0.5, 0.3}}};
  EXPECT_THROW(static_cast<void>(make_extrusion(square, in_hole, {})), InvalidOption);
  const std::vector<std::vector<Point2>> outside = {{{5, 5}, {6, 5}, {6, 6}}};
  EXPECT_THROW(static_cast<void>(make_extrusion(square, outside, {})), InvalidOption);
}

TEST(Generators, AreTheSameEveryTime) {
  for (const char* name : {"soup", "segments", "points", "organic", "gear"}) {
    const TriangleMesh a = make_shape(name);
    const TriangleMesh b = make_shape(name);
    EXPECT_EQ(a.vertices, b.vertices) << name;
    EXPECT_EQ(a.triangles, b.triangles) << name;
  }
  // Random shapes must not change between platforms or versions.
  const TriangleMesh soup = make_soup({});
  EXPECT_EQ(soup.vertices.size(), 300U);
  EXPECT_NE(make_soup({.seed = 2}).vertices, soup.vertices);
}

TEST(Generators, AwkwardSoupHoldsEveryKind) {
  const TriangleMesh mesh = make_soup({.triangles = 2000, .awkward = 0.5, .seed = 3});
  std::map<std::string, int> kinds;
  std::set<std::array<Vec3d, 3>, bool (*)(const std::array<Vec3d, 3>&, const std::array<Vec3d, 3>&)> seen(
      [](const auto& a, const auto& b) {
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (a[k][axis] != b[k][axis]) return a[k][axis] < b[k][axis];
          }
        }
        return false;
      });
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3d, 3> p{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    std::array<double, 3> sides{length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])};
    std::sort(sides.begin(), sides.end());
    const double height = sides[2] > 0 ? length(cross(p[1] - p[0], p[2] - p[0])) / sides[2] : 0;
    if (sides[0] == 0) {
      ++kinds["degenerate"];
    } else if (sides[0] < 0.001 * sides[2]) {
      ++kinds["needle"];
    } else if (height < 0.001 * sides[2]) {
      ++kinds["sliver"];
    }
    if (p[0].z == 0.125 && p[1].z == 0.125 && p[2].z == 0.125) ++kinds["coplanar"];
    std::sort(p.begin(), p.end(), [](const Vec3d& a, const Vec3d& b) { return a.x < b.x; });
    if (!seen.insert(p).second) ++kinds["copy"];
  }
  for (const char* kind : {"degenerate", "needle", "sliver", "coplanar", "copy"}) EXPECT_GT(kinds[kind], 50) << kind;
}

TEST(Generators, NoisyMovesEveryVertexByAtMostTheAmplitude) {
  const TriangleMesh mesh = make_torus({});
  const TriangleMesh noisy = make_noisy(mesh, 0.01, 5);
  EXPECT_EQ(noisy.triangles, mesh.triangles);
  double largest = 0;
  double sum = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double moved = length(noisy.vertices[v] - mesh.vertices[v]);
    largest = std::max(largest, moved);
    sum += moved;
  }
  EXPECT_LE(largest, 0.01 * (1 + 1e-9));
  // The mean distance from the centre of a ball is 3/4 of its radius.
  EXPECT_NEAR(sum / static_cast<double>(mesh.vertices.size()), 0.0075, 0.0002);
}

TEST(Generators, SubdivisionKeepsShapeAndTopology) {
  const TriangleMesh coarse = make_bracket({});
  const TriangleMesh fine = make_subdivided(coarse, 2);
  EXPECT_EQ(fine.triangles.size(), 16 * coarse.triangles.size());
  const Topology a = topology(coarse);
  const Topology b = topology(fine);
  EXPECT_EQ(a.betti, b.betti);
  EXPECT_NEAR(a.signed_volume, b.signed_volume, 1e-9);
  EXPECT_NEAR(a.area, b.area, 1e-9);
  TriangleMesh segments;
  segments.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  segments.segments = {{0, 1}, {2, 1}, {1, 1}};
  segments.points = {2};
  const TriangleMesh halves = make_subdivided(segments, 1);
  EXPECT_EQ(halves.segments.size(), 6U);
  EXPECT_EQ(topology(halves).pieces, 1U);
  EXPECT_EQ(halves.points, segments.points);
  EXPECT_EQ(topology(halves).edges, 4U);
}

TEST(Generators, AMeshCanBeAppendedToItself) {
  const TriangleMesh box = make_box({});
  TriangleMesh twice = box;
  append(twice, twice, {5, 0, 0});
  TriangleMesh expected = box;
  append(expected, box, {5, 0, 0});
  EXPECT_EQ(twice.vertices, expected.vertices);
  EXPECT_EQ(twice.triangles, expected.triangles);
  EXPECT_EQ(twice.vertices.size(), 2 * box.vertices.size());
}

TEST(Generators, RejectInvalidParameters) {
  const std::vector<Case> bad = {
      {"no_such_shape", {}},
      {"sphere", {{"radius", -1}}},
      {"sphere", {{"radius", NAN}}},
      {"sphere", {{"radius", INFINITY}}},
      {"sphere", {{"frequency", 2.5}}},
      {"sphere", {{"frequency", 1e9}}},
      {"sphere", {{"colour", 1}}},
      {"torus", {{"tube_radius", 1}}},
      {"torus", {{"ring_segments", 1e6}, {"tube_segments", 1e6}}},
      {"torus_knot", {{"p", 2}, {"q", 4}}},
      {"torus_knot", {{"tube_radius", 0.4}}},
      {"torus_knot", {{"wind_radius", 2}}},
      {"linked_tori", {{"tube_radius", 0.34}}},
      {"ridged_rod", {{"ridge_height", 0.5}}},
      {"spoon", {{"bowl_width", 4}}},
      {"spoon", {{"sides", 9}}},
      {"box", {{"size_x", 0}}},
      {"wedge", {{"angle", 180}}},
      {"plate", {{"hole_radius", 0.5}}},
      {"plate", {{"hole_segments", 6}}},
      {"plate", {{"holes_x", 3000}, {"holes_y", 3000}}},
      {"bracket", {{"hole_radius", 1}}},
      {"bracket", {{"holes", 50}}},
      {"bracket", {{"thickness", 1.5}}},
      {"gear", {{"tip_radius", 0.5}}},
      {"gear", {{"opening_radius", 0.4}}},
      {"gear", {{"openings", 20}}},
      {"void_cube", {{"void_radius", 0.5}}},
      {"bodies", {{"size", 1}}},
      {"bodies", {{"size", 1e-9}, {"spacing", 1e9}}},
      {"bodies", {{"count", 4000000}, {"frequency", 10}}},
      {"menger", {{"level", 6}}},
      {"soup", {{"triangles", 0}}},
      {"soup", {{"awkward", 2}}},
  };
  for (const Case& c : bad) {
    EXPECT_THROW(static_cast<void>(make_shape(c.name, c.parameters)), InvalidOption) << describe(c);
  }
  EXPECT_THROW(static_cast<void>(make_subdivided(make_box({}), 13)), InvalidOption);
  EXPECT_THROW(static_cast<void>(make_subdivided(make_sphere({}), 12)), InvalidOption);
  EXPECT_THROW(static_cast<void>(make_noisy(make_box({}), -1)), InvalidOption);
}

TEST(ShapeCatalog, DefaultsAreThoseOfTheGenerators) {
  const std::vector<std::pair<std::string, TriangleMesh>> shapes{{"box", make_box()},
                                                                 {"plate", make_plate()},
                                                                 {"bracket", make_bracket()},
                                                                 {"gear", make_gear()},
                                                                 {"star", make_star()},
                                                                 {"sphere", make_sphere()},
                                                                 {"ellipsoid", make_ellipsoid()},
                                                                 {"uv_sphere", make_uv_sphere()},
                                                                 {"cylinder", make_cylinder()},
                                                                 {"torus", make_torus()},
                                                                 {"torus_knot", make_torus_knot()},
                                                                 {"linked_tori", make_linked_tori()},
                                                                 {"ridged_rod", make_ridged_rod()},
                                                                 {"spoon", make_spoon()},
                                                                 {"organic", make_organic()},
                                                                 {"wedge", make_wedge()},
                                                                 {"void_cube", make_void_cube()},
                                                                 {"nested_shells", make_nested_shells()},
                                                                 {"bodies", make_bodies()},
                                                                 {"menger", make_menger()},
                                                                 {"fan_part", make_fan_part()},
                                                                 {"segments", make_segments()},
                                                                 {"points", make_points()}};
  for (const auto& [name, mesh] : shapes) {
    const TriangleMesh other = make_shape(name);
    EXPECT_TRUE(other.vertices == mesh.vertices && other.triangles == mesh.triangles) << name;
  }
}

TEST(ShapeCatalog, ListsShapesAndParametersInErrors) {
  try {
    static_cast<void>(make_shape("ball"));
    FAIL();
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("sphere"), std::string::npos);
  }
  try {
    static_cast<void>(make_shape("torus", {{"radius", 1}}));
    FAIL();
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("ring_radius"), std::string::npos);
  }
  std::set<std::string> names;
  for (const ShapeInfo& shape : shape_catalog()) {
    EXPECT_TRUE(names.insert(shape.name).second);
    EXPECT_FALSE(shape.description.empty());
    for (const ShapeParameter& p : shape.parameters) {
      EXPECT_LE(p.minimum, p.default_value) << shape.name << " " << p.name;
      EXPECT_LE(p.default_value, p.maximum) << shape.name << " " << p.name;
      EXPECT_FALSE(p.description.empty());
    }
  }
  EXPECT_GE(names.size(), 20U);
}

}  // namespace
}  // namespace blum
