// Proves that deviations weighted by area have known means and percentiles, and that the stated errors hold.
#include "blum/surface_map/surface_deviation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// On this slope, the distance from the plane is evenly distributed from 0 to 1.
TEST(SurfaceDeviation, OfASlope) {
  const TriangleMesh slope{{{0, 0, 0}, {2, 0, 1}, {2, 3, 1}, {0, 3, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  const TriangleMesh plane{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  const SurfaceDeviation found = surface_deviation(slope, plane, {.pieces = 100'000});
  EXPECT_GT(found.pieces, 50'000U);
  EXPECT_NEAR(found.area, 3 * std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(found.mean, 0.5, 1e-6) << "centroids of straight values are exact";
  EXPECT_NEAR(found.rms, std::sqrt(1.0 / 3), 1e-4);
  EXPECT_LE(std::abs(found.rms - std::sqrt(1.0 / 3)), found.rms_error);
  EXPECT_GT(found.mean_error, 0);
  EXPECT_LT(found.mean_error, 0.01);
  for (std::size_t k = 0; k < found.percentiles.size(); ++k) {
    EXPECT_NEAR(found.percentiles[k], SurfaceDeviation::percents[k] / 100, found.percentile_error);
  }
  EXPECT_LE(1 - found.largest, found.percentile_error);
}

/// The stated errors hold for any number of pieces, compared with a much finer result.
TEST(SurfaceDeviation, KnowsItsErrors) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  const TriangleMesh other = make_torus();
  const SurfaceDeviation fine = surface_deviation(mesh, other, {.pieces = 2'000'000, .sign = SignMode::automatic});
  for (const std::size_t pieces : {1U, 500U, 20'000U}) {
    const SurfaceDeviation rough = surface_deviation(mesh, other, {.pieces = pieces, .sign = SignMode::automatic});
    EXPECT_LE(std::abs(rough.mean - fine.mean), rough.mean_error + fine.mean_error);
    EXPECT_LE(std::abs(rough.rms - fine.rms), rough.rms_error + fine.rms_error);
    for (std::size_t k = 0; k < 7; ++k) {
      EXPECT_LE(std::abs(rough.percentiles[k] - fine.percentiles[k]), rough.percentile_error + fine.percentile_error);
    }
  }
  EXPECT_LT(fine.mean_error, 0.002);
  EXPECT_EQ(fine.sign_rule, SignRule::normals);
}

/// Sums of millions of terms lose no digits: the mean of equal distances is that distance.
TEST(SurfaceDeviation, OfEqualDistancesIsExactForManyPieces) {
  const double size = 0x1p-60;
  const TriangleMesh tiny{{{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {{0, 1, 2}}, {}, {}};
  for (const double height : {0.1, 1.2389276531804048}) {
    const TriangleMesh point{{{0, 0, height}}, {}, {}, {0}};
    const SurfaceDeviation found = surface_deviation(tiny, point, {.pieces = 1'000'000});
    EXPECT_LE(std::abs(found.mean - height), found.mean_error);
    EXPECT_LE(std::abs(found.rms - height), found.rms_error);
    EXPECT_LT(found.mean_error, 1e-14);
  }
}

TEST(SurfaceDeviation, OfVeryDistantPointsIsFinite) {
  const double size = 1e-140;
  const TriangleMesh tiny{{{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {{0, 1, 2}}, {}, {}};
  for (const double far : {1e10, 1e30, 1e99}) {
    const TriangleMesh point{{{0, 0, far}}, {}, {}, {0}};
    const SurfaceDeviation found = surface_deviation(tiny, point, {.pieces = 10});
    EXPECT_NEAR(found.rms / far, 1, 1e-15);
    EXPECT_NEAR(found.mean / far, 1, 1e-15);
  }
}

/// For open meshes, signs by winding numbers may change within pieces.
TEST(SurfaceDeviation, KnowsItsErrorsWhereSignsJump) {
  TriangleMesh bowl = make_sphere();
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return bowl.vertices[t[0]].z + bowl.vertices[t[1]].z + bowl.vertices[t[2]].z > 0;
  });
  const TriangleMesh post{{{0, 0, -0.5}, {0.1, 0, 0.7}, {0, 0.1, 0.7}}, {{0, 1, 2}}, {}, {}};
  const SurfaceDeviation fine = surface_deviation(post, bowl, {.pieces = 100'000, .sign = SignMode::automatic});
  const SurfaceDeviation rough = surface_deviation(post, bowl, {.pieces = 1, .sign = SignMode::automatic});
  EXPECT_LE(std::abs(rough.mean - fine.mean), rough.mean_error);
  EXPECT_LE(std::abs(rough.smallest - fine.smallest), rough.percentile_error);
  EXPECT_LE(std::abs(rough.largest - fine.largest), rough.percentile_error);
}

TEST(SurfaceDeviation, OfNeedlesAndAtEveryScale) {
  for (const double scale : {1e-148, 1e-120, 1.0, 1e120}) {
    const TriangleMesh needle{{{0, 0, scale}, {scale, 0, scale}, {scale, 1e-13 * scale, scale}}, {{0, 1, 2}}, {}, {}};
    const TriangleMesh point{{{0, 0, 0}}, {}, {}, {0}};
    const SurfaceDeviation found = surface_deviation(needle, point, {.pieces = 1000});
    EXPECT_LT(found.pieces, 4000U);
    EXPECT_GT(found.mean, scale);
    EXPECT_LT(found.mean, std::sqrt(2.0) * scale);
  }
  const TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}, {}, {}};
  EXPECT_THROW((void)surface_deviation(flat, make_box()), InvalidMesh);
  EXPECT_THROW((void)surface_deviation(make_box(), make_box(), {.pieces = 0}), InvalidOption);
  EXPECT_THROW((void)surface_deviation(make_box(), make_box(), {.pieces = 1'000'000'000'000}), InvalidOption);
}

TEST(SurfaceDeviation, IsTheSameForAnyThreads) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  const SurfaceDeviation one = surface_deviation(mesh, make_torus(), {.pieces = 50'000}, {.threads = 1});
  const SurfaceDeviation many = surface_deviation(mesh, make_torus(), {.pieces = 50'000}, {.threads = 7});
  EXPECT_EQ(one.mean, many.mean);
  EXPECT_EQ(one.rms, many.rms);
  EXPECT_EQ(one.percentiles, many.percentiles);
}

}  // namespace
}  // namespace blum
