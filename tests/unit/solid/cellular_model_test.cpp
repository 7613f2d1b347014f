// Proves that the cellular model of a solid has the solid's Betti numbers at every resolution and every place of its
// grid. Thin walls and empty needles pass, failing places are named, and invalid options are rejected.
#include "blum/solid/cellular_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stop_token>
#include <string>
#include <vector>

#include "blum/complex/homology.hpp"
#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/solid/solid.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;

std::int64_t euler_of(const BettiNumbers& betti) {
  return betti[0] - betti[1] + betti[2];
}

void expect_model_of(const Solid& solid, const CellularModelOptions& options, const std::string& what) {
  const CellularModel model = solid.model(options);
  const std::string where =
      what + " at " + std::to_string(options.resolution) + ", shift " + std::to_string(options.shift);
  EXPECT_TRUE(model.report().passes) << where;
  EXPECT_EQ(model.report().euler, euler_of(*solid.betti())) << where;
  EXPECT_EQ(model.betti(), *solid.betti()) << where;
}

/// A sphere of radius 1 and a slightly smaller sphere, turned inside out.
TriangleMesh thin_shell(double thickness) {
  TriangleMesh mesh = make_sphere({.radius = 1, .frequency = 4});
  const std::size_t count = mesh.vertices.size();
  for (std::size_t v = 0; v < count; ++v) mesh.vertices.push_back(mesh.vertices[v] * (1 - thickness));
  const std::size_t triangles = mesh.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t) {
    const Triangle own = mesh.triangles[t];
    const auto n = static_cast<std::uint32_t>(count);
    mesh.triangles.push_back({own[0] + n, own[2] + n, own[1] + n});
  }
  return mesh;
}

/// A unit cube with an empty cone in its top. The apex of the cone lies inside.
TriangleMesh block_with_needle(double degrees, std::uint32_t sides, const Vec3d& apex) {
  TriangleMesh mesh = make_box({.size = {1, 1, 1}});
  const double radius = std::tan(0.5 * degrees * std::numbers::pi / 180) * (0.5 - apex.z);
  // A fan around the opening replaces the two triangles of the top.
  std::vector<std::uint32_t> rim;
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    for (const std::uint32_t v : t) {
      if (mesh.vertices[v].z < 0.4) return false;
    }
    return true;
  });
  const auto on_top = [&](double x, double y) {
    for (std::uint32_t v = 0; v < 8; ++v) {
      const Vec3d& p = mesh.vertices[v];
      if (p.z > 0.4 && (p.x > 0) == (x > 0) && (p.y > 0) == (y > 0)) return v;
    }
    return 8U;
  };
  const std::vector<std::uint32_t> square{on_top(1, 1), on_top(-1, 1), on_top(-1, -1), on_top(1, -1)};
  for (std::uint32_t k = 0; k < 4 * sides; ++k) {
    const double angle = (k + 0.5) * 0.5 * std::numbers::pi / sides;
    rim.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.5});
  }
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(apex);
  for (std::uint32_t k = 0; k < 4 * sides; ++k) {
    const std::uint32_t following = rim[(k + 1) % (4 * sides)];
    mesh.triangles.push_back({rim[k], following, tip});
    const std::uint32_t corner = square[k / sides];
    mesh.triangles.push_back({corner, following, rim[k]});
    if ((k + 1) % sides == 0) mesh.triangles.push_back({corner, square[(k / sides + 1) % 4], following});
  }
  return mesh;
}

TEST(CellularModel, CatalogueShapesHaveTheirNumbersAtEveryResolution) {
  int shapes = 0;
  for (const ShapeInfo& shape : shape_catalog()) {
    const TriangleMesh mesh = shape.make(complete_parameters(shape, {}));
    if (mesh.triangles.empty() || mesh.triangles.size() > 30000) continue;
    const Solid solid = Solid::of(mesh);
    if (solid.rule() != SolidRule::polyhedron) continue;
    for (const int resolution : {1, 2, 3, 5, 8, 16, 32}) {
      for (const double shift : {0.381966, 0.0}) {
        expect_model_of(solid, {.resolution = resolution, .shift = shift}, std::string(shape.name));
      }
    }
    ++shapes;
  }
  EXPECT_GT(shapes, 12);
}

TEST(CellularModel, TouchingBodiesAreModelledSeparately) {
  // Three boxes form a row in which neighbours share a face. One box on top touches two of them.
  TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, box_between({1, 0, 0}, {2, 1, 1}));
  append(mesh, box_between({2, 0, 0}, {3, 1, 1}));
  append(mesh, box_between({0.5, 0, 1}, {1.5, 1, 2}));
  append(mesh, box_between({5, 5, 5}, {6, 6, 6}));
  const Solid solid = Solid::of(mesh);
  ASSERT_EQ(*solid.betti(), (BettiNumbers{5, 0, 0}));
  for (const int resolution : {1, 3, 12}) expect_model_of(solid, {.resolution = resolution, .shift = 1}, "boxes");
}

TEST(CellularModel, BodiesWithinACubeAreComponents) {
  // At a resolution of one cube, all bodies lie in it, and some lie in the void of another.
  TriangleMesh mesh = make_bodies({.count = 64});
  const Vec3d far = bounds(mesh).upper;
  append(mesh, box_between(far + Vec3d{1, 1, 1}, far + Vec3d{9, 9, 9}));
  append(mesh, box_between(far + Vec3d{2, 2, 2}, far + Vec3d{8, 8, 8}));
  append(mesh, box_between(far + Vec3d{4, 4, 4}, far + Vec3d{5, 5, 5}));
  append(mesh, box_between(far + Vec3d{6, 6, 6}, far + Vec3d{7, 7, 7}));
  const Solid solid = Solid::of(mesh);
  ASSERT_EQ(*solid.betti(), (BettiNumbers{67, 0, 1}));
  for (const int resolution : {1, 2, 3, 12}) expect_model_of(solid, {.resolution = resolution}, "bodies");
}

TEST(CellularModel, PlanesThroughVerticesPass) {
  // All coordinates and all planes are multiples of 1/4.
  const Solid solid = Solid::of(make_box({.size = {1, 2, 4}, .segments = {4, 4, 4}}));
  for (const double spacing : {0.25, 0.5, 1.0, 2.0}) {
    const CellularModel model = solid.model({.spacing = spacing, .shift = 1});
    EXPECT_TRUE(model.report().passes) << spacing;
    EXPECT_EQ(model.betti(), (BettiNumbers{1, 0, 0})) << spacing;
  }
}

TEST(CellularModel, WallsAsThinAsCoordinatesAllowPass) {
  for (const double thickness : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    const Solid solid = Solid::of(thin_shell(thickness));
    ASSERT_EQ(solid.rule(), SolidRule::polyhedron) << thickness;
    ASSERT_EQ(*solid.betti(), (BettiNumbers{1, 0, 1})) << thickness;
    for (const int resolution : {3, 20}) {
      const CellularModel model = solid.model({.resolution = resolution});
      EXPECT_EQ(model.betti(), (BettiNumbers{1, 0, 1})) << thickness;
      EXPECT_EQ(model.report().failing_cubes, 0U) << thickness;
    }
  }
}

TEST(CellularModel, EmptyNeedlesAreSplitUntilTheyPass) {
  for (const double degrees : {1.0, 3.0, 10.0, 25.0}) {
    for (const Vec3d& apex : {Vec3d{0.1, 0.05, -0.2}, Vec3d{-0.3, 0.28, -0.4}}) {
      const Solid solid = Solid::of(block_with_needle(degrees, 2, apex));
      ASSERT_EQ(solid.rule(), SolidRule::polyhedron) << solid.reason();
      for (const int resolution : {2, 7, 24}) {
        expect_model_of(solid, {.resolution = resolution}, "needle of " + std::to_string(degrees));
      }
    }
  }
}

/// A unit cube with a square, possibly oblique channel from the bottom to the top.
TriangleMesh block_with_channel(double width, const Vec3d& slant) {
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0}) {
    const std::array<Vec3d, 4> outer{Vec3d{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
    mesh.vertices.insert(mesh.vertices.end(), outer.begin(), outer.end());
    const Vec3d middle = Vec3d{0.37, 0.41, 0} + slant * z;
    for (const Vec3d& corner : outer) {
      mesh.vertices.push_back({middle.x + width * (corner.x - 0.5), middle.y + width * (corner.y - 0.5), z});
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4;
    add(k, n, 8 + n, 8 + k);            // outside
    add(4 + n, 4 + k, 12 + k, 12 + n);  // the channel
    add(n, k, 4 + k, 4 + n);            // bottom
    add(8 + k, 8 + n, 12 + n, 12 + k);  // top
  }
  return mesh;
}

TEST(CellularModel, OpensAxisAlignedNeedlesAndNamesObliqueOnes) {
  constexpr double width = 1e-9;
  const Solid upright = Solid::of(block_with_channel(width, {}));
  ASSERT_EQ(upright.rule(), SolidRule::polyhedron) << upright.reason();
  EXPECT_TRUE(upright.model({.resolution = 7}).report().passes);
  const CellularModelReport report =
      Solid::of(block_with_channel(width, {0.2, 0.3, 0})).model({.resolution = 7}).report();
  EXPECT_FALSE(report.passes);
  ASSERT_FALSE(report.failures.empty());
  for (const ModelFailure& failure : report.failures) {
    EXPECT_EQ(failure.obstacle, ModelObstacle::slanted_needle);
    // The channel shifts by 0.2 and 0.3 over a height of 1. Cubes have side 1/7.
    EXPECT_GT(failure.cuts, 0.1 / 7 / width);
    EXPECT_LT(failure.cuts, 1.0 / 7 / width);
  }
}

TEST(CellularModel, PlacesThatCannotBeSplitAreNamed) {
  const Solid solid = Solid::of(block_with_needle(3, 2, {0.1, 0.05, -0.2}));
  const CellularModelReport report = solid.model({.resolution = 7, .most_splits = 0}).report();
  EXPECT_FALSE(report.passes);
  EXPECT_EQ(report.boxes, 0U);
  ASSERT_FALSE(report.failures.empty());
  for (const ModelFailure& failure : report.failures) {
    EXPECT_EQ(failure.obstacle, ModelObstacle::hole_in_square);
    EXPECT_NEAR(length(failure.high - failure.low), std::sqrt(3) / 7, 1e-9);
    EXPECT_LT(std::abs(failure.low.x), 0.4) << "beside the needle";
  }
  const Solid hollow = Solid::of(make_nested_shells({.shells = 2, .frequency = 2}));
  const CellularModelReport whole = hollow.model({.resolution = 1, .shift = 0.1, .most_splits = 0}).report();
  EXPECT_EQ(whole.passes, whole.failures.empty());
}

TEST(CellularModel, TheSameForAnyNumberOfThreads) {
  const Solid solid = Solid::of(make_organic({.frequency = 12}));
  const Complex one = solid.model({.resolution = 20}, {.threads = 1}).complex({.threads = 1});
  for (const int threads : {2, 7}) {
    const Complex other = solid.model({.resolution = 20}, {.threads = threads}).complex({.threads = threads});
    EXPECT_EQ(one.positions, other.positions);
    EXPECT_EQ(one.edges, other.edges);
    EXPECT_EQ(one.triangles, other.triangles);
  }
}

TEST(CellularModel, CornersOfTheComplexLieInTheSolid) {
  const Solid solid = Solid::of(make_plate({}));
  const Complex complex = solid.model({.resolution = 9}).complex();
  EXPECT_EQ(homology(complex.view()), *solid.betti());
  std::size_t inside = 0;
  for (const Vec3d& p : complex.positions) inside += solid.inside(p) ? 1U : 0U;
  EXPECT_GT(static_cast<double>(inside), 0.95 * static_cast<double>(complex.positions.size()));
}

TEST(CellularModel, RejectsInvalidOptionsAndMeshes) {
  const Solid solid = Solid::of(make_box({}));
  for (const CellularModelOptions& options : {CellularModelOptions{.resolution = 0},
                                              {.resolution = 801},
                                              {.spacing = 0},
                                              {.spacing = 1e-6},
                                              {.shift = -0.1},
                                              {.shift = 1.1},
                                              {.most_splits = -1},
                                              {.most_splits = 201}}) {
    EXPECT_THROW((void)solid.model(options), InvalidOption);
  }
  EXPECT_THROW((void)Solid::of(make_organic({.frequency = 8, .holes = 2})).model(), InvalidMesh);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)solid.model({}, {.cancel = stop.get_token()}), Cancelled);
}

}  // namespace
}  // namespace blum
