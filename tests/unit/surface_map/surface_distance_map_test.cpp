// Proves that the texels of surface maps contain exact distances. Values read between texels are within the stated
// error, also after meshes move. Summaries equal those of the texels.
#include "blum/surface_map/surface_distance_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/points/sample_surface.hpp"
#include "blum/shapes/generators.hpp"
#include "support/map_reading.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::place_of;
using test::read_bilinear;
using test::read_nearest;

/// Errors at random points of the surface stay within the bounds, and some come near them.
void expect_errors(const SurfaceMap& map, const TriangleMesh& target, const TriangleMesh& other, SignMode sign,
                   std::size_t count) {
  const SurfaceSamples samples = sample_surface(target, count, {.seed = 7});
  const std::vector<ClosestPoint> exact = closest_points(other, samples.points, {sign, {}});
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t t = samples.triangles[k].value;
    const TexturePlace at = place_of(target, *map.atlas, t, samples.points[k]);
    ASSERT_LE(std::abs(read_nearest(map, at) - exact[k].distance), map.error[t]) << k;
    ASSERT_LE(std::abs(read_bilinear(map, at) - exact[k].distance), map.error[t]) << k;
  }
}

void expect_exact_texels(const SurfaceMap& map, const TriangleMesh& target, const TriangleMesh& other, SignMode sign) {
  const ClosestPointQuery query(other, {sign, {}});
  const SurfaceTexels all = surface_texels(target, *map.atlas);
  ASSERT_GT(all.texels.size(), target.triangles.size());
  for (std::size_t k = 0; k < all.texels.size(); k += 7) {
    const ClosestPoint found = query.nearest(all.points[k]);
    const std::uint32_t texel = all.texels[k];
    ASSERT_EQ(map.distance[texel], static_cast<float>(found.distance));
    ASSERT_EQ(map.site[texel], found.site);
    ASSERT_NEAR(map.vector[texel].x, found.point.x - all.points[k].x, 1e-6);
    ASSERT_NEAR(map.vector[texel].z, found.point.z - all.points[k].z, 1e-6);
  }
}

TEST(SurfaceDistanceMap, HoldsExactDistancesWithinItsErrors) {
  const TriangleMesh target = make_organic({.frequency = 8, .seed = 1});
  const TriangleMesh other = make_torus();
  for (const SignMode sign : {SignMode::none, SignMode::automatic}) {
    const SurfaceMap map = surface_distance_map(target, other, {.texel = 0.02, .sign = sign});
    expect_exact_texels(map, target, other, sign);
    expect_errors(map, target, other, sign, 20000);
    ASSERT_EQ(map.vertex_distance.size(), target.vertices.size());
    const std::vector<ClosestPoint> at_vertices = closest_points(other, target.vertices, {sign, {}});
    for (std::size_t v = 0; v < at_vertices.size(); ++v) EXPECT_EQ(map.vertex_distance[v], at_vertices[v].distance);
  }
}

TEST(SurfaceDistanceMap, HoldsForSoups) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    TriangleMesh target = make_soup({.triangles = 20, .awkward = 0.5, .seed = seed});
    const TriangleMesh other = test::awkward_soup(20, seed + 100);
    const SurfaceMap map = surface_distance_map(target, other, {.texel = 0.03});
    expect_errors(map, target, other, SignMode::none, 2000);
  }
}

/// If a triangle's area is pure rounding, its closest points to places beyond its border lie on its sides.
TEST(SurfaceDistanceMap, HoldsForNeedles) {
  Random random(1314);
  const auto next = [&] { return Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const Vec3d a = next();
    const Vec3d b = next();
    const TriangleMesh target{{a, b, a + (b - a) * random.uniform(0, 1)}, {{0, 1, 2}}, {}, {}};
    const TriangleMesh point{{next()}, {}, {}, {0}};
    const SurfaceMap map = surface_distance_map(target, point, {.texel = 0.05});
    const std::array<TexturePlace, 3>& at = map.atlas->corners[0];
    for (int k = 0; k <= 100; ++k) {
      // The place lies on the longest side.
      const double part = k / 100.0;
      const double exact = length(a + (b - a) * part - point.vertices[0]);
      const TexturePlace place{at[0].x + (at[1].x - at[0].x) * part, at[0].y + (at[1].y - at[0].y) * part};
      ASSERT_LE(std::abs(read_nearest(map, place) - exact), map.error[0]) << k;
      ASSERT_LE(std::abs(read_bilinear(map, place) - exact), map.error[0]) << k;
    }
  }
}

/// The errors include rounding to float32 and the rounding of points.
TEST(SurfaceDistanceMap, CountsRoundingAsError) {
  for (const double scale : {1e-140, 1e-44, 1e-30, 1.0, 1e30, 1e37, 1e39, 1e140}) {
    SCOPED_TRACE(scale);
    TriangleMesh target{{{0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}}, {{0, 1, 2}}, {}, {}};
    TriangleMesh point{{{0.3, 0.1, 0.7}}, {}, {}, {0}};
    for (Vec3d& v : target.vertices) v *= scale;
    point.vertices[0] *= scale;
    const SurfaceMap map = surface_distance_map(target, point, {.texel = 1e-10 * scale});
    expect_errors(map, target, point, SignMode::none, 100);
  }
  // The triangle is small and far from the origin, so the closest points of places beyond its border are rounded.
  const Vec3d far{288323, 1e5, -4e4};
  const TriangleMesh target{{far, far + Vec3d{3e-10, 0, 0}, far + Vec3d{0, 3e-10, 0}}, {{0, 1, 2}}, {}, {}};
  const TriangleMesh point{{far + Vec3d{1, 1, 1}}, {}, {}, {0}};
  const SurfaceMap map = surface_distance_map(target, point, {.texel = 1e-13});
  EXPECT_GT(map.error[0], 1e-10F);
  // If part of a triangle is further than `max_distance`, the rounding of the rest still counts.
  const TriangleMesh long_way{{{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}}, {{0, 1, 2}}, {}, {}};
  const TriangleMesh distant{{{1e6, 0, 0}}, {}, {}, {0}};
  const SurfaceMap limited = surface_distance_map(long_way, distant, {.texel = 1e-4, .max_distance = 1e6 - 5e-4});
  EXPECT_TRUE(std::isinf(limited.faces[0].largest));
  EXPECT_GT(limited.error[0], 0.03F);
}

/// For open meshes, signs by winding numbers may change at distances other than 0.
TEST(SurfaceDistanceMap, KnowsThatSignsMayJump) {
  TriangleMesh bowl = make_sphere();
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return bowl.vertices[t[0]].z + bowl.vertices[t[1]].z + bowl.vertices[t[2]].z > 0;
  });
  const TriangleMesh post{{{0, 0, -0.5}, {0.1, 0, 0.7}, {0, 0.1, 0.7}}, {{0, 1, 2}}, {}, {}};
  for (const SignMode sign : {SignMode::none, SignMode::automatic, SignMode::winding}) {
    expect_errors(surface_distance_map(post, bowl, {.texel = 0.01, .sign = sign}), post, bowl, sign, 3000);
  }
  EXPECT_TRUE(ClosestPointQuery(bowl).sign_may_jump());
  EXPECT_FALSE(ClosestPointQuery(bowl, {SignMode::none, {}}).sign_may_jump());
  EXPECT_FALSE(ClosestPointQuery(make_sphere()).sign_may_jump());
}

TEST(SurfaceDistanceMap, FollowsMeshesThatMove) {
  TriangleMesh target = make_organic({.frequency = 6, .seed = 1});
  TriangleMesh other = make_sphere({.frequency = 6});
  SurfaceMapper mapper(target, other, {.texel = 0.03});
  const std::shared_ptr<const SurfaceAtlas> atlas = mapper.map().atlas;
  for (int frame = 0; frame < 4; ++frame) {
    target = make_noisy(target, 0.02, static_cast<std::uint64_t>(frame));
    other = make_noisy(other, 0.05, static_cast<std::uint64_t>(frame));
    mapper.move_target(target.vertices);
    mapper.move_other(other.vertices);
    const SurfaceMap map = mapper.map();
    EXPECT_EQ(map.atlas, atlas);
    expect_exact_texels(map, target, other, SignMode::none);
    expect_errors(map, target, other, SignMode::none, 3000);
  }
  other = make_torus();
  mapper.replace_other(other);
  expect_exact_texels(mapper.map(), target, other, SignMode::none);
  EXPECT_THROW(mapper.move_target(other.vertices), InvalidMesh);
}

/// Triangles without texels have empty summaries, wherever they are in the order. Charts whose area is lost to rounding
/// have no texels.
TEST(SurfaceDistanceMap, ReportsTrianglesWithoutTexels) {
  const TriangleMesh target{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}}, {{0, 1, 2}, {3, 4, 5}}, {}, {}};
  const TriangleMesh other{{{0, 0, 3}}, {}, {}, {0}};
  const double lost = 1e-155;
  const std::vector<TexturePlace> uv{{1, 1}, {8, 1}, {1, 8}, {9, 9}, {9 + lost, 9}, {0, 0}, {lost, 0}, {0, lost}};
  for (const Triangle& none : {Triangle{3, 3, 3}, Triangle{5, 6, 7}}) {
    for (const bool is_first : {false, true}) {
      const std::vector<Triangle> corners =
          is_first ? std::vector<Triangle>{none, {0, 1, 2}} : std::vector<Triangle>{{0, 1, 2}, none};
      const SurfaceMap map = SurfaceMapper(target, surface_atlas_from(target, uv, corners, 16, 16), other).map();
      const SurfaceMap::FaceSummary& empty = map.faces[is_first ? 0 : 1];
      EXPECT_TRUE(std::isnan(empty.smallest) && std::isnan(empty.largest) && std::isnan(empty.mean));
      EXPECT_FALSE(std::isnan(map.faces[is_first ? 1 : 0].mean));
    }
  }
}

TEST(SurfaceDistanceMap, SumsUpTriangles) {
  const TriangleMesh target = make_organic({.frequency = 5});
  const SurfaceMap map = surface_distance_map(target, make_torus(), {.texel = 0.05});
  std::vector<float> smallest(target.triangles.size(), HUGE_VALF);
  std::vector<float> largest(target.triangles.size(), -HUGE_VALF);
  std::vector<double> sum(target.triangles.size(), 0);
  std::vector<double> count(target.triangles.size(), 0);
  for (std::size_t k = 0; k < map.distance.size(); ++k) {
    const TriangleId t = map.atlas->triangle[k];
    EXPECT_EQ(std::isnan(map.distance[k]), !t.has_value());
    if (!t.has_value()) continue;
    smallest[t.value] = std::min(smallest[t.value], map.distance[k]);
    largest[t.value] = std::max(largest[t.value], map.distance[k]);
    sum[t.value] += map.distance[k];
    count[t.value] += 1;
  }
  for (std::size_t t = 0; t < smallest.size(); ++t) {
    EXPECT_EQ(map.faces[t].smallest, smallest[t]);
    EXPECT_EQ(map.faces[t].largest, largest[t]);
    EXPECT_NEAR(map.faces[t].mean, sum[t] / count[t], 1e-6);
  }
}

TEST(SurfaceDistanceMap, FindsTheClosestTexelAndTexelsWithinADistance) {
  const TriangleMesh target = make_organic({.frequency = 5});
  const SurfaceMap map = surface_distance_map(target, make_torus(), {.texel = 0.05, .max_distance = 0.3});
  const std::size_t closest = map.closest_texel().value();
  const std::vector<std::uint32_t> within = map.texels_within(0.2);
  std::size_t next = 0;
  for (std::uint32_t k = 0; k < map.distance.size(); ++k) {
    EXPECT_FALSE(map.distance[k] < map.distance[closest]);
    EXPECT_EQ(map.site[k].has_value(), map.distance[k] <= 0.3F);
    if (map.distance[k] <= 0.2F) {
      ASSERT_LT(next, within.size());
      EXPECT_EQ(within[next++], k);
    }
  }
  EXPECT_EQ(next, within.size());
  EXPECT_FALSE(surface_distance_map(target, test::moved(make_torus(), 1, {9, 0, 0}), {.max_distance = 1})
                   .closest_texel()
                   .has_value());
}

TEST(SurfaceDistanceMap, WarnsWhereNothingIsClose) {
  const TriangleMesh box = test::box_between({0, 0, 0}, {1, 1, 1});
  const std::vector<Warning> nothing{{WarningCode::nothing_found, "nothing lies within the distance of any texel"}};
  const TriangleMesh distant = test::moved(box, 1, {3, 0, 0});
  EXPECT_EQ(surface_distance_map(box, distant, {.texel = 0.5, .max_distance = 1}).warnings, nothing);
  EXPECT_TRUE(surface_distance_map(box, distant, {.texel = 0.5, .max_distance = 3}).warnings.empty());
  EXPECT_EQ(self_distance_map(box, {.texel = 0.5, .max_distance = 0}).warnings, nothing);
  EXPECT_TRUE(self_distance_map(box, {.texel = 0.5}).warnings.empty());
}

TEST(SelfDistanceMap, LeavesOutNeighbours) {
  const TriangleMesh target = make_organic({.frequency = 5});
  const SurfaceMap map = self_distance_map(target, {.texel = 0.05});
  const SiteTable sites(target);
  const SurfaceTexels all = surface_texels(target, *map.atlas);
  for (std::size_t k = 0; k < all.texels.size(); k += 5) {
    const TriangleId own = map.atlas->triangle[all.texels[k]];
    TriangleMesh others = target;
    std::erase_if(others.triangles, [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
        const Triangle& of = target.triangles[own.value];
        return std::find(of.begin(), of.end(), v) != of.end();
      });
    });
    const SiteTable table(others);
    const std::optional<NearestSite> slow = Bvh(others, table).nearest(all.points[k]);
    ASSERT_EQ(map.distance[all.texels[k]], static_cast<float>(slow->distance));
  }
}

TEST(SurfaceDistanceMap, IsTheSameForAnyThreads) {
  const TriangleMesh target = make_organic({.frequency = 8});
  const TriangleMesh other = make_torus();
  const SurfaceMap one = surface_distance_map(target, other, {.texel = 0.02}, {.threads = 1});
  const SurfaceMap many = surface_distance_map(target, other, {.texel = 0.02}, {.threads = 7});
  const SurfaceMap self_one = self_distance_map(target, {.texel = 0.02}, {.threads = 1});
  const SurfaceMap self_many = self_distance_map(target, {.texel = 0.02}, {.threads = 7});
  for (std::size_t k = 0; k < one.distance.size(); ++k) {
    ASSERT_EQ(one.site[k], many.site[k]);
    ASSERT_EQ(self_one.site[k], self_many.site[k]);
    if (!one.site[k].has_value()) continue;
    ASSERT_EQ(one.distance[k], many.distance[k]);
    ASSERT_EQ(self_one.distance[k], self_many.distance[k]);
  }
  EXPECT_EQ(one.error, many.error);
}

TEST(SurfaceDistanceMap, RejectsInvalidInput) {
  const TriangleMesh box = make_box();
  EXPECT_THROW((void)surface_distance_map(box, box, {.texel = -1}), InvalidOption);
  EXPECT_THROW((void)surface_distance_map(box, box, {.max_distance = -1}), InvalidOption);
  EXPECT_THROW((void)surface_distance_map(box, {}), InvalidMesh);
  EXPECT_THROW((void)surface_distance_map(make_points({.points = 4}), box), InvalidMesh);
  EXPECT_THROW((void)SurfaceMapper(make_torus(), surface_atlas(box, 0.5), box), InvalidMesh);
}

}  // namespace
}  // namespace blum
