// Proves where edges of a mesh and of a box meet, and which directions lead from there into the solid within the box.
#include "medial_axis/surface/mesh_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace blum {
namespace {

using detail::add_clip_points;
using detail::SurfacePoint;

const Box3 unit_box{{0, 0, 0}, {1, 1, 1}};

TEST(ClipPoints, AnEdgeThroughABoxHasAMiddleAndTwoEnds) {
  // A roof: the ridge runs along x at z = 0.5, and its sides face up and outwards.
  const double s = std::sqrt(0.5);
  std::vector<SurfacePoint> points;
  add_clip_points({{{{-1, 0.5, 0.5}, {3, 0.5, 0.5}}}, {{{0, s, s}, {0, -s, s}}}}, unit_box, points);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].at, (Vec3d{0.5, 0.5, 0.5}));
  EXPECT_EQ(points[1].at, (Vec3d{0, 0.5, 0.5}));
  EXPECT_EQ(points[2].at, (Vec3d{1, 0.5, 0.5}));
  for (const SurfacePoint& point : points) {
    EXPECT_NEAR(length(point.inwards - Vec3d{0, 0, -1}), 0, 1e-15);
  }
}

TEST(ClipPoints, AtASideOfTheBoxTheInwardDirectionStaysInThatSide) {
  const double s = std::sqrt(0.5);
  std::vector<SurfacePoint> points;
  add_clip_points({{{{-1, 0, 0.5}, {0.5, 0.75, 0.5}}}, {{{0, 0, 1}, {-s, 0, s}}}}, unit_box, points);
  ASSERT_EQ(points.size(), 2U) << "one end is inside";
  EXPECT_EQ(points[1].at.x, 0);
  EXPECT_EQ(points[1].inwards.x, 0);
  EXPECT_LT(points[1].inwards.z, 0);
}

TEST(ClipPoints, AnEdgeBesideABoxHasNoPoints) {
  std::vector<SurfacePoint> points;
  add_clip_points({{{{-1, 2, 0.5}, {3, 2, 0.5}}}, {{{0, 0, 1}, {0, 1, 0}}}}, unit_box, points);
  EXPECT_TRUE(points.empty());
}

TEST(ClipPoints, ATriangleCutsEdgesOfABox) {
  // The plane z = 0.25 faces up. The four upright edges pass through it, and the solid lies below.
  std::vector<SurfacePoint> points;
  add_clip_points({{{-5, -5, 0.25}, {10, -5, 0.25}, {-5, 10, 0.25}}}, {0, 0, 1}, unit_box, points);
  ASSERT_EQ(points.size(), 4U);
  for (const SurfacePoint& point : points) {
    EXPECT_NEAR(point.at.z, 0.25, 1e-15);
    EXPECT_EQ(point.inwards, (Vec3d{0, 0, -1}));
  }
  points.clear();
  add_clip_points({{{-5, -5, 2}, {10, -5, 2}, {-5, 10, 2}}}, {0, 0, 1}, unit_box, points);
  EXPECT_TRUE(points.empty());
}

}  // namespace
}  // namespace blum
