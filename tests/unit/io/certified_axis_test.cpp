// Proves that an axis is taken in the best of its forms that is certified, and that it is told why not in a better one.
#include "blum/io/certified_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

void expect_same(const Complex& a, const Complex& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(CertifiedAxis, TheBestFormOfABoxIsCertified) {
  const TriangleMesh box = make_box({});
  const MedialAxis axis = medial_axis(box, {.resolution = 24});
  const CertifiedAxis found = certified_axis(axis, box, 60);
  EXPECT_TRUE(found.certificate.holds());
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_LE(found.axis.deviation, 0.25 * least_spacing(axis.report()));
  EXPECT_LT(found.axis.axis.triangles.size(), 200U);
  EXPECT_EQ(found.certificate.checked.theta, 60);
  EXPECT_EQ(found.certificate.checked.lambda, 0);
}

/// Nothing is seen at more than 180 degrees, so that nothing of it can be missing.
TEST(CertifiedAxis, AtTheLargestAngleOnlyTheTopologyIsLeft) {
  const TriangleMesh plate = make_box({.size = {4, 2, 0.5}});
  const CertifiedAxis found = certified_axis(medial_axis(plate, {.resolution = 32}), plate, 180);
  EXPECT_TRUE(found.certificate.holds()) << found.certificate.mismatches.front();
  EXPECT_EQ(found.axis.axis.positions.size(), 1U);
}

TEST(CertifiedAxis, WithoutAToleranceAllVerticesStay) {
  const TriangleMesh box = make_box({});
  const MedialAxis axis = medial_axis(box, {.resolution = 24});
  const CertifiedAxis found = certified_axis(axis, box, 60, 0.0);
  EXPECT_TRUE(found.certificate.holds());
  expect_same(found.axis.axis, axis.simplify(60));
  EXPECT_THROW(static_cast<void>(certified_axis(axis, box, 60, -1.0)), InvalidOption);
}

TEST(CertifiedAxis, FormsAreTriedInTurnAndItIsToldWhatFailed) {
  const TriangleMesh box = make_box({});
  const MedialAxis axis = medial_axis(box, {.resolution = 16});
  const std::vector<AxisForm> forms = axis_forms(axis.report());
  ASSERT_EQ(forms.size(), 3U);
  EXPECT_TRUE(forms[0].is_fitted);
  EXPECT_NEAR(*forms[0].tolerance, 0.25 * least_spacing(axis.report()), 1e-15);
  EXPECT_FALSE(forms[2].tolerance.has_value());
  const auto make = [&](const AxisForm& form) { return axis_in_form(axis, 60, form); };
  // Certificates that hold from the n-th form on.
  const auto found_from = [&](int n) {
    return first_certified(forms, make, [&](const DecimatedAxis&) {
      Certificate certificate;
      if (n-- > 0) certificate.mismatches = {"something is wrong"};
      return certificate;
    });
  };
  EXPECT_TRUE(found_from(0).warnings.empty());
  const CertifiedAxis second = found_from(1);
  EXPECT_EQ(
      second.warnings,
      (std::vector<std::string>{"borders of sheets stay at the cells of the grid: elsewhere, something is wrong"}));
  expect_same(second.axis.axis, decimate(axis.simplify(60), *forms[1].tolerance).axis);
  EXPECT_EQ(found_from(2).warnings.size(), 2U);
  const CertifiedAxis none = found_from(3);
  EXPECT_FALSE(none.certificate.holds());
  EXPECT_TRUE(none.warnings.empty()) << "its certificate says why";
  expect_same(none.axis.axis, axis.simplify(60));
}

TEST(CertifiedAxis, OfAMeshIsThatOfItsAxis) {
  const TriangleMesh box = make_box({});
  const CertifiedAxis found = certified_axis(box, 60, {.resolution = 24});
  EXPECT_TRUE(found.certificate.holds());
  EXPECT_TRUE(found.warnings.empty());
  expect_same(found.axis.axis, certified_axis(medial_axis(box, {.resolution = 24}), box, 60).axis.axis);
}

TEST(CertifiedAxis, MovedGridsAreTriedInTurnWhereNothingElseHolds) {
  std::vector<double> shifts;
  // Certificates that hold from the n-th grid on.
  const auto found_from = [&](int n, double shift) {
    shifts.clear();
    const auto make = [&](double moved) {
      shifts.push_back(moved);
      CertifiedAxis made;
      made.axis.deviation = moved;
      if (n-- > 0) made.certificate.mismatches = {"something is wrong"};
      return made;
    };
    return certified_on_some_grid(make(shift), shift, make);
  };
  EXPECT_TRUE(found_from(0, 0).warnings.empty());
  EXPECT_EQ(shifts, std::vector<double>{0});
  const CertifiedAxis third = found_from(2, 0);
  EXPECT_EQ(shifts, (std::vector<double>{0, 0.3, -0.3}));
  EXPECT_EQ(third.axis.deviation, -0.3);
  EXPECT_EQ(third.warnings,
            std::vector<std::string>{"the grid was moved by -0.3 voxels: as it was, something is wrong"});
  const CertifiedAxis none = found_from(9, 0);
  EXPECT_EQ(shifts.size(), 1 + moved_grids(0).size());
  EXPECT_FALSE(none.certificate.holds());
  EXPECT_EQ(none.axis.deviation, 0) << "the first one";
  EXPECT_EQ(found_from(1, 0.9).warnings.front(), "the grid was moved by -0.3 voxels: as it was, something is wrong");
  static_cast<void>(found_from(9, 0.9));
  for (const double shift : shifts) EXPECT_LE(std::abs(shift), 1) << "what medial_axis() allows";
  std::sort(shifts.begin(), shifts.end());
  EXPECT_EQ(std::unique(shifts.begin(), shifts.end()), shifts.end()) << "each grid once";
}

}  // namespace
}  // namespace blum
