// Proves that the best certified form of an axis on the best grid is returned. Warnings give the reasons against better
// forms.
#include "blum/certified/certified_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "blum/axis/prune_sheets.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/core/error.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

void expect_same(const Complex& a, const Complex& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.triangles, b.triangles);
}

std::vector<std::string> texts_of(const std::vector<Warning>& warnings) {
  std::vector<std::string> out;
  for (const Warning& warning : warnings) out.push_back(warning.text);
  return out;
}

Certificate failing(const std::string& mismatch) {
  Certificate out;
  out.mismatches = {mismatch};
  return out;
}

TEST(CertifiedAxis, TheBestFormOfABoxIsCertified) {
  const TriangleMesh box = make_box({});
  const MedialAxis axis = medial_axis(box, {.resolution = 24});
  const CertifiedAxis found = certified_axis(axis, box, 60);
  EXPECT_TRUE(found.certificate.holds());
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_LE(found.axis.deviation, 0.25 * least_spacing(axis.report()));
  EXPECT_EQ(found.metadata.deviation, found.axis.deviation);
  EXPECT_LT(found.axis.axis.triangles.size(), 200U);
  EXPECT_EQ(found.certificate.checked.theta, 60);
  EXPECT_EQ(found.certificate.checked.lambda, 0);
}

/// No vertex has a separation angle above 180 degrees, so nothing can be missing.
TEST(CertifiedAxis, AtTheLargestAngleOnlyTheTopologyRemains) {
  const TriangleMesh plate = make_box({.size = {4, 2, 0.5}});
  const CertifiedAxis found = certified_axis(plate, 180, {.resolution = 32});
  EXPECT_EQ(found.axis.axis.positions.size(), 1U);
}

TEST(CertifiedAxis, WithoutAToleranceAllVerticesStay) {
  const TriangleMesh box = make_box({});
  const MedialAxis axis = medial_axis(box, {.resolution = 24});
  const CertifiedAxis found = certified_axis(axis, box, 60, 0.0);
  expect_same(found.axis.axis, axis.simplify(60));
  EXPECT_FALSE(found.metadata.deviation.has_value());
  EXPECT_THROW(static_cast<void>(certified_axis(axis, box, 60, -1.0)), InvalidOption);
}

TEST(CertifiedAxis, OfAMeshEqualsThatOfItsAxis) {
  const TriangleMesh box = make_box({});
  const CertifiedAxis found = certified_axis(box, 60, {.resolution = 24});
  EXPECT_TRUE(found.warnings.empty());
  expect_same(found.axis.axis, certified_axis(medial_axis(box, {.resolution = 24}), box, 60).axis.axis);
}

TEST(CertifiedAxis, RejectsTheAxisOfAnotherSolid) {
  const TriangleMesh box = make_box({});
  const TriangleMesh other = make_box({.size = {3, 1, 1}});
  try {
    static_cast<void>(certified_axis(medial_axis(box, {.resolution = 16}), other, 60));
    FAIL() << "an axis of another box";
  } catch (const NotCertified& error) {
    ASSERT_FALSE(error.mismatches().empty());
    EXPECT_EQ(error.mismatches().front().rfind("at theta 60: ", 0), 0U) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind("NOT certified: at theta 60: ", 0), 0U) << error.what();
  }
}

/// Axes of a box with made-up certificates.
class TriedAxes : public testing::Test {
 protected:
  using Judge = FunctionRef<Certificate(const AxisCandidate&)>;

  CertifiedAxes tried(Judge judge, const CertifiedAxisOptions& options = {}, double grid_shift = 0,
                      bool may_move = true) {
    shifts.clear();
    const auto make = [&](double shift) {
      shifts.push_back(shift);
      return axis;
    };
    return certified_axes({grid_shift, may_move, make}, judge, options);
  }
  /// Certificates that hold from the n-th one on.
  CertifiedAxes held_from(int n, const CertifiedAxisOptions& options = {}, double grid_shift = 0,
                          bool may_move = true) {
    return tried([&](const AxisCandidate&) { return n-- > 0 ? failing("something is wrong") : Certificate{}; }, options,
                 grid_shift, may_move);
  }

  TriangleMesh box = make_box({});
  std::shared_ptr<const MedialAxis> axis = std::make_shared<const MedialAxis>(medial_axis(box, {.resolution = 16}));
  std::vector<double> shifts;
};

TEST_F(TriedAxes, TriesFormsInOrderAndWarnsOfFailures) {
  const double tolerance = 0.25 * least_spacing(axis->report());
  const CertifiedAxes first = held_from(0);
  EXPECT_TRUE(first.axes.front().warnings.empty());
  expect_same(first.axes.front().axis.axis, axis->lean(60, tolerance).axis);
  const std::string fails =
      "at theta 60 the axis keeps all vertices; with fewer vertices, it is not certified: something is wrong";
  const std::string at_cells =
      "at theta 60 borders of sheets stay at the cells of the grid; with moved borders, the axis is not certified: "
      "something is wrong";
  const CertifiedAxes second = held_from(1);
  EXPECT_EQ(second.axes.front().warnings, (std::vector<Warning>{{WarningCode::form_not_certified, fails}}));
  expect_same(second.axes.front().axis.axis, axis->fitted(60));
  const CertifiedAxes third = held_from(2);
  EXPECT_EQ(third.axes.front().warnings, (std::vector<Warning>{{WarningCode::form_not_certified, at_cells}}));
  expect_same(third.axes.front().axis.axis, decimate(axis->simplify(60), tolerance).axis);
  const CertifiedAxes fourth = held_from(3);
  EXPECT_EQ(fourth.axes.front().warnings, (std::vector<Warning>{{WarningCode::form_not_certified, at_cells},
                                                                {WarningCode::form_not_certified, fails}}));
  expect_same(fourth.axes.front().axis.axis, axis->simplify(60));
  for (const CertifiedAxes* const found : {&first, &second, &third, &fourth}) {
    EXPECT_TRUE(found->holds());
    EXPECT_TRUE(found->warnings.empty());
    EXPECT_EQ(found->grid_shift, 0);
  }
}

TEST_F(TriedAxes, MovesTheGridIfNoFormHolds) {
  const CertifiedAxes third = held_from(8);
  EXPECT_EQ(shifts, (std::vector<double>{0, 0.3, -0.3}));
  EXPECT_EQ(third.grid_shift, -0.3);
  EXPECT_TRUE(third.holds());
  const std::vector<Warning> expected{
      {WarningCode::grid_moved, "the grid was moved by -0.3 voxels; before the move: at theta 60: something is wrong"}};
  EXPECT_EQ(third.warnings, expected);
  const CertifiedAxes none = held_from(1000);
  EXPECT_EQ(shifts.size(), 4U);
  EXPECT_EQ(none.grid_shift, 0) << "the first one";
  EXPECT_EQ(none.mismatches, std::vector<std::string>{"at theta 60: something is wrong"});
  EXPECT_TRUE(none.warnings.empty()) << "its mismatches say why";
  EXPECT_TRUE(none.axes.front().warnings.empty());
  expect_same(none.axes.front().axis.axis, axis->simplify(60));
  static_cast<void>(held_from(1000, {}, 0.9));
  for (const double shift : shifts) EXPECT_LE(std::abs(shift), 1) << "what medial_axis() allows";
  std::sort(shifts.begin(), shifts.end());
  EXPECT_EQ(std::unique(shifts.begin(), shifts.end()), shifts.end()) << "each grid once";
  static_cast<void>(held_from(1000, {}, 0, false));
  EXPECT_EQ(shifts.size(), 1U) << "an image";
}

TEST_F(TriedAxes, TheGridWithTheFewestMismatchesIsKept) {
  // On the first grid neither angle is certified. On each other grid, one angle is.
  const CertifiedAxes found = tried(
      [&](const AxisCandidate& candidate) {
        const bool is_right = candidate.grid_shift != 0 && *candidate.metadata.theta == 90;
        return is_right ? Certificate{} : failing("something is wrong");
      },
      {.thetas = {60, 90}});
  EXPECT_EQ(shifts.size(), 4U);
  EXPECT_EQ(found.grid_shift, 0.3);
  EXPECT_EQ(found.mismatches, std::vector<std::string>{"at theta 60: something is wrong"});
  ASSERT_EQ(found.axes.size(), 2U);
  EXPECT_FALSE(found.axes[0].certificate.holds());
  EXPECT_TRUE(found.axes[1].certificate.holds());
  EXPECT_EQ(texts_of(found.warnings).size(), 1U);
}

TEST_F(TriedAxes, PrunesSheetsFromAngleToAngle) {
  const CertifiedAxes found = held_from(0, {.thetas = {60, 100}, .tolerance = 0.0, .prunes_sheets = true});
  const Complex first = prune_sheets(axis->simplify(0), 60);
  expect_same(found.axes[0].axis.axis, first);
  expect_same(found.axes[1].axis.axis, prune_sheets(first, 100));
  EXPECT_THROW(static_cast<void>(held_from(0, {.thetas = {100, 60}, .prunes_sheets = true})), InvalidOption);
  EXPECT_THROW(static_cast<void>(held_from(0, {.thetas = {}})), InvalidOption);
  EXPECT_THROW(static_cast<void>(held_from(0, {.thetas = {60, 60}})), InvalidOption);
  EXPECT_THROW(static_cast<void>(held_from(0, {.tolerance = HUGE_VAL})), InvalidOption);
}

TEST_F(TriedAxes, AComplexIsDecimatedIfTheResultIsCertified) {
  const Complex whole = axis->simplify(60);
  const MedialMetadata metadata = medial_metadata(*axis, 60);
  std::vector<PhaseTime> phases;
  int n = 0;
  const auto certify = [&](const AxisCandidate& candidate) {
    EXPECT_EQ(candidate.whole, nullptr);
    return n-- > 0 ? failing("something is wrong") : Certificate{};
  };
  const CertifiedAxis lean = certified_axis(whole, metadata, 0.05, certify, phases);
  EXPECT_EQ(lean.metadata.deviation, lean.axis.deviation);
  expect_same(lean.axis.axis, decimate(whole, 0.05).axis);
  n = 1;
  const CertifiedAxis kept = certified_axis(whole, metadata, 0.05, certify, phases);
  expect_same(kept.axis.axis, whole);
  EXPECT_EQ(kept.axis.vertices_before, whole.positions.size());
  EXPECT_FALSE(kept.metadata.deviation.has_value());
  EXPECT_EQ(
      texts_of(kept.warnings),
      std::vector<std::string>{
          "at theta 60 the axis keeps all vertices; with fewer vertices, it is not certified: something is wrong"});
}

TEST(CertifiedAxes, EqualThoseOfEachAngle) {
  const TriangleMesh plate = make_box({.size = {3, 2, 1}});
  const CertifiedAxes found = certified_axes(plate, {.thetas = {100, 60}}, {.resolution = 24});
  EXPECT_TRUE(found.holds());
  ASSERT_EQ(found.axes.size(), 2U);
  expect_same(found.axes[0].axis.axis, certified_axis(plate, 100, {.resolution = 24}).axis.axis);
  expect_same(found.axes[1].axis.axis, certified_axis(plate, 60, {.resolution = 24}).axis.axis);
}

TEST(CertifiedAxes, NameTheSmallestVoxelOfTwoBodies) {
  TriangleMesh both = make_box({.size = {8, 8, 8}});
  const TriangleMesh thin = make_box({.size = {4, 4, 0.05}});
  const auto first = static_cast<std::uint32_t>(both.vertices.size());
  for (const Vec3d& v : thin.vertices) both.vertices.push_back(v + Vec3d{20, 0, 0});
  for (const auto& t : thin.triangles) both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const CertifiedAxes found = certified_axes(both, {}, {.resolution = 40});
  ASSERT_EQ(found.report.bodies.size(), 2U);
  EXPECT_TRUE(found.holds()) << found.mismatches.front();
  EXPECT_EQ(found.axes.front().metadata.spacing,
            std::min(found.report.bodies[0].spacing, found.report.bodies[1].spacing));
}

TEST(CertifiedAxes, UseTheVoxelsOfAnOpenMesh) {
  TriangleMesh box = make_box({});
  box.triangles.pop_back();
  const CertifiedAxes found = certified_axes(box, {}, {.resolution = 16});
  EXPECT_TRUE(found.holds()) << found.mismatches.front();
  EXPECT_EQ(found.axes.front().certificate.against, SolidRule::winding);
}

TEST(CertifiedAxes, UseTheSelectedVoxelsOfAnImage) {
  const VoxelImage image = make_balls_image({});
  const CertifiedAxes found = certified_axes(image, {.thetas = {60, 120}});
  EXPECT_TRUE(found.holds()) << found.mismatches.front();
  EXPECT_EQ(found.axes.front().metadata.site_ids, SiteIds::voxels);
  EXPECT_EQ(found.axes.front().certificate.against, SolidRule::voxels);
}

/// A cube with a square oblique hole through it. The hole is so narrow that no model opens it.
TriangleMesh block_with_needle() {
  TriangleMesh out;
  constexpr double width = 1e-9;
  constexpr std::array<std::array<double, 2>, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : square) out.vertices.push_back({x, y, z});
    for (const auto& [x, y] : square) {
      out.vertices.push_back({0.37 + 0.2 * z + width * (x - 0.5), 0.41 + 0.3 * z + width * (y - 0.5), z});
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    out.triangles.push_back({a, b, c});
    out.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4;
    add(k, n, 8 + n, 8 + k);
    add(4 + n, 4 + k, 12 + k, 12 + n);
    add(n, k, 4 + k, 4 + n);
    add(8 + k, 8 + n, 12 + n, 12 + k);
  }
  return out;
}

/// Its certificate may hold by chance, for example at angles that no vertex has. This is not sufficient.
TEST(CertifiedAxes, FailIfTheModelDoesNotPass) {
  const TriangleMesh block = block_with_needle();
  const auto axis = std::make_shared<const MedialAxis>(medial_axis(block, {.resolution = 8, .max_resolution = 8}));
  ASSERT_FALSE(axis->report().topology_matches);
  int grids = 0;
  const auto make = [&](double) { return ++grids, axis; };
  const auto certify = [](const AxisCandidate&) { return Certificate{}; };
  const CertifiedAxes found = certified_axes({0, true, make}, certify, {.style = OptionStyle::command_line});
  EXPECT_EQ(grids, 1) << "another grid would have the same model";
  EXPECT_TRUE(found.axes.front().certificate.holds());
  EXPECT_FALSE(found.holds());
  EXPECT_EQ(found.mismatches, model_problems(axis->report(), OptionStyle::command_line));
}

TEST(ModelProblems, NameTheBodyAndTheOption) {
  MedialAxisReport report;
  report.bodies.resize(2);
  report.bodies[0].topology_matches = true;
  report.bodies[1].spacing = 0.5;
  report.bodies[1].failures = {{.low = {0, 0, 0}, .high = {2, 2, 2}}};
  const std::vector<std::string> problems = model_problems(report, OptionStyle::command_line);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems.front().find("the model of body 2 with voxels of side 0.5 fails in 1 place, the first one at "
                                  "(1, 1, 1)"),
            std::string::npos)
      << problems.front();
  EXPECT_NE(problems.front().find("raise --max-resolution"), std::string::npos) << problems.front();
}

}  // namespace
}  // namespace blum
