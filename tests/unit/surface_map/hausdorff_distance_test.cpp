// Proves that intervals of Hausdorff distances contain known values and those of dense sampling, for soups of every
// kind and at every scale. Witnesses are as far apart as stated. Results are the same for any number of threads.
#include "blum/surface_map/hausdorff_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/mesh_places.hpp"
#include "support/nasty_soup.hpp"
#include "surface_map/distance_bound.hpp"
#include "surface_map/facing_surface.hpp"

namespace blum {
namespace {

double slow_distance(const MeshView& mesh, std::uint32_t primitive, const Vec3d& point) {
  const auto [a, b, c] = primitive_vertices(mesh, primitive);
  return triangle_distance({point, point, point}, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}).distance;
}

/// Returns the distance of a point from a mesh, primitive by primitive.
double slow_distance(const MeshView& mesh, const Vec3d& point) {
  double best = HUGE_VAL;
  for (std::uint32_t p = 0; p < primitive_count(mesh); ++p) best = std::min(best, slow_distance(mesh, p, point));
  return best;
}

/// Evenly spread points of a triangle, and the largest distance of any of its points from them.
struct Spread {
  std::vector<Vec3d> points;
  double gap = 0;
};
Spread spread_over(const std::array<Vec3d, 3>& corners, int steps) {
  Spread out;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const double u = static_cast<double>(i) / steps;
      const double v = static_cast<double>(j) / steps;
      out.points.push_back(corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) out.gap = std::max(out.gap, length(corners[k] - corners[(k + 1) % 3]) / steps);
  return out;
}

/// An interval that contains the one-sided distance, by brute force.
struct SlowBounds {
  double lower = 0;
  double upper = 0;
};
SlowBounds slow_directed(const MeshView& mesh, const MeshView& other, int steps) {
  SlowBounds out;
  for (std::uint32_t p = 0; p < primitive_count(mesh); ++p) {
    const auto [a, b, c] = primitive_vertices(mesh, p);
    const Spread spread = spread_over({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, steps);
    for (const Vec3d& point : spread.points) {
      const double distance = slow_distance(other, point);
      out.lower = std::max(out.lower, distance);
      out.upper = std::max(out.upper, distance + spread.gap);
    }
  }
  return out;
}

void expect_witnesses(const DirectedHausdorff& found, const MeshView& mesh, const MeshView& other, double scale) {
  EXPECT_NEAR(length(found.points[0] - found.points[1]), found.lower, 1e-14 * scale);
  EXPECT_NEAR(slow_distance(other, found.points[0]), found.lower, 1e-14 * scale);
  EXPECT_LT(slow_distance(mesh, static_cast<std::uint32_t>(found.primitive), found.points[0]), 1e-13 * scale);
}

void expect_within_slow(const MeshView& mesh, const MeshView& other, double tolerance, int steps) {
  const DirectedHausdorff found = directed_hausdorff_distance(mesh, other, {.tolerance = tolerance});
  const SlowBounds slow = slow_directed(mesh, other, steps);
  EXPECT_LE(found.lower, slow.upper);
  EXPECT_GE(found.upper, slow.lower);
  EXPECT_LE(found.upper - found.lower, tolerance);
  Box3 box = bounds(mesh);
  box.extend(bounds(other));
  expect_witnesses(found, mesh, other, box.largest_coordinate());
}

TriangleMesh single(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {{a, b, c}, {{0, 1, 2}}, {}, {}};
}

TEST(HausdorffDistance, OfPointsSegmentsAndTriangles) {
  const TriangleMesh point{{{0, 0, 2}}, {}, {}, {0}};
  const TriangleMesh segment{{{-1, 0, 0}, {1, 0, 0}}, {}, {{0, 1}}, {}};
  const TriangleMesh triangle = single({-4, -4, -1}, {4, -4, -1}, {0, 4, -1});
  const HausdorffDistance a = hausdorff_distance(point, segment);
  EXPECT_NEAR(a.forward.lower, 2, 1e-13);
  EXPECT_NEAR(a.backward.lower, std::sqrt(5.0), 1e-13);
  EXPECT_NEAR(a.upper, std::sqrt(5.0), 1e-13);
  EXPECT_EQ(a.points[0], (Vec3d{0, 0, 2}));
  EXPECT_EQ(std::abs(a.points[1].x), 1);
  const HausdorffDistance b = hausdorff_distance(segment, triangle);
  EXPECT_NEAR(b.forward.lower, 1, 1e-13);
  EXPECT_NEAR(b.backward.lower, std::sqrt(9 + 16 + 1.0), 1e-13);
}

TEST(HausdorffDistance, OfBoxesInBoxes) {
  const TriangleMesh small = test::box_between({-1, -1, -1}, {1, 1, 1});
  const TriangleMesh large = test::box_between({-2, -2, -2}, {2, 2, 2});
  const HausdorffDistance found = hausdorff_distance(small, large, {.tolerance = 1e-6});
  EXPECT_LE(found.forward.lower, 1);
  EXPECT_GE(found.forward.upper, 1);
  EXPECT_LE(found.backward.lower, std::sqrt(3.0));
  EXPECT_GE(found.backward.upper, std::sqrt(3.0));
  EXPECT_LE(found.upper - found.lower, 1e-6);
}

/// The furthest point lies inside a triangle, away from all vertices.
TEST(HausdorffDistance, FindsTheMiddleOfATriangle) {
  const TriangleMesh plate = single({-3, -3, 0}, {3, -3, 0}, {0, 6, 0});
  TriangleMesh frame = plate;
  frame.triangles.clear();
  frame.segments = {{0, 1}, {1, 2}, {2, 0}};
  const DirectedHausdorff found = directed_hausdorff_distance(plate, frame, {.tolerance = 1e-9});
  // The radius of the inscribed circle: twice the area over the perimeter.
  const double radius = 54 / (6 + 2 * std::sqrt(90.0));
  EXPECT_LE(found.lower, radius + 1e-15);
  EXPECT_GE(found.upper, radius);
  EXPECT_LE(found.upper - found.lower, 1e-9);
}

TEST(HausdorffDistance, OfConcentricSpheresAndShiftedCopies) {
  const TriangleMesh sphere = make_sphere({.frequency = 12});
  const double radius = length(sphere.vertices[0]);
  const TriangleMesh larger = test::moved(sphere, 1.25);
  const DirectedHausdorff outwards = directed_hausdorff_distance(larger, sphere, {.tolerance = 1e-5});
  EXPECT_LE(outwards.lower, radius / 4 + 1e-14) << "a vertex of the larger one lies straight over one of the smaller";
  EXPECT_GE(outwards.upper, radius / 4);
  const Vec3d shift{0.3, -0.4, 0};
  const HausdorffDistance shifted = hausdorff_distance(sphere, test::moved(sphere, 1, shift), {.tolerance = 1e-4});
  EXPECT_LE(shifted.lower, 0.5) << "no point needs to go further than the shift";
  EXPECT_GE(shifted.upper, 0.49);
}

TEST(HausdorffDistance, IsZeroToItselfAndToFinerCopies) {
  const TriangleMesh mesh = make_organic({.frequency = 10});
  EXPECT_LT(hausdorff_distance(mesh, mesh).upper, 1e-14);
  const TriangleMesh finer = make_subdivided(mesh, 2);
  EXPECT_LT(hausdorff_distance(mesh, finer, {.tolerance = 1e-6}).upper, 1e-6 + 1e-14);
}

/// Most vertices coincide with vertices of the other mesh and need no search, in any order of vertices and triangles.
TEST(HausdorffDistance, OfCopiesWithAChangedPart) {
  const TriangleMesh mesh = make_sphere({.frequency = 24});
  TriangleMesh changed = mesh;
  std::reverse(changed.vertices.begin(), changed.vertices.end());
  for (Triangle& t : changed.triangles) {
    for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(mesh.vertices.size()) - 1 - v;
  }
  std::rotate(changed.triangles.begin(), changed.triangles.begin() + 777, changed.triangles.end());
  changed.vertices[100] *= 1.25;
  const double moved = length(changed.vertices[100]) / 5;
  const HausdorffDistance found = hausdorff_distance(changed, mesh, {.tolerance = 1e-6});
  EXPECT_LE(found.forward.lower, moved + 1e-14);
  EXPECT_GE(found.forward.upper, moved - 1e-14);
  EXPECT_LE(found.upper - found.lower, 1e-6);
  EXPECT_LT(found.forward.evaluations, mesh.vertices.size() / 4);
  expect_witnesses(found.forward, changed, mesh, 1.5);
  expect_witnesses(found.backward, mesh, changed, 1.5);
}

/// Coincident vertices that no triangle of the other mesh uses are not part of its surface.
TEST(HausdorffDistance, OfACopyWithUnusedVertices) {
  const TriangleMesh mesh = make_sphere({.frequency = 24});
  TriangleMesh half = mesh;
  std::erase_if(half.triangles, [&](const Triangle& t) { return half.vertices[t[0]].x > 0.9; });
  const double gap = directed_hausdorff_distance(mesh, half, {.tolerance = 1e-5}).upper;
  EXPECT_GT(gap, 0.2) << "the cap that was cut off";
  EXPECT_LT(directed_hausdorff_distance(half, mesh).upper, 1e-14);
}

TEST(HausdorffDistance, ContainsSampledDistancesOfSoups) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TriangleMesh a = test::awkward_soup(1 + random.below(12), 3 * seed);
    const TriangleMesh b = test::awkward_soup(1 + random.below(12), 3 * seed + 1);
    expect_within_slow(a, b, 1e-3, 24);
    expect_within_slow(test::nasty_soup(seed, 1 + random.below(8)), b, 1e-3, 24);
  }
}

TEST(HausdorffDistance, ContainsSampledDistancesOfNearCopies) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = make_sphere({.frequency = 2});
    expect_within_slow(make_noisy(mesh, 0.01, seed), mesh, 1e-4, 12);
    expect_within_slow(mesh, make_noisy(mesh, 0.1, seed), 1e-4, 12);
    expect_within_slow(test::moved(mesh, 1.01), mesh, 1e-4, 12);
    expect_within_slow(test::moved(mesh, 1, {0.02, 0.01, 0.03}), mesh, 1e-4, 12);
  }
}

TEST(HausdorffDistance, AtEveryScaleAndFarAway) {
  const TriangleMesh a = make_sphere({.frequency = 4});
  const TriangleMesh b = make_noisy(a, 0.05, 3);
  const HausdorffDistance here = hausdorff_distance(a, b, {.tolerance = 1e-4});
  for (const double scale : {1e-140, 1e-30, 1e30, 1e149}) {
    const HausdorffDistance there =
        hausdorff_distance(test::moved(a, scale), test::moved(b, scale), {.tolerance = 1e-4 * scale});
    EXPECT_LE(there.lower / scale, here.upper);
    EXPECT_GE(there.upper / scale, here.lower);
    EXPECT_LE((there.upper - there.lower) / scale, 1.0001e-4);
  }
  const Vec3d far{1e9, -1e9, 1e9};
  const HausdorffDistance there =
      hausdorff_distance(test::moved(a, 1, far), test::moved(b, 1, far), {.tolerance = 1e-2});
  EXPECT_LE(there.lower, here.upper + 1e-6) << "moving rounds coordinates by 1e-7";
  EXPECT_GE(there.upper, here.lower - 1e-6);
}

TEST(HausdorffDistance, IsTheSameForAnyThreads) {
  const TriangleMesh a = make_organic({.frequency = 12, .seed = 1});
  const TriangleMesh b = make_noisy(a, 0.003, 2);
  const HausdorffDistance one = hausdorff_distance(a, b, {.tolerance = 2e-5}, {.threads = 1});
  for (const int threads : {2, 7}) {
    const HausdorffDistance many = hausdorff_distance(a, b, {.tolerance = 2e-5}, {.threads = threads});
    EXPECT_EQ(one.lower, many.lower);
    EXPECT_EQ(one.upper, many.upper);
    EXPECT_EQ(one.points, many.points);
    EXPECT_EQ(one.forward.evaluations, many.forward.evaluations);
    EXPECT_EQ(one.backward.site, many.backward.site);
  }
}

TEST(HausdorffDistance, EndsAtTheLimitWithACertainInterval) {
  const TriangleMesh a = make_sphere({.frequency = 6});
  const TriangleMesh b = make_noisy(a, 0.05, 3);
  const DirectedHausdorff good = directed_hausdorff_distance(a, b, {.tolerance = 1e-4});
  const DirectedHausdorff early = directed_hausdorff_distance(a, b, {.tolerance = 1e-12, .max_points = 500});
  EXPECT_GT(early.upper - early.lower, 1e-12);
  EXPECT_LE(early.lower, good.upper);
  EXPECT_GE(early.upper, good.lower);
}

TEST(HausdorffDistance, RejectsInvalidInputAndCanBeCancelled) {
  const TriangleMesh mesh = make_box();
  EXPECT_THROW((void)hausdorff_distance(mesh, {}), InvalidMesh);
  EXPECT_THROW((void)hausdorff_distance(mesh, mesh, {.tolerance = 0}), InvalidOption);
  EXPECT_THROW((void)hausdorff_distance(mesh, mesh, {.tolerance = NAN}), InvalidOption);
  const TriangleMesh tiny = test::moved(make_sphere({.frequency = 4}), 1e-151);
  EXPECT_THROW((void)hausdorff_distance(mesh, tiny), InvalidMesh);
  EXPECT_THROW((void)directed_hausdorff_distance(tiny, mesh), InvalidMesh);
  const double corner = length(mesh.vertices[0]);
  const HausdorffDistance small = hausdorff_distance(mesh, test::moved(tiny, 1e12), {.tolerance = 1e-6});
  EXPECT_LE(small.lower, corner);
  EXPECT_GE(small.upper, corner);
  std::stop_source stop;
  stop.request_stop();
  Context context;
  context.cancel = stop.get_token();
  EXPECT_THROW((void)hausdorff_distance(mesh, mesh, {}, context), Cancelled);
}

/// The bound of a piece is at least the distance of each of its points, whatever surrounds the piece.
TEST(DistanceBound, IsAboveAllDistances) {
  std::size_t better_than_size = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const TriangleMesh other =
        seed % 2 == 0 ? make_noisy(make_sphere({.frequency = 4}), 0.1, seed) : test::awkward_soup(10, seed);
    const surface::FacingSurface facing(other, {});
    Random random(seed);
    for (int k = 0; k < 50; ++k) {
      const Vec3d middle = random.in_ball() * 1.2;
      const double size = std::pow(10.0, -random.uniform(0.0, 2.0));
      std::array<Vec3d, 3> corners;
      std::array<surface::FacingPoint, 3> points;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = middle + random.in_ball() * size;
        const std::optional<NearestSite> nearest = facing.hierarchy().nearest(corners[i]);
        points[i] = {corners[i], nearest->point, nearest->distance, nearest->site};
      }
      const double bound = surface::distance_bound({&points[0], &points[1], &points[2]}, facing, 0);
      double largest = 0;
      for (const Vec3d& p : spread_over(corners, 12).points) {
        largest = std::max(largest, facing.hierarchy().nearest(p)->distance);
      }
      EXPECT_GE(bound, largest * (1 - 1e-14));
      const double corner = std::max({points[0].distance, points[1].distance, points[2].distance});
      better_than_size += bound < corner + size / 10 ? 1 : 0;
    }
  }
  EXPECT_GT(better_than_size, 1000U) << "of 2000";
}

}  // namespace
}  // namespace blum
