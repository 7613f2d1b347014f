// Proves that every query of the bounding-volume hierarchy agrees with a search over all sites or primitives. Queries
// are the closest site, the k closest primitives, primitives within a distance and crossings of rays. A refitted tree
// answers like a new one.
#include "blum/geometry/bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "blum/core/random.hpp"
#include "blum/field/reference.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// Compares distance, site and point with brute force. The tolerance refers to the extent of mesh and query.
void expect_same_as_brute_force(const MeshView& mesh, const std::vector<Vec3d>& places) {
  const reference::BruteForce expected(mesh);
  const Bvh bvh(mesh, expected.sites());
  const Box3 box = bounds(mesh);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3d& q = places[i];
    const std::optional<NearestSite> found = bvh.nearest(q);
    ASSERT_TRUE(found) << i;
    const reference::Nearest truth = expected.nearest(q);
    Box3 both = box;
    both.extend(q);
    const double corner = std::max(length(both.lower), length(both.upper));
    const double tolerance = 1e-12 * both.diagonal() + 4e-16 * corner;
    EXPECT_NEAR(found->distance, truth.distance, tolerance) << i;
    EXPECT_NEAR(expected.site_distance(found->site, q), truth.distance, tolerance) << i;
    EXPECT_NEAR(length(q - found->point), found->distance, tolerance) << i;
  }
}

TEST(Bvh, AgreesWithBruteForceOnAwkwardSoups) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TriangleMesh mesh = test::awkward_soup(seed * 25, seed);
    expect_same_as_brute_force(mesh, test::places_around(mesh, 120, seed));
  }
}

TEST(Bvh, AgreesAtEveryScaleAndOffset) {
  const TriangleMesh mesh = test::awkward_soup(100, 5);
  for (const double scale : {1e-60, 1e-9, 1e9, 1e60}) {
    const TriangleMesh scaled = test::moved(mesh, scale);
    expect_same_as_brute_force(scaled, test::places_around(scaled, 80, 3));
  }
  const TriangleMesh far = test::moved(mesh, 1, {1e6, -1e6, 2e6});
  expect_same_as_brute_force(far, test::places_around(far, 80, 4));
}

TEST(Bvh, FindsTheSmallestSiteOfExactTies) {
  // The middle of a cube is as far from all six sides. Points beyond a corner are closest to its vertex.
  const TriangleMesh cube = make_box({});
  const reference::BruteForce expected(cube);
  const Bvh bvh(cube, expected.sites());
  const Vec3d middle = bounds(cube).center();
  EXPECT_EQ(bvh.nearest(middle)->site, expected.nearest(middle).site);
  for (std::uint32_t v = 0; v < cube.vertices.size(); ++v) {
    EXPECT_EQ(bvh.nearest(middle + (cube.vertices[v] - middle) * 1.5)->site, SiteId(v));
    EXPECT_EQ(bvh.nearest(cube.vertices[v])->distance, 0);
  }
}

/// The mesh lies 10^5 of its sizes from the origin. Closest points round by more than the differences of distances.
TEST(Bvh, FindsTheSmallestSiteOfTiesFarAway) {
  TriangleMesh mesh;
  mesh.vertices = {{0x1.14db1b80d91fcp+16, 0x1.caa6598981641p+15, 0x1.851c8bea48491p+16},
                   {0x1.14da521bd8723p+16, 0x1.caa72e2699b29p+15, 0x1.851cf9dbe8951p+16},
                   {0x1.14db2d357c94dp+16, 0x1.caa69f7341026p+15, 0x1.851d2ae3be74dp+16},
                   {0x1.14da521bd8723p+16, 0x1.caa72e2699b29p+15, 0x1.851cf9dbe8951p+16},
                   {0x1.14db1b80d91fcp+16, 0x1.caa6598981641p+15, 0x1.851c8bea48491p+16},
                   {0x1.14db0c102e315p+16, 0x1.caa7c25062068p+15, 0x1.851d7918b4b38p+16}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Bvh bvh(mesh, SiteTable(mesh));
  const Vec3d query{0x1.14dabfd64d9d8p+16, 0x1.caa5cfbe43ad1p+15, 0x1.851c52e41f1bcp+16};
  const std::vector<NearestPrimitive> both = bvh.nearest_primitives(query, 2);
  ASSERT_EQ(both[0].distance, both[1].distance);
  EXPECT_EQ(bvh.nearest(query)->site, std::min(both[0].site, both[1].site));
}

TEST(Bvh, FindsTheFirstOfCopies) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {2, 0, 1}, {1, 0, 2}};
  const SiteTable sites(mesh);
  const Bvh bvh(mesh, sites);
  EXPECT_EQ(bvh.nearest({0.2, 0.3, 0.7})->site, sites.id({SiteKind::face, 0}));
  EXPECT_EQ(bvh.nearest({0.4, -0.3, 0.7})->site, sites.id({SiteKind::edge, 0}));
}

TEST(Bvh, SeesNothingBeyondTheLargestDistance) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}};
  mesh.points = {0};
  const Bvh bvh(mesh, SiteTable(mesh));
  EXPECT_FALSE(bvh.nearest({1, 2, 5}, 1.999));
  EXPECT_TRUE(bvh.nearest({1, 2, 5}, 2));
  EXPECT_TRUE(bvh.nearest({1, 2, 3}, 0));
  EXPECT_FALSE(bvh.nearest({NAN, 2, 3}));
  EXPECT_FALSE(bvh.nearest({HUGE_VAL, 2, 3}));
}

TEST(Bvh, RecognizesBoxesWithoutSurface) {
  const TriangleMesh sphere = make_sphere({.frequency = 8});
  const Bvh bvh(sphere, SiteTable(sphere));
  EXPECT_FALSE(bvh.may_touch({{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}));
  EXPECT_FALSE(bvh.may_touch({{2, 2, 2}, {3, 3, 3}}));
  EXPECT_TRUE(bvh.may_touch({{-0.1, -0.1, 0.5}, {0.1, 0.1, 1.5}}));
  EXPECT_FALSE(bvh.may_touch(Box3{}));
}

TEST(Bvh, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh mesh = make_organic({.frequency = 20});
  const SiteTable sites(mesh);
  const Bvh one(mesh, sites, {.threads = 1});
  const Bvh four(mesh, sites, {.threads = 4});
  for (const Vec3d& q : test::places_around(mesh, 500, 1)) {
    EXPECT_EQ(one.nearest(q)->distance, four.nearest(q)->distance);
    EXPECT_EQ(one.nearest(q)->site, four.nearest(q)->site);
  }
}

/// The closest point of each primitive, each from a tree of this primitive alone.
std::vector<NearestPrimitive> each_alone(const MeshView& mesh, const Vec3d& q) {
  std::vector<NearestPrimitive> out;
  const SiteTable sites(mesh);
  const auto add = [&](const MeshView& one) {
    const std::optional<NearestSite> found = Bvh(one, SiteTable(one)).nearest(q);
    out.push_back({found->point, found->distance, {}, static_cast<std::uint32_t>(out.size())});
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) add({mesh.vertices, mesh.triangles.subspan(i, 1), {}, {}});
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) add({mesh.vertices, {}, mesh.segments.subspan(i, 1), {}});
  for (std::size_t i = 0; i < mesh.points.size(); ++i) add({mesh.vertices, {}, {}, mesh.points.subspan(i, 1)});
  std::sort(out.begin(), out.end(), [](const NearestPrimitive& a, const NearestPrimitive& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.primitive < b.primitive);
  });
  return out;
}

TEST(Bvh, FindsTheKClosestPrimitivesAndThoseWithinADistance) {
  const TriangleMesh mesh = test::awkward_soup(60, 9);
  const reference::BruteForce truth(mesh);
  const Bvh bvh(mesh, truth.sites());
  const double tolerance = 1e-12 * bounds(mesh).diagonal();
  EXPECT_EQ(bvh.size(), mesh.triangles.size() + mesh.segments.size() + mesh.points.size());
  for (const Vec3d& q : test::places_around(mesh, 60, 10)) {
    const std::vector<NearestPrimitive> all = each_alone(mesh, q);
    const std::vector<NearestPrimitive> found = bvh.nearest_primitives(q, 11);
    ASSERT_EQ(found.size(), 11U);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double slack = tolerance + 1e-12 * all[i].distance;
      EXPECT_NEAR(found[i].distance, all[i].distance, slack);
      EXPECT_NEAR(length(q - found[i].point), found[i].distance, slack);
      EXPECT_NEAR(truth.site_distance(found[i].site, q), found[i].distance, slack);
      if (i > 0) {
        EXPECT_LE(found[i - 1].distance, found[i].distance);
      }
    }
    EXPECT_EQ(found.front().distance, bvh.nearest(q)->distance);
    EXPECT_EQ(bvh.nearest_primitives(q, 1000).size(), bvh.size());
    EXPECT_TRUE(bvh.nearest_primitives(q, 0).empty());
    const double reach = found[6].distance;
    const std::vector<NearestPrimitive> within = bvh.within(q, reach);
    ASSERT_GE(within.size(), 7U);
    for (std::size_t i = 0; i < std::min<std::size_t>(within.size(), 11); ++i) {
      EXPECT_EQ(within[i].primitive, found[i].primitive);
      EXPECT_EQ(within[i].distance, found[i].distance);
    }
    EXPECT_EQ(bvh.nearest_primitives(q, 1000, reach).size(), within.size());
    std::size_t beyond = 0;
    for (const NearestPrimitive& p : all) beyond += p.distance > reach * (1 + 1e-9) ? 1 : 0;
    EXPECT_LE(within.size(), all.size() - beyond);
    EXPECT_TRUE(bvh.within(q, -1).empty());
  }
  int calls = 0;
  bvh.for_each_within({}, 1e9, [&](const NearestPrimitive&) { return ++calls < 5; });
  EXPECT_EQ(calls, 5);
}

/// A triangle with a corner at one place and two corners at a part of the way to the next two places.
std::array<Vec3d, 3> triangle_at(const std::vector<Vec3d>& places, std::size_t i, double part) {
  return {places[i], places[i] + (places[i + 1] - places[i]) * part, places[i] + (places[i + 2] - places[i]) * part};
}

/// The visited triangles in ascending order. @param go  calls its argument for triangles.
template <class Go>
std::vector<std::uint32_t> visited(const Go& go) {
  std::vector<std::uint32_t> found;
  go([&](TriangleId t) {
    found.push_back(t.value);
    return true;
  });
  std::sort(found.begin(), found.end());
  return found;
}

TEST(Bvh, TrianglesNearAnotherIncludeAllContactsAndFewMore) {
  for (const double scale : {1.0, 1e-40, 1e40}) {
    const TriangleMesh mesh = test::moved(test::awkward_soup(300, 33), scale);
    const Bvh bvh(mesh, SiteTable(mesh));
    const std::vector<Vec3d> places = test::places_around(mesh, 300, 34);
    std::size_t met = 0;
    std::size_t told = 0;
    for (std::size_t i = 0; i + 2 < places.size(); ++i) {
      const double size = i % 3 == 0 ? 0.01 : 1;
      const std::array<Vec3d, 3> own = triangle_at(places, i, size);
      const auto near = visited([&](const auto& visit) { bvh.for_each_near(own, visit); });
      EXPECT_EQ(std::adjacent_find(near.begin(), near.end()), near.end());
      told += near.size();
      constexpr std::array<std::uint32_t, 3> others{~0U, ~0U - 1, ~0U - 2};
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& corners = mesh.triangles[t];
        const std::array<Vec3d, 3> wall{mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                                        mesh.vertices[corners[2]]};
        if (detail::has_no_area(wall) || detail::has_no_area(own)) continue;
        if (detail::contact({own, others}, {wall, corners}) == detail::Contact::none) continue;
        ++met;
        EXPECT_TRUE(std::binary_search(near.begin(), near.end(), t));
      }
    }
    EXPECT_GT(met, 100U);
    EXPECT_LT(told, 3 * met);
  }
}

TEST(Bvh, RayCrossingsAgreeWithEachTriangleAlone) {
  for (const double scale : {1.0, 1e-40, 1e40}) {
    const TriangleMesh mesh = test::moved(test::awkward_soup(200, 31), scale);
    const Bvh bvh(mesh, SiteTable(mesh));
    const std::vector<Vec3d> places = test::places_around(mesh, 300, 32);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2) {
      const Ray ray{places[i], (places[i + 1] - places[i]) * (i % 4 == 0 ? 1e-3 : 1)};
      std::vector<std::uint32_t> expected;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const auto alone = detail::crossing(ray, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
        if (alone) expected.push_back(t);
      }
      const std::vector<RayCrossing> found = bvh.crossings(ray);
      std::vector<std::uint32_t> triangles;
      for (const RayCrossing& hit : found) {
        triangles.push_back(hit.triangle.value);
        const auto& [a, b, c] = mesh.triangles[hit.triangle.value];
        const auto alone = detail::crossing(ray, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
        ASSERT_TRUE(alone);
        EXPECT_EQ(hit.side, alone->side);
        EXPECT_EQ(hit.on_border, alone->on_border);
        const Vec3d point =
            mesh.vertices[a] * hit.weights[0] + mesh.vertices[b] * hit.weights[1] + mesh.vertices[c] * hit.weights[2];
        EXPECT_LE(length(point - (ray.origin + ray.direction * hit.t)), 1e-9 * scale * (1 + hit.t)) << i;
      }
      std::sort(triangles.begin(), triangles.end());
      EXPECT_EQ(triangles, expected);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end(),
                                 [](const RayCrossing& a, const RayCrossing& b) { return a.t < b.t; }));
      const std::optional<RayCrossing> first = bvh.first_crossing(ray);
      ASSERT_EQ(first.has_value(), !found.empty());
      if (first) {
        EXPECT_EQ(first->t, found.front().t);
        EXPECT_EQ(first->triangle, found.front().triangle);
        EXPECT_FALSE(bvh.first_crossing(ray, first->t * (1 - 1e-9) - 1e-300));
        EXPECT_EQ(bvh.first_crossings(std::vector<Ray>{ray})[0]->t, first->t);
      }
    }
  }
  const TriangleMesh sphere = make_sphere({.frequency = 8});
  const Bvh bvh(sphere, SiteTable(sphere));
  EXPECT_EQ(bvh.crossings({{0.01, 0.02, 0.03}, {0.3, 0.2, 0.9}}).size(), 1U);
  EXPECT_TRUE(bvh.crossings({{0, 0, 0}, {0, 0, 0}}).empty());
  EXPECT_TRUE(bvh.crossings({{0, 0, NAN}, {0, 0, 1}}).empty());
}

TEST(Bvh, PartsAnswerLikeTheWholeTreeInTheirBox) {
  for (const double scale : {1.0, 1e-40, 1e40}) {
    const TriangleMesh mesh = test::moved(test::awkward_soup(300, 51), scale);
    const Bvh bvh(mesh, SiteTable(mesh));
    const std::vector<Vec3d> places = test::places_around(mesh, 600, 52);
    std::size_t parts = 0;
    std::size_t crossed = 0;
    std::size_t met = 0;
    for (std::size_t i = 0; i + 2 < places.size(); ++i) {
      const double size = i % 2 == 0 ? 0.01 : 0.3;
      const std::array<Vec3d, 3> own = triangle_at(places, i, size);
      Box3 box;
      for (const Vec3d& corner : own) box.extend(corner);
      const std::optional<BvhPart> part = bvh.part_in(box);
      if (!part) continue;
      ++parts;
      const Ray ray{own[0], own[1] - own[0]};
      const std::optional<RayCrossing> first = bvh.first_crossing(ray, 1);
      const std::optional<RayCrossing> in_part = bvh.first_crossing(ray, *part);
      ASSERT_EQ(in_part.has_value(), first.has_value()) << i;
      if (first) {
        ++crossed;
        EXPECT_EQ(in_part->t, first->t);
        EXPECT_EQ(in_part->triangle, first->triangle);
      }
      const auto near = visited([&](const auto& visit) { bvh.for_each_near(own, visit); });
      const auto near_in_part = visited([&](const auto& visit) { bvh.for_each_near(own, *part, visit); });
      EXPECT_EQ(near_in_part, near);
      met += near.size();
    }
    EXPECT_GT(parts, 300U);
    EXPECT_GT(crossed, 20U);
    EXPECT_GT(met, 50U);
  }
}

TEST(Bvh, OrdersAllPrimitives) {
  const TriangleMesh mesh = test::awkward_soup(90, 4);
  const Bvh bvh(mesh, SiteTable(mesh));
  std::vector<std::uint32_t> order(bvh.order().begin(), bvh.order().end());
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), mesh.triangles.size() + mesh.segments.size() + mesh.points.size());
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(order[k], k);
}

TEST(Bvh, AnswersLikeANewTreeAfterARefit) {
  const TriangleMesh before = test::awkward_soup(150, 41);
  TriangleMesh after = before;
  Random random(42);
  for (Vec3d& v : after.vertices) v = v * 3.0 + random.in_ball() * 2.0 + Vec3d{5, 0, -7};
  const SiteTable sites(before);
  Bvh refitted(before, sites);
  EXPECT_THROW(refitted.refit(std::span(after.vertices).first(3)), InvalidMesh);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Vec3d> broken = after.vertices;
    broken[before.triangles[0][1]][axis] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(refitted.refit(broken), InvalidMesh);
  }
  refitted.refit(after.vertices);
  const Bvh fresh(after, sites);
  EXPECT_EQ(refitted.bounds().lower, fresh.bounds().lower);
  EXPECT_EQ(refitted.bounds().upper, fresh.bounds().upper);
  for (const Vec3d& q : test::places_around(after, 300, 43)) {
    const std::optional<NearestSite> a = refitted.nearest(q);
    const std::optional<NearestSite> b = fresh.nearest(q);
    EXPECT_EQ(a->distance, b->distance);
    EXPECT_EQ(a->site, b->site);
    EXPECT_EQ(a->point, b->point);
    const auto near_a = refitted.nearest_primitives(q, 5);
    const auto near_b = fresh.nearest_primitives(q, 5);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(near_a[i].primitive, near_b[i].primitive);
    const Ray ray{q, bounds(after).center() - q};
    const auto hits_a = refitted.crossings(ray);
    const auto hits_b = fresh.crossings(ray);
    ASSERT_EQ(hits_a.size(), hits_b.size());
    for (std::size_t i = 0; i < hits_a.size(); ++i) EXPECT_EQ(hits_a[i].triangle, hits_b[i].triangle);
  }
  const std::vector<Vec3d> queries = test::places_around(after, 700, 44);
  const auto batch = refitted.nearest(queries, HUGE_VAL, {.threads = 3});
  for (std::size_t i = 0; i < queries.size(); ++i) EXPECT_EQ(batch[i]->site, fresh.nearest(queries[i])->site);
  after.vertices[after.triangles[0][0]].x = NAN;
  EXPECT_THROW(refitted.refit(after.vertices), InvalidMesh);
}

}  // namespace
}  // namespace blum
