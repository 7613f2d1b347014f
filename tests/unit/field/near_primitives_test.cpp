// Proves that searches for primitives within a distance, or for the closest few, equal a search of all primitives. Many
// points together get the answers of each point alone. Gradients are unit vectors along which the distance grows.
// Barycentric weights reproduce the closest point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// Puts each primitive into a hierarchy of its own to compute its distance from a query.
class OneByOne {
 public:
  explicit OneByOne(const TriangleMesh& mesh) : mesh_(mesh) {}

  [[nodiscard]] std::vector<double> distances(const Vec3d& query) const {
    std::vector<double> out;
    const auto add = [&](const TriangleMesh& one) {
      const SiteTable sites(one);
      out.push_back(Bvh(one, sites).nearest(query)->distance);
    };
    for (const Triangle& t : mesh_.triangles) add({mesh_.vertices, {t}, {}, {}});
    for (const Segment& s : mesh_.segments) add({mesh_.vertices, {}, {s}, {}});
    for (const std::uint32_t p : mesh_.points) add({mesh_.vertices, {}, {}, {p}});
    return out;
  }

 private:
  const TriangleMesh& mesh_;
};

TEST(NearPrimitives, AreThoseOfASearchOfAll) {
  const TriangleMesh mesh = test::awkward_soup(60, 5);
  const OneByOne all(mesh);
  const ClosestPointQuery query(mesh, {.sign = SignMode::none});
  const std::vector<Vec3d> places = test::places_around(mesh, 60, 6);
  const double extent = bounds(mesh).diagonal();
  const double distance = 0.2 * extent;
  const NearPrimitives within = query.within(places, distance);
  const NearPrimitives nearest = query.nearest_primitives(places, 7);
  ASSERT_EQ(within.first.size(), places.size() + 1);
  ASSERT_EQ(nearest.found.size(), places.size() * 7);
  for (std::size_t q = 0; q < places.size(); ++q) {
    const std::vector<double> expected = all.distances(places[q]);
    const auto close = std::count_if(expected.begin(), expected.end(), [&](double d) { return d <= distance; });
    EXPECT_EQ(within.first[q + 1] - within.first[q], static_cast<std::size_t>(close));
    for (std::size_t k = within.first[q]; k < within.first[q + 1]; ++k) {
      const NearestPrimitive& one = within.found[k];
      EXPECT_NEAR(one.distance, expected[one.primitive], 1e-11 * extent);
      EXPECT_NEAR(length(places[q] - one.point), one.distance, 1e-11 * extent);
      if (k > within.first[q]) {
        const NearestPrimitive& before = within.found[k - 1];
        EXPECT_TRUE(before.distance < one.distance ||
                    (before.distance == one.distance && before.primitive < one.primitive));
      }
    }
    std::vector<double> sorted = expected;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(nearest.found[7 * q + k].distance, sorted[k], 1e-11 * extent);
  }
}

TEST(NearPrimitives, AreTheSameForAnyThreadsAndEndAtTheLimit) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  const ClosestPointQuery query(mesh, {.max_distance = 0.1});
  const std::vector<Vec3d> places = test::places_around(mesh, 3000, 7);
  const NearPrimitives many = query.within(places, 1e9, {.threads = 3});
  const NearPrimitives one = query.within(places, 0.1, {.threads = 1});
  EXPECT_EQ(many.first, one.first);
  ASSERT_EQ(many.found.size(), one.found.size());
  EXPECT_GT(many.found.size(), places.size());
  for (std::size_t k = 0; k < many.found.size(); ++k) {
    EXPECT_EQ(many.found[k].primitive, one.found[k].primitive);
    EXPECT_LE(many.found[k].distance, 0.1);
  }
  const NearPrimitives few = query.nearest_primitives(places, 1000000);
  EXPECT_EQ(few.first, one.first);
  EXPECT_EQ(query.nearest_primitives(places, 0).found.size(), 0U);
  EXPECT_EQ(query.within({}, 1).first, std::vector<std::size_t>{0});
  EXPECT_THROW((void)query.within(places, -1), InvalidOption);
  EXPECT_THROW((void)query.within(places, std::nan("")), InvalidOption);
  EXPECT_THROW((void)query.within(std::vector<Vec3d>{{0, HUGE_VAL, 0}}, 1), InvalidOption);
}

TEST(ClosestPoints, HaveGradientsAlongWhichTheDistanceGrows) {
  const TriangleMesh mesh = make_organic({.frequency = 8});
  const ClosestPointQuery query(mesh);
  const double extent = bounds(mesh).diagonal();
  std::size_t grown = 0;
  std::size_t asked = 0;
  for (const Vec3d& place : test::places_around(mesh, 400, 8)) {
    const ClosestPoint found = query.nearest(place);
    const std::optional<Vec3d> direction = gradient(place, found);
    EXPECT_EQ(direction.has_value(), std::abs(found.distance) > 1e-13 * (length(place) + length(found.point)));
    if (!direction || std::abs(found.distance) < 1e-6 * extent) continue;
    EXPECT_NEAR(length(*direction), 1, 1e-9);
    const double step = 1e-7 * extent;
    ++asked;
    grown += std::abs(query.nearest(place + *direction * step).distance - found.distance - step) < 1e-3 * step ? 1 : 0;
  }
  EXPECT_GT(grown, asked * 95 / 100);
  EXPECT_EQ(gradient({0, 0, 9}, ClosestPointQuery(mesh, {.max_distance = 0.1}).nearest({0, 0, 9})), std::nullopt);
}

TEST(ClosestPoints, AreWeightedMeansOfCorners) {
  for (const double scale : {1.0, 1e-100, 1e100}) {
    const TriangleMesh mesh = test::moved(test::awkward_soup(150, 9), scale);
    const double extent = bounds(mesh).diagonal();
    const ClosestPointQuery query(mesh, {.sign = SignMode::none});
    std::size_t on_triangles = 0;
    for (const Vec3d& place : test::places_around(mesh, 500, 10)) {
      const ClosestPoint found = query.nearest(place);
      const std::optional<std::array<double, 3>> weights = barycentric(mesh, found);
      ASSERT_EQ(weights.has_value(), found.triangle.has_value());
      if (!weights) continue;
      ++on_triangles;
      Vec3d sum;
      double total = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = mesh.triangles[found.triangle.value][k];
        EXPECT_GE((*weights)[k], 0);
        if (found.site.value < mesh.vertices.size()) {
          EXPECT_TRUE((*weights)[k] == 0 || corner == found.site.value);
        }
        sum += mesh.vertices[corner] * (*weights)[k];
        total += (*weights)[k];
      }
      EXPECT_NEAR(total, 1, 1e-15);
      EXPECT_LE(length(sum - found.point), 1e-13 * extent);
    }
    EXPECT_GT(on_triangles, 100U);
  }
}

}  // namespace
}  // namespace blum
