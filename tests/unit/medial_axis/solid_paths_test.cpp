// Proves that paths stay in the solid. Lines past a corner are bent around it. Lines across gaps of any width are
// detected, and paths over landmarks lead around gaps.
#include "medial_axis/surface/solid_paths.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "blum/shapes/generators.hpp"
#include "medial_axis/surface/mesh_surface.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using detail::holds;
using detail::MeshSurface;
using detail::SolidPaths;
using detail::Stop;

/// A box from (-1, -1, -1) to (1, 1, 1) with a slit from above down to z = 0, across x = 0.
TriangleMesh slit_block(double width) {
  const double w = 0.5 * width;
  // The outline in x and z, counterclockwise as seen from -y.
  const std::vector<std::array<double, 2>> outline{{-1, -1}, {1, -1}, {1, 1},  {w, 1},
                                                   {w, 0},   {-w, 0}, {-w, 1}, {-1, 1}};
  TriangleMesh mesh;
  for (const double y : {-1.0, 1.0}) {
    for (const auto& [x, z] : outline) mesh.vertices.push_back({x, y, z});
  }
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t next = (k + 1) % count;
    mesh.triangles.push_back({k, next + count, next});
    mesh.triangles.push_back({k, k + count, next + count});
  }
  // The two prongs and the foot, as fans.
  for (const auto& [a, b, c] :
       std::vector<Triangle>{{0, 1, 4}, {0, 4, 5}, {1, 2, 4}, {2, 3, 4}, {0, 5, 7}, {5, 6, 7}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a + count, c + count, b + count});
  }
  return mesh;
}

struct Sample {
  explicit Sample(TriangleMesh given)
      : mesh(std::move(given)), sites(mesh), surface(mesh, sites, true, {}), paths(surface) {}
  [[nodiscard]] Stop at(const Vec3d& p) const { return *paths.stop_at(p, {}); }

  TriangleMesh mesh;
  SiteTable sites;
  MeshSurface surface;
  SolidPaths paths;
};

TEST(SolidPaths, StopsLieInTheSolidAndNotOnItsSurface) {
  const Sample s(make_box({}));
  EXPECT_TRUE(s.paths.stop_at({0.1, 0.2, 0.3}, {}).has_value());
  EXPECT_FALSE(s.paths.stop_at({0.5, 0.2, 0.3}, {}).has_value());
  EXPECT_FALSE(s.paths.stop_at({0.6, 0.2, 0.3}, {}).has_value());
  EXPECT_NEAR(s.at({0.1, 0.2, 0.3}).nearest.distance, 0.2, 1e-15);
}

TEST(SolidPaths, LinesAcrossGapsOfAnyWidthAreDetected) {
  for (const double width : {0.1, 1e-3, 1e-6, 1e-9}) {
    SCOPED_TRACE(width);
    const Sample s(slit_block(width));
    const Stop left = s.at({-0.4, 0, 0.7});
    const Stop right = s.at({0.4, 0.1, 0.7});
    EXPECT_FALSE(s.paths.is_straight(left, right));
    EXPECT_FALSE(s.paths.pushed(left, right).has_value());
    EXPECT_TRUE(s.paths.is_straight(left, s.at({-0.3, 0.2, 0.1})));
    EXPECT_TRUE(s.paths.is_straight(s.at({-0.4, 0, -0.3}), s.at({0.4, 0, -0.3})));
  }
}

TEST(SolidPaths, LandmarksLeadAroundAGap) {
  for (const double width : {0.1, 1e-3, 1e-9}) {
    SCOPED_TRACE(width);
    const Sample s(slit_block(width));
    const Stop left = s.at({-0.4, 0, 0.7});
    const Stop right = s.at({0.4, 0.1, 0.7});
    const std::vector<Stop> landmarks{s.at({0, 0, -0.5}), s.at({-0.6, 0.9, 0.9})};
    const auto path = s.paths.path(left, right, landmarks);
    ASSERT_TRUE(path.has_value());
    ASSERT_EQ(path->size(), 1U);
    EXPECT_EQ(path->front().at, landmarks[0].at);
  }
}

TEST(SolidPaths, ALineThatCutsACornerIsBentAroundIt) {
  const Sample s(slit_block(0.5));
  // The line passes the lower corner of the slit at (-0.25, 0), 0.007 outside the solid.
  const Stop above = s.at({-0.26, 0, 0.02});
  const Stop below = s.at({-0.22, 0, -0.01});
  EXPECT_FALSE(s.paths.is_straight(above, below));
  auto stops = s.paths.path(above, below, {});
  ASSERT_TRUE(stops.has_value());
  stops->insert(stops->begin(), above);
  stops->push_back(below);
  for (std::size_t k = 0; k + 1 < stops->size(); ++k) EXPECT_TRUE(s.paths.is_straight((*stops)[k], (*stops)[k + 1]));
}

TEST(SolidPaths, APointOutsideIsMovedInsideNextToIt) {
  const Sample s(make_box({}));
  const Stop near = s.at({0.4, 0, 0});
  const Stop moved = s.paths.inside_near({0.6, 0.1, 0}, near);
  EXPECT_GT(moved.nearest.distance, 0);
  EXPECT_LT(length(moved.at - Vec3d{0.6, 0.1, 0}), 0.7);
  EXPECT_EQ(s.paths.inside_near({0.1, 0.1, 0}, near).at, (Vec3d{0.1, 0.1, 0}));
}

/// A strip from y = -1 to 1. Between x = 0 and 1 it rises to z = 1 and returns to 0 `folds` times.
TriangleMesh folded_strip(std::uint32_t folds, double thickness) {
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k <= folds; ++k) {
    const double x = static_cast<double>(k) / folds;
    const double z = k % 2;
    mesh.vertices.insert(mesh.vertices.end(), {{x, -1, z}, {x, -1, z + thickness}, {x, 1, z + thickness}, {x, 1, z}});
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
  };
  for (std::uint32_t k = 0; k < folds; ++k) {
    const std::uint32_t v = 4 * k;
    for (std::uint32_t side = 0; side < 4; ++side) {
      const std::uint32_t next = (side + 1) % 4;
      add(v + side, v + 4 + side, v + 4 + next, v + next);
    }
  }
  add(0, 1, 2, 3);
  const std::uint32_t end = 4 * folds;
  add(end + 3, end + 2, end + 1, end);
  return mesh;
}

TEST(SolidPaths, ScatteredPointsLeadThroughSeveralFolds) {
  for (const double thickness : {0.2, 0.05}) {
    SCOPED_TRACE(thickness);
    const Sample s(folded_strip(4, thickness));
    const Stop from = s.at({0.125, 0, 0.5 + 0.5 * thickness});
    const Stop to = s.at({0.625, 0.2, 0.5 + 0.5 * thickness});
    EXPECT_FALSE(s.paths.pushed(from, to).has_value());
    auto stops = s.paths.path(from, to, {});
    ASSERT_TRUE(stops.has_value());
    stops->insert(stops->begin(), from);
    stops->push_back(to);
    EXPECT_LT(stops->size(), 12U);
    for (std::size_t k = 0; k + 1 < stops->size(); ++k) EXPECT_TRUE(s.paths.is_straight((*stops)[k], (*stops)[k + 1]));
  }
}

/// A plate with one hole of radius 0.005 in its middle.
TriangleMesh pierced_plate() {
  return make_plate({.holes_x = 1, .holes_y = 1, .hole_radius = 0.005});
}

TEST(SolidPaths, ATriangleAroundANarrowHoleIsNotOpen) {
  const Sample s(pierced_plate());
  const Vec3d hole = bounds(s.mesh).center();
  const Stop a = s.at(hole + Vec3d{-0.2, -0.1, 0});
  const Stop b = s.at(hole + Vec3d{0.2, -0.1, 0});
  const Stop beyond = s.at(hole + Vec3d{0, 0.2, 0});
  const Stop before = s.at(hole + Vec3d{0, -0.2, 0});
  EXPECT_FALSE(s.paths.is_open(a, b, beyond));
  EXPECT_TRUE(s.paths.is_open(a, b, before));
  EXPECT_TRUE(s.paths.is_straight(a, b)) << "all sides of both are in the solid";
  EXPECT_EQ(s.paths.pulled_over_open({a, beyond, b}).size(), 3U);
  EXPECT_EQ(s.paths.pulled_over_open({a, before, b}).size(), 2U);
}

TEST(SolidPaths, SegmentsAreNotSweptOverAHole) {
  const Sample s(pierced_plate());
  const Vec3d hole = bounds(s.mesh).center();
  const auto segment = [&](double y) {
    return std::array<Stop, 2>{s.at(hole + Vec3d{-0.2, y, 0}), s.at(hole + Vec3d{0.2, y, 0})};
  };
  EXPECT_TRUE(s.paths.can_sweep(segment(0.1), segment(0.3)));
  EXPECT_FALSE(s.paths.can_sweep(segment(-0.1), segment(0.1)));
}

TEST(SolidPaths, PathsInABoxStayInTheBox) {
  const Sample s(slit_block(1e-3));
  const Stop a = s.at({-0.3, 0, 0.2});
  const Stop b = s.at({0.3, 0, 0.2});
  const Box3 low{{-0.5, -0.5, -0.1}, {0.5, 0.5, 0.5}};
  const auto path = SolidPaths(s.surface, low).path(a, b, {});
  ASSERT_TRUE(path.has_value());
  ASSERT_FALSE(path->empty());
  for (const Stop& stop : *path) EXPECT_TRUE(holds(low, stop.at));
  const Box3 high{{-0.5, -0.5, 0.1}, {0.5, 0.5, 0.5}};
  EXPECT_FALSE(SolidPaths(s.surface, high).path(a, b, {}).has_value()) << "the slit parts this box";
}

TEST(SolidPaths, ThinWallsThatTurnAreFollowedFromTriangleToTriangle) {
  const double thickness = 1e-5;
  TriangleMesh shell = make_sphere({.radius = 1});
  TriangleMesh inner = test::moved(make_sphere({.radius = 1}), 1 - thickness);
  reverse_triangles(inner);
  append(shell, inner);
  const Sample s(shell);
  const auto in_wall = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3d out{std::cos(angle), std::sin(angle), 0.1};
    const double t = *s.surface.first_crossing({0, 0, 0}, out * 2.0, nullptr);
    return s.at(out * (2 * t + 0.4 * thickness));
  };
  const Stop a = in_wall(10);
  const Stop b = in_wall(70);
  const auto path = s.paths.path(a, b, {});
  ASSERT_TRUE(path.has_value());
  Stop last = a;
  for (const Stop& stop : *path) {
    EXPECT_TRUE(s.paths.is_straight(last, stop));
    EXPECT_GT(stop.nearest.distance, 0.1 * thickness) << "in the middle of the wall";
    last = stop;
  }
  EXPECT_TRUE(s.paths.is_straight(last, b));
}

TEST(SolidPaths, PointsWithinRoundingOfTheSurfaceAreNotStops) {
  const Sample s(make_box({}));
  EXPECT_FALSE(s.paths.stop_at({0.5 - 5e-17, 0, 0}, {}).has_value());
  EXPECT_FALSE(s.paths.stop_at({0.5 - 1e-14, 0, 0}, {}).has_value());
  EXPECT_TRUE(s.paths.stop_at({0.5 - 1e-9, 0, 0}, {}).has_value());
}

TEST(SolidPaths, APointThatSeesAllCornersIsFoundInAFold) {
  for (const double thickness : {0.1, 1e-3, 1e-4}) {
    SCOPED_TRACE(thickness);
    const Sample s(folded_strip(4, thickness));
    const double mid = 0.5 * thickness;
    // Two corners lie on the way up and two on the way down. Corners of different slopes do not see each other.
    const std::vector<Stop> corners{s.at({0.22, -0.3, 0.88 + mid}), s.at({0.22, 0.3, 0.88 + mid}),
                                    s.at({0.28, 0.3, 0.88 + mid}), s.at({0.28, -0.3, 0.88 + mid})};
    EXPECT_FALSE(s.paths.is_straight(corners[0], corners[2]));
    const auto middle = s.paths.seeing_all(corners, 0);
    ASSERT_TRUE(middle.has_value());
    for (std::size_t k = 0; k < corners.size(); ++k) EXPECT_TRUE(s.paths.is_straight(middle->stop, corners[k]));
  }
  const Sample s(folded_strip(4, 1e-3));
  const std::vector<Stop> too_far{s.at({0.125, 0, 0.5005}), s.at({0.625, 0, 0.5005})};
  EXPECT_FALSE(s.paths.seeing_all(too_far, 0).has_value());
}

TEST(SolidPaths, TheBorderOfTheClippedSolidLeadsThroughThinFolds) {
  for (const double thickness : {1e-2, 1e-4}) {
    SCOPED_TRACE(thickness);
    const Sample s(folded_strip(6, thickness));
    const Box3 box{{0.02, -0.4, -0.5}, {0.98, 0.4, 1.5}};
    const double mid = 0.5 * thickness;
    const Stop from = s.at({0.05, -0.4, 0.3 + mid});
    const Stop to = s.at({0.55, 0.4, 0.7 + mid});
    const auto path = SolidPaths(s.surface, box).path(from, to, {});
    ASSERT_TRUE(path.has_value());
    Stop last = from;
    for (const Stop& stop : *path) {
      EXPECT_TRUE(holds(box, stop.at));
      EXPECT_TRUE(s.paths.is_straight(last, stop));
      last = stop;
    }
    EXPECT_TRUE(s.paths.is_straight(last, to));
  }
}

}  // namespace
}  // namespace blum
