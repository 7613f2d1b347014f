// Proves that a query that was refitted to moved vertices answers bit for bit as a new query does. The tests cover
// every sign rule and both few and many points. Invalid vertices leave the query unchanged.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

void expect_same(const ClosestPointQuery& a, const ClosestPointQuery& b, const std::vector<Vec3d>& places) {
  EXPECT_EQ(a.sign_rule(), b.sign_rule());
  EXPECT_EQ(a.sign_reason(), b.sign_reason());
  const std::vector<ClosestPoint> found_a = a.nearest(places);
  const std::vector<ClosestPoint> found_b = b.nearest(places);
  ASSERT_EQ(found_a.size(), found_b.size());
  std::size_t differ = 0;
  for (std::size_t k = 0; k < found_a.size(); ++k) {
    const ClosestPoint& x = found_a[k];
    const ClosestPoint& y = found_b[k];
    differ += x.distance == y.distance && x.site == y.site && x.point == y.point && x.triangle == y.triangle ? 0 : 1;
  }
  EXPECT_EQ(differ, 0U);
  const NearPrimitives near_a = a.nearest_primitives(std::span(places).first(20), 4);
  const NearPrimitives near_b = b.nearest_primitives(std::span(places).first(20), 4);
  EXPECT_EQ(near_a.first, near_b.first);
  for (std::size_t k = 0; k < near_a.found.size(); ++k) EXPECT_EQ(near_a.found[k].primitive, near_b.found[k].primitive);
}

/// Returns frames in which a mesh rotates, grows, folds over itself and shrinks.
std::vector<std::vector<Vec3d>> frames_of(const TriangleMesh& mesh) {
  std::vector<std::vector<Vec3d>> frames;
  for (int f = 0; f < 4; ++f) {
    std::vector<Vec3d>& frame = frames.emplace_back();
    for (const Vec3d& p : mesh.vertices) {
      Vec3d q = test::turned(p) * (f == 3 ? 1e-20 : 1.0 + f);
      if (f == 2) q.x = std::abs(q.x) - 0.7 * q.y;  // crosses itself and is partly inside out
      frame.push_back(q);
    }
  }
  return frames;
}

void expect_as_new(const TriangleMesh& mesh, SignMode mode, std::size_t count) {
  ClosestPointQuery query(mesh, {.sign = mode});
  for (const std::vector<Vec3d>& frame : frames_of(mesh)) {
    TriangleMesh moved = mesh;
    moved.vertices = frame;
    query.refit(frame);
    const std::vector<Vec3d> places = test::places_around(moved, count, 1);
    expect_same(query, ClosestPointQuery(moved, {.sign = mode}), places);
  }
}

TEST(ClosestPointRefit, AnswersAsANewQuery) {
  const TriangleMesh closed = make_organic({.frequency = 6});
  for (const std::size_t count : {std::size_t{100}, std::size_t{5000}}) {
    for (const SignMode mode : {SignMode::none, SignMode::automatic, SignMode::normals, SignMode::winding}) {
      expect_as_new(closed, mode, count);
    }
    expect_as_new(make_organic({.frequency = 8, .holes = 2}), SignMode::automatic, count);
    expect_as_new(test::awkward_soup(200, 3), SignMode::automatic, count);
  }
}

TEST(ClosestPointRefit, ChangesNothingIfVerticesAreInvalid) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  ClosestPointQuery query(mesh);
  std::vector<Vec3d> frame = frames_of(mesh)[1];
  EXPECT_THROW(query.refit(std::span(frame).first(5)), InvalidMesh);
  frame[7].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(query.refit(frame), InvalidMesh);
  expect_same(query, ClosestPointQuery(mesh), test::places_around(mesh, 300, 2));
}

}  // namespace
}  // namespace blum
