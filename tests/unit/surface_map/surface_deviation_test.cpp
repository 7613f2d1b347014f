// Proves that deviations weighted by area have known means and percentiles, and that the stated errors hold.
#include "blum/surface_map/surface_deviation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// Means and percentiles of points that are spread evenly over a surface.
struct Sampled {
  double mean = 0;
  double rms = 0;
  std::array<double, 7> percentiles{};
  double error = 0;  ///< bound on the error of each of them
};

/// The slow reference: cuts each triangle into n * n equal ones, and takes the distance of their centroids.
Sampled sampled(const TriangleMesh& mesh, const TriangleMesh& other, int n, SignMode sign) {
  std::vector<Vec3d> points;
  std::vector<double> areas;
  Sampled out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    const double area = length(cross(b - a, c - a)) / 2 / (n * n);
    const auto at = [&](double x, double y) { return a + (b - a) * (x / n) + (c - a) * (y / n); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        points.push_back(at(i + 1 / 3.0, j + 1 / 3.0));
        areas.push_back(area);
        if (i + j + 1 == n) continue;
        points.push_back(at(i + 2 / 3.0, j + 2 / 3.0));
        areas.push_back(area);
      }
    }
    out.error = std::max({out.error, length(b - a) / n, length(c - b) / n, length(a - c) / n});
  }
  const std::vector<ClosestPoint> found = closest_points(other, points, {.sign = sign});
  std::vector<std::pair<double, double>> values;
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    values.emplace_back(found[k].distance, areas[k]);
    sum += areas[k];
    out.mean += areas[k] * found[k].distance;
    out.rms += areas[k] * found[k].distance * found[k].distance;
  }
  out.mean /= sum;
  out.rms = std::sqrt(out.rms / sum);
  std::sort(values.begin(), values.end());
  double below = 0;
  std::size_t next = 0;
  for (const auto& [value, area] : values) {
    below += area;
    while (next < 7 && below >= sum * SurfaceDeviation::percents[next] / 100) out.percentiles[next++] = value;
  }
  while (next < 7) out.percentiles[next++] = values.back().first;
  return out;
}

void expect_agreement(const SurfaceDeviation& found, const Sampled& reference, const std::string& name) {
  const double more = reference.error + 1e-12;
  EXPECT_LE(std::abs(found.mean - reference.mean), found.mean_error + more) << name;
  EXPECT_LE(std::abs(found.rms - reference.rms), found.rms_error + more) << name;
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_LE(std::abs(found.percentiles[k] - reference.percentiles[k]), found.percentile_error + more) << name << k;
  }
}

TriangleMesh random_soup(std::uint64_t seed) {
  Random random(seed);
  TriangleMesh out;
  for (std::uint32_t t = 0; t < 12; ++t) {
    const Vec3d at = random.in_cube();
    const double size = random.uniform(0.01, 0.6);
    for (int k = 0; k < 3; ++k) out.vertices.push_back(at + random.in_cube() * size);
    out.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  out.triangles.push_back({0, 1, 1});                      // no area
  out.vertices[5] = out.vertices[4] + Vec3d{1e-13, 0, 0};  // a needle
  return out;
}

/// The intervals overlap those of dense samples: random soups, flat and round shapes, with and without signs.
TEST(SurfaceDeviation, AgreesWithDenseSamples) {
  std::vector<std::pair<TriangleMesh, TriangleMesh>> pairs;
  for (std::uint64_t seed = 0; seed < 12; ++seed) pairs.emplace_back(random_soup(seed), random_soup(seed + 100));
  pairs.emplace_back(make_box(), make_box({.size = {2, 2, 2}}));
  pairs.emplace_back(make_box({.size = {2, 2, 2}}), make_box());
  pairs.emplace_back(make_box(), test::moved(make_box(), 1, {0.5, 0.25, 0}));
  pairs.emplace_back(make_box(), make_box());
  pairs.emplace_back(make_box({.size = {3, 2, 2}}), make_sphere({.frequency = 4}));
  pairs.emplace_back(make_sphere({.frequency = 4}), make_torus());
  pairs.emplace_back(make_box(), test::moved(make_sphere(), 0.1, {20, 0, 0}));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [mesh, other] = pairs[k];
    const int n = mesh.triangles.size() > 50 ? 20 : 100;
    for (const SignMode sign : {SignMode::none, SignMode::automatic}) {
      const Sampled reference = sampled(mesh, other, n, sign);
      for (const std::size_t pieces : {1U, 100U, 100'000U}) {
        const SurfaceDeviation found = surface_deviation(mesh, other, {.pieces = pieces, .sign = sign});
        expect_agreement(found, reference, std::to_string(k) + " with " + std::to_string(pieces));
      }
    }
  }
}

/// The division ends when all errors are below the wanted one. Flat parts take few pieces.
TEST(SurfaceDeviation, KeepsTheLargestErrorThatIsAskedFor) {
  const TriangleMesh small = make_box();
  const TriangleMesh large = make_box({.size = {2, 2, 2}});
  std::size_t before = 0;
  for (const double most : {0.1, 0.01, 0.001, 0.0002}) {
    for (const bool is_out : {false, true}) {
      const SurfaceDeviation found =
          surface_deviation(is_out ? large : small, is_out ? small : large, {.max_error = most});
      EXPECT_LE(std::max({found.mean_error, found.rms_error, found.percentile_error}), most);
      if (!is_out) {
        EXPECT_EQ(found.pieces, 12U) << "all of the surface is 0.5 away";
        EXPECT_NEAR(found.mean, 0.5, 1e-14);
        EXPECT_LT(found.percentile_error, 1e-13);
      } else {
        EXPECT_GE(found.pieces, before);
        before = found.pieces;
      }
    }
  }
  EXPECT_LT(before, 60'000U);
  EXPECT_THROW((void)surface_deviation(small, large, {.max_error = 0}), InvalidOption);
}

/// Pieces are cut where the closest site changes, so flat parts and parts closest to one edge take few pieces. The
/// percentiles of boxes that are moved by half their size are then known far better than asked for.
TEST(SurfaceDeviation, OfBoxesTakesFewPieces) {
  const TriangleMesh box = make_box();
  const SurfaceDeviation moved = surface_deviation(box, test::moved(box, 1, {0.5, 0, 0}));
  EXPECT_LT(moved.pieces, 200U);
  EXPECT_LT(moved.percentile_error, 1e-5);
  EXPECT_NEAR(moved.percentiles[0], 0, moved.percentile_error);
  EXPECT_NEAR(moved.largest, 0.5, moved.percentile_error);
  // Random pairs of boxes that touch, cross or contain each other.
  Random random(7);
  for (int k = 0; k < 40; ++k) {
    const auto side = [&] { return 0.2 + 0.1 * std::floor(random.uniform(0, 12)); };
    const auto step = [&] { return 0.1 * std::floor(random.uniform(-8, 8)); };
    const TriangleMesh first = make_box({.size = {side(), side(), side()}});
    const TriangleMesh second = test::moved(make_box({.size = {side(), side(), side()}}), 1, {step(), step(), step()});
    for (const SignMode sign : {SignMode::none, SignMode::automatic}) {
      const SurfaceDeviation found = surface_deviation(first, second, {.sign = sign});
      expect_agreement(found, sampled(first, second, 60, sign), "boxes " + std::to_string(k));
      EXPECT_LT(found.pieces, 20'000U) << "the division must not run into its limit";
      EXPECT_LT(found.percentile_error, 0.01) << k;
    }
  }
}

/// A box turned about a random axis through its middle, then moved.
TriangleMesh turned_box(Random& random, const Vec3d& size, const Vec3d& offset) {
  const auto unit = [](const Vec3d& v) { return v / length(v); };
  const Vec3d x = unit(random.in_cube());
  const Vec3d y = unit(cross(x, random.in_cube()));
  const Vec3d z = cross(x, y);
  TriangleMesh out = make_box({.size = size});
  for (Vec3d& v : out.vertices) v = x * v.x + y * v.y + z * v.z + offset;
  return out;
}

/// Two boxes have few parts with one closest site, wherever they are, and the statistics of these parts are exact.
/// Borders between parts are curves in some pairs. These few pairs keep the error that is promised by default.
TEST(SurfaceDeviation, OfTurnedBoxesIsNearlyExact) {
  Random random(11);
  const auto size = [&] { return Vec3d{random.uniform(0.2, 2), random.uniform(0.2, 2), random.uniform(0.2, 2)}; };
  int near = 0;
  int nearly_exact = 0;
  for (int k = 0; k < 40; ++k) {
    const double reach = k % 4 == 0 ? 0.05 : k % 4 == 1 ? 3 : 0.7;
    // Named, since compilers evaluate arguments in any order.
    const Vec3d first_size = k % 4 == 2 ? Vec3d{3, 3, 3} : size();
    const TriangleMesh first = turned_box(random, first_size, {});
    const Vec3d second_size = size();
    const Vec3d offset = random.in_cube() * reach;
    const TriangleMesh second = turned_box(random, second_size, offset);
    const SurfaceDeviation found = surface_deviation(first, second);
    EXPECT_LT(found.pieces, 400U) << k;
    const double error = std::max({found.mean_error, found.rms_error, found.percentile_error});
    Box3 both = bounds(first);
    both.extend(bounds(second));
    const double asked = both.diagonal() / 2000;
    EXPECT_LE(found.mean_error, asked) << k;
    EXPECT_LE(found.rms_error, asked) << k;
    EXPECT_LE(found.percentile_error, 2 * asked) << k;
    if (k % 4 != 1) {
      ++near;
      nearly_exact += error < 2e-4 ? 1 : 0;
    }
    const Sampled reference = sampled(first, second, 60, SignMode::none);
    expect_agreement(found, reference, "turned " + std::to_string(k));
    // Means of samples are far closer than their bound.
    EXPECT_NEAR(found.mean, reference.mean, 1e-3 * (1 + reference.mean) + found.mean_error) << k;
    EXPECT_NEAR(found.rms, reference.rms, 1e-3 * (1 + reference.rms) + found.rms_error) << k;
    const SurfaceDeviation with_sign = surface_deviation(first, second, {.sign = SignMode::automatic});
    expect_agreement(with_sign, sampled(first, second, 30, SignMode::automatic), "signed " + std::to_string(k));
  }
  EXPECT_GE(nearly_exact, near * 9 / 10);
}

/// On this slope, the distance from the plane is evenly distributed from 0 to 1.
TEST(SurfaceDeviation, OfASlope) {
  const TriangleMesh slope{{{0, 0, 0}, {2, 0, 1}, {2, 3, 1}, {0, 3, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  const TriangleMesh plane{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  const SurfaceDeviation found = surface_deviation(slope, plane, {.max_error = 1e-4});
  EXPECT_LT(found.pieces, 1000U) << "straight values need few pieces";
  EXPECT_NEAR(found.area, 3 * std::sqrt(5.0), 1e-12);
  EXPECT_LE(std::abs(found.mean - 0.5), found.mean_error);
  EXPECT_LE(std::abs(found.rms - std::sqrt(1.0 / 3)), found.rms_error);
  EXPECT_LE(std::max({found.mean_error, found.rms_error, found.percentile_error}), 1e-4);
  for (std::size_t k = 0; k < found.percentiles.size(); ++k) {
    EXPECT_NEAR(found.percentiles[k], SurfaceDeviation::percents[k] / 100, found.percentile_error);
  }
  EXPECT_LE(1 - found.largest, found.percentile_error);
  EXPECT_LE(found.smallest, found.percentile_error);
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
  EXPECT_LT(fine.mean_error, 0.01);
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
    EXPECT_LT(found.mean_error, 2e-14);
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
