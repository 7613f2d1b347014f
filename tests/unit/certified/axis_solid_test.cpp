// Proves which options of a solid are used if they differ from the claims of its axis, and which warnings are reported.

#include "blum/certified/axis_solid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace blum {
namespace {

AxisSolid of_image(const SolidSelection& given, const MedialMetadata& axis) {
  return solid_of_axis(given, true, axis, "the axis", OptionStyle::python);
}

TEST(AxisSolid, ClaimsOfTheAxisReplaceMissingOptions) {
  MedialMetadata axis;
  axis.label = 3;
  axis.weld = 0.5;
  EXPECT_EQ(of_image({}, axis).selection.label, 3);
  EXPECT_EQ(solid_of_axis({}, false, axis, "a", OptionStyle::python).selection.weld, 0.5);
  EXPECT_TRUE(of_image({}, axis).warnings.empty());
}

TEST(AxisSolid, OptionsTakePrecedenceAndContradictionsCauseWarnings) {
  MedialMetadata axis;
  axis.label = 3;
  const auto [used, warnings] = of_image({.threshold = 2.5}, axis);
  EXPECT_FALSE(used.label);
  EXPECT_EQ(used.threshold, 2.5);
  EXPECT_EQ(warnings.front().text, "the axis was computed with label=3; threshold=2.5 is used, because it was given");
  EXPECT_TRUE(of_image({.label = 3}, axis).warnings.empty());
  EXPECT_TRUE(of_image({.label = 1}, {}).warnings.empty()) << "the axis says nothing";
}

TEST(AxisSolid, ComparesNumbersInsteadOfTheirTexts) {
  MedialMetadata axis;
  axis.threshold = 1;
  const double close = 1 + std::numeric_limits<double>::epsilon();
  EXPECT_FALSE(of_image({.threshold = close}, axis).warnings.empty());
}

TEST(AxisSolid, EachInputUsesOnlyItsOwnOptions) {
  MedialMetadata axis;
  axis.label = 3;
  axis.weld = 1e-6;
  EXPECT_TRUE(of_image({.weld = 0.0}, axis).warnings.empty());
  EXPECT_EQ(of_image({.weld = 0.0}, axis).selection.label, 3);
  EXPECT_TRUE(solid_of_axis({.label = 1}, false, axis, "a", OptionStyle::python).warnings.empty());
  EXPECT_EQ(solid_of_axis({.weld = 0.0}, false, axis, "'a.npz'", OptionStyle::command_line).warnings.front().text,
            "'a.npz' was computed with --weld 1e-06; --weld is used, because it was given");
  EXPECT_EQ(solid_of_axis({.weld = 0.0}, false, axis, "the axis", OptionStyle::python).warnings.front().text,
            "the axis was computed with weld=1e-06; weld=0 is used, because it was given");
}

}  // namespace
}  // namespace blum
