// Proves that closest_points() returns the exact closest point, site, triangle and sign for any query point.
#include "blum/field/closest_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/reference.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

void expect_like_brute_force(const TriangleMesh& mesh, std::uint64_t seed, SignRule rule) {
  const reference::BruteForce expected(mesh);
  const std::vector<Vec3d> places = test::places_around(mesh, 300, seed);
  const ClosestPointQuery query(mesh);
  EXPECT_EQ(query.sign_rule(), rule) << query.sign_reason();
  const std::vector<ClosestPoint> found = query.nearest(places);
  ASSERT_EQ(found.size(), places.size());
  const double extent = bounds(mesh).diagonal();
  std::size_t negative = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const reference::Nearest truth = expected.nearest(places[i]);
    EXPECT_NEAR(std::abs(found[i].distance), truth.distance, 1e-11 * extent);
    EXPECT_NEAR(expected.site_distance(found[i].site, places[i]), truth.distance, 1e-11 * extent);
    EXPECT_EQ(found[i].triangle, expected.sites().triangle(found[i].site));
    EXPECT_NEAR(length(found[i].point - places[i]), truth.distance, 1e-11 * extent);
    if (truth.distance < 1e-9 * extent || rule == SignRule::none) continue;
    const double w = reference::winding_number(mesh, places[i]);
    if (std::abs(w - 0.5) > 1e-9) {
      EXPECT_EQ(found[i].distance < 0, w > 0.5);
    }
    negative += found[i].distance < 0 ? 1 : 0;
  }
  if (rule != SignRule::none) {
    EXPECT_GT(negative, 0U);
  }
}

TEST(ClosestPoints, AreThoseOfBruteForce) {
  expect_like_brute_force(make_sphere({.frequency = 5}), 1, SignRule::normals);
  expect_like_brute_force(make_star({}), 2, SignRule::normals);
  expect_like_brute_force(make_organic({.frequency = 12, .holes = 3}), 3, SignRule::winding);
  TriangleMesh with_wires = make_sphere({.frequency = 4});
  append(with_wires, make_segments({.segments = 20, .size = 3}));
  append(with_wires, make_points({.points = 20, .size = 3}));
  expect_like_brute_force(with_wires, 4, SignRule::winding);  // wires have no inside
}

TEST(ClosestPoints, SignsOfPartsThatTouchOrCross) {
  TriangleMesh beside = test::box_between({0, 0, 0}, {1, 1, 1});
  append(beside, test::box_between({1, 0, 0}, {2, 1, 1}));
  EXPECT_NEAR(closest_points(beside, std::vector<Vec3d>{{1.1, 0.5, 0.5}})[0].distance, -0.1, 1e-12);
  expect_like_brute_force(beside, 5, SignRule::winding);

  TriangleMesh crossing = test::box_between({0, 2, 2}, {6, 4, 4});
  append(crossing, test::box_between({2, 0, 2.5}, {4, 6, 3.5}));
  const std::vector<Vec3d> inside_one{{1.9, 3, 3}};
  EXPECT_LT(closest_points(crossing, inside_one)[0].distance, 0);
  EXPECT_LT(closest_points(crossing, inside_one, {.sign = SignMode::normals})[0].distance, 0);

  TriangleMesh hollow = test::box_between({0, 1, 1}, {2, 3, 3}, true);  // its void touches the wall from inside
  append(hollow, test::box_between({0, 0, 0}, {4, 4, 4}));
  EXPECT_EQ(closest_points(hollow, std::vector<Vec3d>{{-5, 2, 2}})[0].distance, 5);
  EXPECT_EQ(closest_points(hollow, std::vector<Vec3d>{{1, 2, 2}})[0].distance, 1);
}

TEST(ClosestPoints, InsideOutMeshesThatTouchThemselvesAreInsideOutEverywhere) {
  TriangleMesh beside = test::box_between({0, 0, 0}, {1, 1, 1}, true);
  append(beside, test::box_between({1, 0, 0}, {2, 1, 1}, true));
  const std::vector<Vec3d> places{{1.1, 0.5, 0.5}, {3, 0.5, 0.5}, {0.5, 1.2, 0.5}};
  const std::vector<ClosestPoint> found = closest_points(beside, places, {.sign = SignMode::normals});
  EXPECT_NEAR(found[0].distance, 0.1, 1e-12);
  EXPECT_NEAR(found[1].distance, -1, 1e-12);
  EXPECT_NEAR(found[2].distance, -0.2, 1e-12);
}

TEST(ClosestPoints, FarPlacesAreOutside) {
  const TriangleMesh cube = make_box({});
  for (const SignMode mode : {SignMode::automatic, SignMode::normals, SignMode::winding}) {
    for (const double far : {1e3, 1e15, 1e16, 1e17, 1e18, 1e100}) {
      const ClosestPoint found = closest_points(cube, std::vector<Vec3d>{{far, 0, 0}}, {.sign = mode})[0];
      EXPECT_NEAR(found.distance, far, 0.5 + 1e-9 * far) << "at " << far;
    }
  }
}

TEST(ClosestPoints, HaveGradientsOfLengthOneNextToTheSurface) {
  const TriangleMesh mesh = make_torus();
  const ClosestPointQuery query(mesh);
  for (const double off : {1e-2, 1e-6, 1e-9, 1e-11}) {
    std::size_t told = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 37) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3d area = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
      const Vec3d normal = area / length(area);
      const Vec3d middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
      for (const double side : {-1.0, 1.0}) {
        const Vec3d place = middle + normal * (side * off);
        const std::optional<Vec3d> found = gradient(place, query.nearest(place));
        if (!found) continue;
        ++told;
        EXPECT_NEAR(length(*found), 1, 1e-14) << off;
        EXPECT_GT(dot(*found, normal), 0.99) << off;
      }
    }
    EXPECT_GT(told, 300U) << off;
  }
}

TEST(ClosestPoints, HaveGradientsThatDifferencesConfirm) {
  const double step = 1e-6;
  for (const TriangleMesh& mesh : {make_torus(), make_box({}), make_organic({.frequency = 8})}) {
    for (const SignMode mode : {SignMode::automatic, SignMode::winding, SignMode::none}) {
      const ClosestPointQuery query(mesh, {.sign = mode});
      Random random(4);
      std::vector<Vec3d> places(300);
      for (Vec3d& p : places) {
        for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-1.2, 1.2);
      }
      const auto gradients = query.gradients(places, query.nearest(places));
      std::size_t close = 0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        ASSERT_TRUE(gradients[k]);
        Vec3d slope;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          Vec3d by;
          by[axis] = step;
          slope[axis] = (query.nearest(places[k] + by).distance - query.nearest(places[k] - by).distance) / (2 * step);
        }
        if (length(slope - *gradients[k]) < 1e-4) ++close;
      }
      EXPECT_GT(close, places.size() - 5) << "differences across the medial axis may disagree";
    }
  }
}

// On the surface of a ball, the gradient is radial; on a box it is the face's normal, or the mean of several.
TEST(ClosestPoints, HaveNormalsAsGradientsOnTheSurface) {
  TriangleMesh ball = make_sphere();
  TriangleMesh inverted = ball;
  reverse_triangles(inverted);
  for (const TriangleMesh* mesh : {&ball, &inverted}) {
    for (const SignMode mode : {SignMode::automatic, SignMode::none}) {
      if (mesh == &inverted && mode == SignMode::none) continue;  // no rule turns the triangles
      const ClosestPointQuery query(*mesh, {.sign = mode});
      const std::vector<Vec3d>& places = mesh->vertices;
      const std::vector<ClosestPoint> found = query.nearest(places);
      const auto gradients = query.gradients(places, found);
      for (std::size_t k = 0; k < places.size(); ++k) {
        ASSERT_EQ(found[k].distance, 0);
        EXPECT_EQ(blum::gradient(places[k], found[k]), std::nullopt);
        ASSERT_TRUE(gradients[k]);
        EXPECT_NEAR(length(*gradients[k]), 1, 1e-14);
        EXPECT_GT(dot(*gradients[k], places[k] / length(places[k])), 0.999);
        EXPECT_EQ(gradients[k], query.gradient(places[k], found[k]));
      }
    }
  }
  const ClosestPointQuery query(make_box({}));
  const auto at = [&](const Vec3d& p) { return query.gradient(p, query.nearest(p)).value(); };
  EXPECT_EQ(at({0.1, 0.2, 0.5}), (Vec3d{0, 0, 1}));
  EXPECT_EQ(at({-0.5, 0.2, 0.1}), (Vec3d{-1, 0, 0}));
  EXPECT_LT(length(at({0.5, 0.2, 0.5}) - Vec3d{1, 0, 1} / std::sqrt(2.0)), 1e-15);
  EXPECT_LT(length(at({0.5, 0.5, -0.5}) - Vec3d{1, 1, -1} / std::sqrt(3.0)), 1e-15);
}

TEST(ClosestPoints, HaveNoGradientWithoutANormal) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}};
  mesh.segments = {{0, 1}};
  const ClosestPointQuery query(mesh, {.max_distance = 1});
  const std::vector<Vec3d> places{{0.5, 0, 0}, {0.5, 0.5, 0}, {0.5, 9, 0}};
  const auto gradients = query.gradients(places, query.nearest(places));
  EXPECT_EQ(gradients[0], std::nullopt);
  EXPECT_EQ(gradients[1], (Vec3d{0, 1, 0}));
  EXPECT_EQ(gradients[2], std::nullopt);
  EXPECT_THROW((void)query.gradients(places, {}), InvalidOption);
}

TEST(ClosestPoints, NameTheFirstBadQueryOfMany) {
  const ClosestPointQuery query(make_box({}));
  std::vector<Vec3d> places(200000, Vec3d{1, 2, 3});
  for (const std::size_t bad : {199999U, 150001U, 70000U}) {
    places[bad].y = NAN;
    for (const int threads : {1, 4}) {
      try {
        (void)query.nearest(places, {.threads = threads});
        FAIL() << bad;
      } catch (const InvalidOption& error) {
        EXPECT_EQ(std::string(error.what()), "query " + std::to_string(bad) + " has a coordinate that is not finite");
      }
    }
  }
}

TEST(ClosestPoints, HaveNormalsOfTheMovedMeshAfterRefit) {
  const TriangleMesh box = make_box({});
  for (const SignMode mode : {SignMode::automatic, SignMode::none}) {
    ClosestPointQuery query(box, {.sign = mode});
    const auto at = [&](const Vec3d& p) { return query.gradient(p, query.nearest(p)).value(); };
    EXPECT_EQ(at({0.1, 0.2, 0.5}), (Vec3d{0, 0, 1}));
    std::vector<Vec3d> turned = box.vertices;
    for (Vec3d& p : turned) p = {p.z, p.x, p.y};
    for (Vec3d& p : turned) p.z *= 2;
    query.refit(turned);
    EXPECT_EQ(at({0.1, 0.2, 1}), (Vec3d{0, 0, 1}));
    EXPECT_EQ(at({0.5, 0.2, 0.3}), (Vec3d{1, 0, 0}));
  }
}

TEST(ClosestPoints, DistinguishVerticesEdgesAndFaces) {
  const TriangleMesh cube = make_box({});
  const SiteTable sites(cube);
  const Vec3d half = bounds(cube).upper;
  const std::vector<Vec3d> places{
      half * 2.0, {half.x + 1, half.y + 1, 0.1}, {half.x + 1, 0.1, 0.2}, {0.3 * half.x, 0, 0}};
  const std::vector<ClosestPoint> found = closest_points(cube, places);
  EXPECT_EQ(sites.site(found[0].site).kind, SiteKind::vertex);
  EXPECT_EQ(sites.site(found[1].site).kind, SiteKind::edge);
  EXPECT_EQ(sites.site(found[2].site).kind, SiteKind::face);
  EXPECT_DOUBLE_EQ(found[0].distance, length(half));
  EXPECT_DOUBLE_EQ(found[1].distance, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(found[2].distance, 1);
  EXPECT_DOUBLE_EQ(found[3].distance, -0.7 * half.x);
}

TEST(ClosestPoints, OfWiresAndPointsAreUnsigned) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {9, 9, 9}};
  mesh.segments = {{1, 0}};
  mesh.points = {2};
  const std::vector<Vec3d> places{{0.5, 2, 0}, {-1, 0, 0}, {5, 1, 0}, {8, 8, 8}};
  const ClosestPointQuery query(mesh);
  EXPECT_EQ(query.sign_rule(), SignRule::none);
  const std::vector<ClosestPoint> found = query.nearest(places);
  EXPECT_EQ(found[0].site, SiteId(4));  // four vertices, then the edge
  EXPECT_EQ(found[1].site, SiteId(0));
  EXPECT_EQ(found[2].site, SiteId(2));
  EXPECT_EQ(found[3].site, SiteId(2)) << "a vertex that nothing names must not be found";
  EXPECT_FALSE(found[0].triangle.has_value());
  EXPECT_EQ(found[0].distance, 2);
  EXPECT_THROW((void)closest_points(mesh, places, {.sign = SignMode::winding}), InvalidOption);
}

TEST(ClosestPoints, HaveAReasonForTheirSign) {
  TriangleMesh sphere = make_sphere({.frequency = 3});
  EXPECT_EQ(ClosestPointQuery(sphere).sign_rule(), SignRule::normals);
  reverse_triangles(sphere);
  const ClosestPointQuery inverted(sphere);
  EXPECT_EQ(inverted.sign_rule(), SignRule::normals);
  EXPECT_TRUE(inverted.sign_reason().ends_with("faces outwards, after 1 shell was reversed")) << inverted.sign_reason();
  EXPECT_LT(inverted.nearest(Vec3d{}).distance, 0);
  sphere.triangles.pop_back();
  EXPECT_THROW(ClosestPointQuery(sphere, {.sign = SignMode::normals}), InvalidMesh);
  EXPECT_EQ(ClosestPointQuery(sphere, {.sign = SignMode::none}).sign_rule(), SignRule::none);
}

TEST(ClosestPoints, StopAtTheLargestDistance) {
  const TriangleMesh sphere = make_sphere({.frequency = 4});
  const std::vector<Vec3d> places{{1.05, 0, 0}, {3, 0, 0}};
  const std::vector<ClosestPoint> found = closest_points(sphere, places, {.max_distance = 0.5});
  EXPECT_TRUE(found[0].site.has_value());
  EXPECT_FALSE(found[1].site.has_value());
  EXPECT_EQ(found[1].distance, HUGE_VAL);
  EXPECT_EQ(found[1].point, places[1]);
  EXPECT_THROW((void)closest_points(sphere, places, {.max_distance = -1.0}), InvalidOption);
  EXPECT_THROW((void)closest_points(sphere, places, {.max_distance = NAN}), InvalidOption);
}

TEST(ClosestPoints, NameTheQueryThatIsNotFinite) {
  const TriangleMesh sphere = make_sphere({.frequency = 2});
  std::vector<Vec3d> places(10);
  places[7].y = NAN;
  try {
    (void)closest_points(sphere, places);
    FAIL() << "accepted";
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("query 7"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)closest_points(TriangleMesh{}, places), InvalidMesh);
  EXPECT_TRUE(closest_points(sphere, {}).empty());
}

TEST(ClosestPoints, DependOnNeitherThreadsNorNeighbours) {
  const TriangleMesh mesh = make_organic({.frequency = 16, .holes = 2});
  std::vector<Vec3d> places = test::places_around(mesh, 1500, 6);
  places.insert(places.begin() + 700, 20, places[3]);
  const ClosestPointQuery query(mesh);
  const std::vector<ClosestPoint> one = query.nearest(places, {.threads = 1});
  const std::vector<ClosestPoint> four = query.nearest(places, {.threads = 4});
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ClosestPoint alone = query.nearest(places[i]);
    EXPECT_EQ(one[i].distance, four[i].distance);
    EXPECT_EQ(one[i].site, four[i].site);
    EXPECT_EQ(one[i].distance, alone.distance);
    EXPECT_EQ(one[i].site, alone.site);
  }
}

/// Both structures are built at the same time. Shells that face the wrong way are reversed meanwhile.
TEST(ClosestPoints, AreTheSameIfAllIsBuiltAtTheSameTime) {
  TriangleMesh inverted = make_organic({.frequency = 10});
  reverse_triangles(inverted);
  for (const TriangleMesh& mesh : {make_organic({.frequency = 10}), inverted}) {
    const std::vector<Vec3d> places = test::places_around(mesh, 9000, 5);
    const ClosestPointQuery expected(mesh);
    for (const int threads : {1, 2, 4}) {
      const Context context{.threads = threads};
      const ClosestPointQuery query = ClosestPointQuery::for_many(mesh, places.size(), {}, context);
      EXPECT_EQ(query.sign_reason(), expected.sign_reason());
      const std::vector<ClosestPoint> found = query.nearest(places, context);
      const std::vector<ClosestPoint> in_one_call = closest_points(mesh, places, {}, context);
      for (std::size_t k = 0; k < places.size(); ++k) {
        const ClosestPoint alone = expected.nearest(places[k]);
        ASSERT_EQ(found[k].point, alone.point);
        ASSERT_EQ(found[k].distance, alone.distance);
        ASSERT_EQ(found[k].site, alone.site);
        ASSERT_EQ(found[k].triangle, alone.triangle);
        ASSERT_EQ(in_one_call[k].distance, alone.distance);
      }
    }
  }
  EXPECT_THROW((void)ClosestPointQuery::for_many(TriangleMesh{}, 9000), InvalidMesh);
  const TriangleMesh sphere = make_sphere({.frequency = 4});
  EXPECT_THROW((void)ClosestPointQuery::for_many(sphere, 9000, {.max_distance = -1.0}), InvalidOption);
  TriangleMesh open = sphere;
  open.triangles.pop_back();
  const ClosestPointOptions normals{.sign = SignMode::normals};
  EXPECT_THROW((void)ClosestPointQuery::for_many(open, 9000, normals, {.threads = 2}), InvalidMesh);
}

/// Few queries are answered by the hierarchy, many queries are answered together. Signs come from normals or winding
/// numbers.
TEST(ClosestPoints, AreVisitedOnceEachWithTheSameAnswer) {
  TriangleMesh open = make_organic({.frequency = 6});
  open.triangles.resize(open.triangles.size() - 3);
  for (const TriangleMesh& mesh : {make_organic({.frequency = 6}), open}) {
    for (const std::size_t count : {0U, 1U, 700U, 9000U}) {
      SCOPED_TRACE(count);
      const ClosestPointQuery query(mesh, {.max_distance = 0.3 * bounds(mesh).diagonal()});
      const std::vector<Vec3d> places = test::places_around(mesh, count, 5);
      const std::vector<ClosestPoint> kept = query.nearest(places);
      std::vector<ClosestPoint> told(places.size());
      std::vector<int> times(places.size(), 0);
      const auto put = [&](std::span<const FoundPoint> group) {
        for (const FoundPoint& found : group) {
          ++times[found.query];
          told[found.query] = {found.point, found.distance, found.site, {}};
        }
      };
      query.for_each_nearest(places, put);
      for (std::size_t k = 0; k < places.size(); ++k) {
        ASSERT_EQ(times[k], 1);
        ASSERT_EQ(told[k].point, kept[k].point);
        ASSERT_EQ(told[k].distance, kept[k].distance);
        ASSERT_EQ(told[k].site, kept[k].site);
      }
    }
  }
}

TEST(ClosestPoints, CanBeCancelled) {
  std::stop_source stop;
  stop.request_stop();
  const std::vector<Vec3d> places(10);
  EXPECT_THROW((void)closest_points(make_sphere({.frequency = 3}), places, {}, {.cancel = stop.get_token()}),
               Cancelled);
}

}  // namespace
}  // namespace blum
