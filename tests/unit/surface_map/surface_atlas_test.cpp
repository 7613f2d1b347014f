// Proves that an atlas gives each triangle the texels that reads within it use, and reverses no triangle. The points
// that represent texels are as close as stated.
#include "blum/surface_map/surface_atlas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"
#include "support/nasty_soup.hpp"

namespace blum {
namespace {

double twice_area(const std::array<TexturePlace, 3>& c) {
  return (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
}

/// A random point of a triangle, and its place in the texture.
struct Probe {
  Vec3d point;
  TexturePlace place;
};
Probe probe(const MeshView& mesh, const SurfaceAtlas& atlas, std::uint32_t t, Random& random) {
  double u = random.uniform();
  double v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  if (random.below(8) == 0) u = 0;  // on a side
  const auto [a, b, c] = triangle_corners(mesh, t);
  const auto& [pa, pb, pc] = atlas.corners[t];
  const double w = 1 - u - v;
  return {a * w + b * u + c * v, {pa.x * w + pb.x * u + pc.x * v, pa.y * w + pb.y * u + pc.y * v}};
}

/// A texel that a bilinear read uses, with its weight.
struct Reading {
  std::size_t texel = 0;
  double weight = 0;
};
std::vector<Reading> bilinear(const SurfaceAtlas& atlas, const TexturePlace& at) {
  std::vector<Reading> out;
  const double x = std::floor(at.x - 0.5);
  const double y = std::floor(at.y - 0.5);
  for (const double i : {x, x + 1}) {
    for (const double j : {y, y + 1}) {
      const double weight = (1 - std::abs(at.x - 0.5 - i)) * (1 - std::abs(at.y - 0.5 - j));
      if (!(weight > 1e-12)) continue;
      const double column = std::clamp(i, 0.0, atlas.width - 1.0);
      const double row = std::clamp(j, 0.0, atlas.height - 1.0);
      out.push_back({static_cast<std::size_t>(row * atlas.width + column), weight});
    }
  }
  return out;
}

void expect_reaches(const MeshView& mesh, const SurfaceAtlas& atlas, std::uint64_t seed) {
  const std::vector<double> reaches = texel_reaches(mesh, atlas);
  const SurfaceTexels all = surface_texels(mesh, atlas);
  std::vector<Vec3d> points(atlas.size());
  for (std::size_t k = 0; k < all.texels.size(); ++k) points[all.texels[k]] = all.points[k];
  const double rounding = 1e-14 * bounds(mesh).largest_coordinate();
  Random random(seed);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (std::isinf(reaches[t])) continue;
    for (int k = 0; k < 20; ++k) {
      const Probe at = probe(mesh, atlas, t, random);
      double mean = 0;
      for (const Reading& one : bilinear(atlas, at.place)) {
        ASSERT_TRUE(atlas.triangle[one.texel].has_value());
        if (atlas.is_separate) {
          ASSERT_EQ(atlas.triangle[one.texel].value, t);
        }
        mean += one.weight * length(at.point - points[one.texel]);
      }
      EXPECT_LE(mean, reaches[t] + rounding);
      const auto nearest = static_cast<std::size_t>(std::floor(at.place.y)) * atlas.width +
                           static_cast<std::size_t>(std::floor(at.place.x));
      EXPECT_LE(length(at.point - points[nearest]), reaches[t] + rounding);
    }
  }
}

void expect_sound(const MeshView& mesh, const SurfaceAtlas& atlas, double texel) {
  ASSERT_EQ(atlas.corners.size(), mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<TexturePlace, 3>& places = atlas.corners[t];
    EXPECT_GT(twice_area(places), 0.9) << "turned over, or nothing";
    for (const TexturePlace& at : places) {
      EXPECT_TRUE(at.x > 0 && at.y > 0 && at.x < atlas.width && at.y < atlas.height);
    }
    const std::array<Vec3d, 3> p = triangle_corners(mesh, t);
    std::array<double, 3> steps{};
    for (std::size_t k = 0; k < 3; ++k) {
      const TexturePlace& a = places[k];
      const TexturePlace& b = places[(k + 1) % 3];
      steps[k] = length(p[k] - p[(k + 1) % 3]) / std::hypot(a.x - b.x, a.y - b.y);
    }
    std::sort(steps.begin(), steps.end());
    EXPECT_LE(steps[1], texel * std::sqrt(2.0) + 1e-300);
  }
  expect_reaches(mesh, atlas, 1);
}

TEST(SurfaceAtlas, GivesEachTriangleItsTexels) {
  for (const double texel : {0.01, 0.07, 0.5, 100.0}) {
    SCOPED_TRACE(texel);
    const TriangleMesh organic = make_organic({.frequency = 6});
    expect_sound(organic, surface_atlas(organic, texel), texel);
    const TriangleMesh box = test::box_between({0, 0, 0}, {1, 0.3, 0.02});
    expect_sound(box, surface_atlas(box, texel), texel);
    const TriangleMesh soup = test::nasty_soup(5, 70);
    expect_sound(soup, surface_atlas(soup, texel), texel);
  }
}

TEST(SurfaceAtlas, HasAboutAsManyTexelsAsAreAskedFor) {
  const TriangleMesh mesh = make_organic({.frequency = 12});
  for (const std::size_t texels : {50'000U, 300'000U, 2'000'000U}) {
    const SurfaceAtlas atlas = surface_atlas_of_size(mesh, texels);
    EXPECT_GT(static_cast<double>(atlas.size()), 0.8 * static_cast<double>(texels));
    EXPECT_LT(static_cast<double>(atlas.size()), 1.2 * static_cast<double>(texels));
    const SurfaceTexels used = surface_texels(mesh, atlas);
    EXPECT_GT(static_cast<double>(used.texels.size()), 0.6 * static_cast<double>(atlas.size())) << "much is empty";
  }
  EXPECT_GE(surface_atlas_of_size(mesh, 0).size(), mesh.triangles.size()) << "some for each triangle";
}

TEST(SurfaceAtlas, IsTheSameForAnyThreads) {
  const TriangleMesh mesh = make_organic({.frequency = 8});
  const SurfaceAtlas one = surface_atlas(mesh, 0.02, {.threads = 1});
  const SurfaceAtlas many = surface_atlas(mesh, 0.02, {.threads = 7});
  EXPECT_EQ(one.corners, many.corners);
  EXPECT_TRUE(std::equal(one.triangle.begin(), one.triangle.end(), many.triangle.begin(), many.triangle.end()));
}

TEST(SurfaceAtlas, HoldsAtEveryScale) {
  for (const double scale : {1e-140, 1e140}) {
    const TriangleMesh mesh = test::moved(make_organic({.frequency = 4}), scale);
    expect_sound(mesh, surface_atlas(mesh, 0.05 * scale), 0.05 * scale);
  }
}

/// The sides of a box, unfolded into a strip: neighbours share texture coordinates.
TEST(SurfaceAtlas, TakesGivenTextureCoordinates) {
  TriangleMesh mesh;
  std::vector<TexturePlace> places;
  constexpr std::array<double, 5> x{0, 1, 1, 0, 0};
  constexpr std::array<double, 5> y{0, 0, 1, 1, 0};
  for (std::size_t k = 0; k < 5; ++k) {
    for (const double z : {0.0, 1.0}) {
      mesh.vertices.push_back({x[k], y[k], z});
      places.push_back({2 + 8.3 * static_cast<double>(k), 3 + 20 * z});
    }
    const auto first = static_cast<std::uint32_t>(2 * k);
    if (k < 4) mesh.triangles.push_back({first, first + 2, first + 3});
    if (k < 4) mesh.triangles.push_back({first, first + 3, first + 1});
  }
  const SurfaceAtlas atlas = surface_atlas_from(mesh, places, mesh.triangles, 40, 30);
  EXPECT_FALSE(atlas.is_separate);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) EXPECT_EQ(atlas.corners[t][0], places[mesh.triangles[t][0]]);
  expect_reaches(mesh, atlas, 2);
  for (const double reach : texel_reaches(mesh, atlas)) EXPECT_LT(reach, 0.5);
}

TEST(SurfaceAtlas, RejectsInvalidInput) {
  const TriangleMesh box = make_box();
  EXPECT_THROW((void)surface_atlas(box, 0), InvalidOption);
  EXPECT_THROW((void)surface_atlas(box, NAN), InvalidOption);
  EXPECT_THROW((void)surface_atlas(make_points({.points = 3}), 1), InvalidMesh);
  try {
    (void)surface_atlas(box, 1e-6);
    FAIL() << "a texture of 10^12 texels";
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("16384"), std::string::npos);
  }
  const std::vector<TexturePlace> places{{0, 0}, {8, 0}, {0, 8}, {8, 8}};
  TriangleMesh two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}, {}, {}};
  EXPECT_NO_THROW((void)surface_atlas_from(two, places, std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}, 8, 8));
  EXPECT_THROW((void)surface_atlas_from(two, places, std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}, 8, 8), InvalidOption)
      << "they overlap";
  EXPECT_THROW((void)surface_atlas_from(two, places, std::vector<Triangle>{{0, 1, 2}, {1, 4, 2}}, 8, 8), InvalidOption);
  EXPECT_THROW((void)surface_atlas_from(two, places, std::vector<Triangle>{{0, 1, 2}}, 8, 8), InvalidOption);
  EXPECT_THROW((void)surface_atlas_from(two, places, std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}, 7, 8), InvalidOption)
      << "outside";
  EXPECT_THROW((void)surface_texels(box, surface_atlas(two, 0.5)), InvalidMesh);
}

}  // namespace
}  // namespace blum
