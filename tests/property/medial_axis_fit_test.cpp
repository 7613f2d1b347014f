// Proves that the borders of fitted axes are where theory puts them. Sheets, seams and rims are within a tenth of a
// voxel nearly everywhere. Rims lie at theta, and round rods give curves. A rotated solid has the same sheets. Fitting
// keeps the topology and gives the same result for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stop_token>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/random.hpp"
#include "support/known_axes.hpp"
#include "support/medial_check.hpp"
#include "support/medial_rows.hpp"
#include "support/model_solids.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::KnownAxis;
using test::KnownCase;
using test::KnownSample;
using test::VertexRow;

double quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Returns the distances of points from a shape, in voxels.
std::vector<double> distances(const MeshView& shape, std::span<const Vec3d> points, double voxel) {
  const ClosestPointQuery nearest(shape, {.sign = SignMode::none});
  std::vector<double> out;
  for (const Vec3d& point : points) out.push_back(nearest.nearest(point).distance / voxel);
  return out;
}

/// Returns the vertices of an axis and the midpoints of its edges.
std::vector<Vec3d> points_of(const Complex& axis) {
  std::vector<Vec3d> points = axis.positions;
  const Incidence incidence(axis.view());
  for (const auto& [a, b] : incidence.edges()) points.push_back(0.5 * (axis.positions[a] + axis.positions[b]));
  return points;
}

class FittedAxis : public testing::TestWithParam<KnownCase> {};

TEST_P(FittedAxis, IsNextToTheExactOne) {
  constexpr int resolution = 64;
  const Vec3d size = bounds(GetParam().make(1).mesh).size();
  const double voxel = std::max({size.x, size.y, size.z}) / resolution;
  constexpr double step = 0.15;  // voxels
  const KnownAxis known = GetParam().make(step * voxel);
  const MedialAxis axis = medial_axis(known.mesh, {.resolution = resolution});
  // On faceted round solids, rims and ends lie where the angle of the facets is theta.
  const bool is_ball = GetParam().name == "Ball";
  const bool is_round = is_ball || GetParam().name.find("late") != std::string::npos;
  for (const double theta : {60.0, 120.0}) {
    SCOPED_TRACE(testing::Message() << "theta " << theta);
    const Complex fitted = axis.fitted(theta);
    EXPECT_EQ(test::betti_of(fitted), (BettiNumbers{1, 0, 0}));
    test::expect_exact_balls(fitted, known.mesh);
    const TriangleMesh exact = test::cloud(test::above(known.axis, theta));
    const std::vector<double> missing = distances(test::shape_of(fitted), exact.vertices, voxel);
    // The curve of the long ellipsoid ends where its angle falls from 90 degrees to 0 within five voxels.
    const bool is_long = GetParam().name == "Prolate";
    EXPECT_LE(quantile(missing, 1), is_long ? 2.5 : 1.1);
    EXPECT_LE(quantile(missing, 0.99), is_long ? 2 : is_ball ? 1.1 : is_round ? 0.5 : 0.05);
    const std::vector<double> beyond = distances(exact, points_of(fitted), voxel);
    EXPECT_LE(quantile(beyond, 1), is_ball ? 1.1 : is_round ? 0.6 : 0.35);
    EXPECT_LE(quantile(beyond, 0.99), (is_ball ? 1.1 : is_round ? 0.4 : 0.05) + step / std::sqrt(2));
  }
}

INSTANTIATE_TEST_SUITE_P(Solids, FittedAxis, testing::ValuesIn(test::known_cases()),
                         [](const testing::TestParamInfo<KnownCase>& info) { return info.param.name; });

/// Returns the vertices of the edges of a role.
std::vector<Vec3d> on_edges(const Complex& axis, MedialRole role) {
  const MedialView view(axis);
  std::vector<Vec3d> points;
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    if (view.edge_role(e) != role) continue;
    for (const std::uint32_t v : axis.edges[e]) points.push_back(axis.positions[v]);
  }
  return points;
}

TEST(FittedAxisOfABox, HasItsSheetsSeamsAndRimsHoweverItIsTurned) {
  for (const double degrees : {0.0, 17.0, 45.0}) {
    SCOPED_TRACE(degrees);
    const Mat3 turn = test::rotation({1, 2, 3}, degrees);
    const MedialAxis axis = medial_axis(test::turned(make_box({.size = {1.5, 1, 0.6}}), turn), {.resolution = 64});
    const Complex fitted = axis.fitted(60);
    const double voxel = axis.report().bodies.front().spacing;
    EXPECT_EQ(count(fitted).sheets, 13U);
    const DecimatedAxis lean = decimate(fitted, 0.25 * voxel);
    EXPECT_LE(lean.axis.triangles.size(), 80U);
    // Each seam is equally far from three walls, and each rim is next to an edge of the box.
    const auto walls = [&](const Vec3d& at) {
      const Vec3d own = turn.transposed_times(at);
      std::array<double, 6> out{0.75 - own.x, 0.75 + own.x, 0.5 - own.y, 0.5 + own.y, 0.3 - own.z, 0.3 + own.z};
      std::sort(out.begin(), out.end());
      return out;
    };
    for (const Vec3d& at : on_edges(fitted, MedialRole::seam)) EXPECT_LE(walls(at)[2] - walls(at)[0], 0.01 * voxel);
    std::vector<double> rims;
    for (const Vec3d& at : on_edges(fitted, MedialRole::rim)) rims.push_back(walls(at)[1] / voxel);
    EXPECT_LE(quantile(rims, 0.99), 0.1);
    EXPECT_LE(quantile(rims, 1), 0.5);
  }
}

// Few vertices of the cells lie next to a corner, and these may miss a wall. A rim may then cut the corner.
TEST(FittedAxisOfABox, RimsCutFewCorners) {
  constexpr int count_of_boxes = 24;
  Random random(7);
  int with_cut = 0;
  int with_other_sheets = 0;
  for (int n = 0; n < count_of_boxes; ++n) {
    const Vec3d half{0.3 + 0.7 * random.uniform(), 0.3 + 0.7 * random.uniform(), 0.3 + 0.7 * random.uniform()};
    const Mat3 turn = test::rotation({random.uniform(), 1, 0.5}, n % 3 == 0 ? 0 : 360 * random.uniform());
    const MedialAxis axis = medial_axis(test::turned(make_box({.size = half * 2.0}), turn), {.resolution = 64});
    const Complex fitted = axis.fitted(60);
    const double voxel = axis.report().bodies.front().spacing;
    const MedialView view(fitted);
    double furthest = 0;
    for (std::size_t e = 0; e < fitted.edges.size(); ++e) {
      if (view.edge_role(e) != MedialRole::rim) continue;
      const auto& [a, b] = fitted.edges[e];
      const Vec3d own = turn.transposed_times(0.5 * (fitted.positions[a] + fitted.positions[b]));
      std::array<double, 3> walls{half.x - std::abs(own.x), half.y - std::abs(own.y), half.z - std::abs(own.z)};
      std::sort(walls.begin(), walls.end());
      furthest = std::max(furthest, walls[1]);
    }
    with_cut += furthest > 0.1 * voxel ? 1 : 0;
    with_other_sheets += count(fitted).sheets == 13 ? 0 : 1;
    EXPECT_LE(furthest, 1.5 * voxel) << n;
  }
  EXPECT_LE(with_cut, 2);
  EXPECT_LE(with_other_sheets, 2);
}

/// Beside a hole, the solid has a corner of its facets between two points of a rim.
TEST(FittedAxisOfHoles, HasRimsNextToTheirEdges) {
  const TriangleMesh mesh = make_bracket({});
  const MedialAxis axis = medial_axis(mesh, {.resolution = 96});
  const double voxel = axis.report().bodies.front().spacing;
  const AxisRows fitted = axis.fitted(60);
  std::vector<double> depths;
  for (std::size_t v = 0; v < fitted.vertices.size(); ++v) {
    const VertexRow& vertex = fitted.vertices[v];
    const bool is_at_right_angles = std::abs(vertex.separation_angle - 90) < 1;
    if (vertex.role == MedialRole::rim && is_at_right_angles) depths.push_back(vertex.radius / voxel);
  }
  ASSERT_GT(depths.size(), 500U);
  EXPECT_LE(quantile(depths, 0.5), 0.06);
  EXPECT_LE(quantile(depths, 0.9), 0.21);
}

TEST(FittedAxisOfAnL, HasSixteenSheetsAtAllResolutions) {
  const TriangleMesh mesh = test::known_l_beam(0.6, 1).mesh;
  for (const int resolution : {48, 64, 96}) {
    EXPECT_EQ(count(medial_axis(mesh, {.resolution = resolution}).fitted(60)).sheets, 16U) << resolution;
  }
}

TEST(FittedAxisOfRoundThings, IsMadeOfCurves) {
  for (const int resolution : {48, 64, 96}) {
    SCOPED_TRACE(resolution);
    const Complex rod = medial_axis(make_cylinder({.radius = 0.5, .height = 3}), {.resolution = resolution}).fitted(60);
    EXPECT_EQ(count(rod).sheets, 2U) << "the cones at both ends";
    double length_of_curve = 0;
    const std::vector<Vec3d> ends = on_edges(rod, MedialRole::curve);
    for (std::size_t e = 0; e < ends.size(); e += 2) length_of_curve += length(ends[e] - ends[e + 1]);
    EXPECT_NEAR(length_of_curve, 2, 6.0 / resolution);
    const Complex ring = medial_axis(make_torus(), {.resolution = resolution}).fitted(60);
    EXPECT_EQ(test::betti_of(ring), (BettiNumbers{1, 1, 0}));
    EXPECT_LE(count(ring).triangles, 2U);
  }
}

TEST(FittedAxisOfALens, EndsWhereTheAngleIsTheta) {
  const MedialAxis axis = medial_axis(test::known_oblate(0.1).mesh, {.resolution = 64});
  for (const double theta : {40.0, 80.0, 120.0}) {
    const AxisRows rows = axis.fitted(theta);
    std::vector<double> errors;
    for (const VertexRow& vertex : rows.vertices) {
      if (vertex.role == MedialRole::rim) errors.push_back(std::abs(vertex.separation_angle - theta));
    }
    ASSERT_GT(errors.size(), 50U);
    // At small angles, rims lie where curvature is largest, and the angle jumps from facet to facet.
    EXPECT_LE(quantile(errors, theta < 80 ? 0.5 : 0.9), 3) << theta;
  }
}

/// Many threads choose many contractions at a time, one thread chooses them one by one. Crumpled sheets of thin parts
/// have many contractions next to each other.
TEST(FittedAxisOfAnything, IsTheSameForAnyNumberOfThreads) {
  std::vector<test::NamedMesh> solids = test::thin_solids();
  solids.resize(std::min<std::size_t>(solids.size(), 12));
  solids.push_back({"bracket", make_bracket()});
  for (const auto& [name, mesh] : solids) {
    const MedialAxis axis = medial_axis(mesh, {.resolution = 32});
    const double tolerance = 0.25 * axis.report().bodies[0].spacing;
    const Complex one = axis.fitted(20, {.threads = 1});
    const Complex few = decimate(one, tolerance, {.threads = 1}).axis;
    EXPECT_EQ(test::betti_of(few), axis.report().betti) << name;
    for (const int threads : {2, 7}) {
      const Complex many = axis.fitted(20, {.threads = threads});
      EXPECT_EQ(many.positions, one.positions) << name << ", " << threads;
      EXPECT_EQ(many.triangles, one.triangles) << name << ", " << threads;
      const Complex decimated = decimate(one, tolerance, {.threads = threads}).axis;
      EXPECT_EQ(decimated.positions, few.positions) << name << ", " << threads;
      EXPECT_EQ(decimated.triangles, few.triangles) << name << ", " << threads;
    }
  }
}

/// Thinning before fitting changes neither the topology nor the sheets, nor the report of either. The result is the
/// same for any number of threads.
TEST(FittedAxisOfAnything, LeanIsAsDecimatedAfterwards) {
  for (const TriangleMesh& mesh : {make_bracket(), make_void_cube(), make_box({.size = {1.5, 1, 0.6}})}) {
    const MedialAxis axis = medial_axis(mesh, {.resolution = 64});
    const double tolerance = 0.25 * axis.report().bodies[0].spacing;
    const Complex whole = axis.fitted(60);
    const DecimatedAxis afterwards = decimate(whole, tolerance);
    const DecimatedAxis lean = axis.lean(60, tolerance, {.threads = 1});
    EXPECT_LE(lean.deviation, tolerance);
    EXPECT_LE(lean.axis.triangles.size(), 1.2 * static_cast<double>(afterwards.axis.triangles.size()) + 10);
    EXPECT_EQ(count(lean.axis).sheets, count(afterwards.axis).sheets);
    EXPECT_GT(lean.vertices_before, lean.axis.positions.size());
    CertificateOptions options{.theta = 60, .spacing = axis.report().bodies[0].spacing, .deviation = lean.deviation};
    const Certificate certificate = certify(lean.axis, mesh, options);
    EXPECT_TRUE(certificate.holds()) << (certificate.holds() ? std::string() : certificate.mismatches.front());
    for (const int threads : {2, 7}) {
      const Complex other = axis.lean(60, tolerance, {.threads = threads}).axis;
      EXPECT_EQ(other.positions, lean.axis.positions) << threads;
      EXPECT_EQ(other.triangles, lean.axis.triangles) << threads;
    }
  }
}

TEST(FittedAxisOfAnything, LeanWithoutToleranceKeepsAllVertices) {
  const MedialAxis axis = medial_axis(make_box({}), {.resolution = 24});
  EXPECT_EQ(axis.lean(60, 0).axis.positions, axis.fitted(60).positions);
  EXPECT_THROW((void)axis.lean(60, -1), InvalidOption);
}

TEST(FittedAxisOfAnything, IsCertifiedForAllAngles) {
  for (const TriangleMesh& mesh : {make_bracket(), make_void_cube(), make_star(), make_wedge()}) {
    const MedialAxis axis = medial_axis(mesh, {.resolution = 48});
    for (const double theta : test::angles) {
      const Certificate certificate = certify(axis.fitted(theta), mesh);
      EXPECT_TRUE(certificate.holds()) << theta << ": "
                                       << (certificate.holds() ? std::string() : certificate.mismatches.front());
    }
  }
}

TEST(FittedAxisOfAnything, OfANonPolyhedronStaysAtTheCells) {
  TriangleMesh open = make_box({});
  open.triangles.pop_back();
  const MedialAxis axis = medial_axis(open, {.resolution = 24});
  EXPECT_EQ(axis.fitted(60).positions, axis.simplify(60).positions);
  EXPECT_THROW((void)axis.fitted(181), InvalidOption);
}

TEST(FittedAxisOfAnything, CanBeCancelled) {
  const MedialAxis axis = medial_axis(make_box({}), {.resolution = 24});
  std::stop_source stop;
  stop.request_stop();
  Context context;
  context.cancel = stop.get_token();
  EXPECT_THROW((void)axis.fitted(60, context), Cancelled);
}

}  // namespace
}  // namespace blum
