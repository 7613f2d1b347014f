// Proves that fitted, decimated axes as the tool writes them are close to the exact ones at 20 and 60 degrees. The
// solids are boxes, L's, prisms, cylinders, cones, capsules, tori and ellipsoids. In both directions, all distances are
// within 1.1 voxels and 99 % within a tenth. Seams, rims and the radii of tubes are within a tenth.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "blum/certified/certified_axis.hpp"
#include "blum/complex/medial_columns.hpp"
#include "support/exact_axes.hpp"
#include "support/medial_check.hpp"

namespace blum {
namespace {

using test::ExactAxis;
using test::ExactCase;

constexpr int resolution = 64;
constexpr double off = 0.001;  ///< deviation of facets from round surfaces, voxels
constexpr double most = 1.1;   ///< largest distance of axes, seams and rims, voxels

/// Returns the edges of a role; with curves also the triangles.
TriangleMesh part_of(const Complex& axis, MedialRole role) {
  TriangleMesh part;
  part.vertices = axis.positions;
  const MedialView view(axis);
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    if (view.edge_role(e) == role) part.segments.push_back(axis.edges[e]);
  }
  if (role == MedialRole::curve) part.triangles = axis.triangles;
  return part;
}

struct Distances {
  double largest = 0, of_most = 0;  ///< voxels
};

/// @param share  of the points that lie within `of_most`.
Distances distances(const TriangleMesh& from, const TriangleMesh& to, double voxel, double share) {
  const std::vector<Vec3d> points = test::points_on(from, 0.5 * voxel);
  std::vector<double> all;
  for (const ClosestPoint& at : closest_points(to, points, {.sign = SignMode::none})) {
    all.push_back(at.distance / voxel);
  }
  std::sort(all.begin(), all.end());
  if (all.empty()) return {};
  return {all.back(), all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))]};
}

/// Checks the distances in both directions.
void expect_next_to(const TriangleMesh& found, const TriangleMesh& exact, double voxel, double share) {
  const Distances beyond = distances(found, exact, voxel, share);
  const Distances missing = distances(exact, found, voxel, share);
  EXPECT_LE(beyond.largest, most) << "the axis to the exact one";
  EXPECT_LE(beyond.of_most, 0.1) << "the axis to the exact one";
  EXPECT_LE(missing.largest, most) << "the exact axis to the found one";
  EXPECT_LE(missing.of_most, 0.1) << "the exact axis to the found one";
}

void expect_tube_radius(const Complex& axis, double radius, double voxel) {
  const MedialView view(axis);
  double furthest = 0;
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    if (view.edge_role(e) != MedialRole::curve) continue;
    for (const std::uint32_t v : axis.edges[e]) furthest = std::max(furthest, std::abs(view.radius[v] - radius));
  }
  EXPECT_LE(furthest, 0.1 * voxel);
}

class SlowExactAxes : public testing::TestWithParam<ExactCase> {};

TEST_P(SlowExactAxes, AreCloseToTheOutputOfTheTool) {
  const ExactCase& known = GetParam();
  const test::Fineness fineness{off * known.size / resolution};
  const MedialAxis axis = medial_axis(known.make(60, fineness).solid, {.resolution = resolution});
  const double voxel = axis.report().bodies.front().spacing;
  for (const double theta : {20.0, 60.0}) {
    SCOPED_TRACE(testing::Message() << "theta " << theta);
    const ExactAxis exact = known.make(theta, fineness);
    const CertifiedAxis made = certified_axis(axis, exact.solid, theta);
    EXPECT_TRUE(made.certificate.holds());
    EXPECT_TRUE(made.warnings.empty()) << made.warnings.front().text;
    const Complex& found = made.axis.axis;
    expect_next_to(part_of(found, MedialRole::curve), exact.axis, voxel, 0.99);
    for (const auto& [role, name, lines] :
         {std::tuple{MedialRole::seam, "seams", &exact.seams}, std::tuple{MedialRole::rim, "rims", &exact.rims}}) {
      if (lines->segments.empty()) continue;
      SCOPED_TRACE(name);
      expect_next_to(part_of(found, role), *lines, voxel, 0.98);
    }
    if (exact.tube_radius > 0) expect_tube_radius(found, exact.tube_radius, voxel);
  }
}

INSTANTIATE_TEST_SUITE_P(Solids, SlowExactAxes, testing::ValuesIn(test::exact_cases()),
                         [](const testing::TestParamInfo<ExactCase>& info) { return info.param.name; });

}  // namespace
}  // namespace blum
