// Proves that medial axes of meshes are where theory puts them, within a voxel's diagonal in both directions. The tests
// use boxes, cylinders, extruded polygons, balls and ellipsoids of revolution, whose axes, radii and separation angles
// are known.
#include <gtest/gtest.h>

#include "support/known_axes.hpp"
#include "support/medial_check.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::above;
using test::AxisRows;
using test::cloud;
using test::KnownAxis;
using test::KnownCase;
using test::KnownSample;
using test::VertexRow;

/// {S > theta} is contractible in all these solids, so nothing more is kept for the topology.
void expect_known_axis(const KnownAxis& known, const MedialAxis& axis, double theta) {
  SCOPED_TRACE(testing::Message() << "theta " << theta);
  const double bound = test::voxel_diagonal(axis);
  const AxisRows complex = axis.simplify(theta);
  const std::vector<KnownSample> expected = above(known.axis, theta);
  const TriangleMesh exact = cloud(expected);
  EXPECT_LE(test::furthest_from(test::shape_of(complex), exact.vertices), bound) << "the exact axis to the output";
  double furthest = 0;
  double radius_error = 0;
  const ClosestPointQuery nearest(exact, {.sign = SignMode::none});
  for (const VertexRow& vertex : complex.vertices) {
    const ClosestPoint at = nearest.nearest(vertex.position);
    furthest = std::max(furthest, at.distance);
    radius_error = std::max(radius_error, std::abs(vertex.radius - expected[at.site.value].radius));
  }
  EXPECT_LE(furthest, bound + known.step) << "the output to the exact axis";
  EXPECT_LE(radius_error, bound + known.step);
}

void expect_known_axes(const KnownCase& known_case, int resolution) {
  const Vec3d size = bounds(known_case.make(1).mesh).size();
  const double step = 0.35 * std::max({size.x, size.y, size.z}) / resolution;
  const KnownAxis known = known_case.make(step);
  const MedialAxis axis = medial_axis(known.mesh, {.resolution = resolution});
  test::expect_certified(axis, known.mesh, {1, 0, 0});
  test::expect_exact_balls(axis.simplify(0), known.mesh);
  for (const double theta : {40.0, 60.0, 120.0}) expect_known_axis(known, axis, theta);
}

TEST(SlowMedialAnalyticRod, TheAxisOfARodIsAsLongAtLargeAngles) {
  // The footprints of each axis point lie on opposite sides, so the separation angle is 180 degrees everywhere.
  const KnownAxis rod = test::known_cylinder(0.4, 2, 0.01);
  const MedialAxis axis = medial_axis(rod.mesh);
  const double missing = test::furthest_from(test::shape_of(axis.simplify(150)), cloud(above(rod.axis, 150)).vertices);
  EXPECT_LE(missing, test::voxel_diagonal(axis));
}

class MedialAnalytic : public testing::TestWithParam<KnownCase> {};
class SlowMedialAnalytic : public testing::TestWithParam<KnownCase> {};

TEST_P(MedialAnalytic, AxisIsWithinADiagonalOfTheExactOneOnCoarseVoxels) {
  expect_known_axes(GetParam(), 64);
}
TEST_P(SlowMedialAnalytic, AxisIsWithinADiagonalOfTheExactOneByDefault) {
  expect_known_axes(GetParam(), MedialAxisOptions{}.resolution);
}

std::string name_of(const testing::TestParamInfo<KnownCase>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Solids, MedialAnalytic, testing::ValuesIn(test::known_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Solids, SlowMedialAnalytic, testing::ValuesIn(test::known_cases()), name_of);

}  // namespace
}  // namespace blum
