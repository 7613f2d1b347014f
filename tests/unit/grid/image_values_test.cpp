// Proves the facts about an image's values: range, and labels with voxels, volumes and topology. If a selection is
// empty, the message names the existing values.
#include "blum/grid/image_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace blum {
namespace {

template <class T>
VoxelImage row_of(std::vector<T> values) {
  const auto length = static_cast<std::int64_t>(values.size());
  return {.grid = {{0, 0, 0}, {1, 2, 0.5}, {length, 1, 1}, {}}, .values = std::move(values)};
}

TEST(ImageValues, LabelsHaveVoxelsVolumesAndTopology) {
  const ImageValues values = image_values(row_of<std::int16_t>({0, 0, 3, 3, 0, 3, -1, 0}));
  ASSERT_TRUE(values.range && values.distinct);
  EXPECT_EQ(*values.range, (std::array<double, 2>{-1, 3}));
  EXPECT_EQ(*values.distinct, 3U);
  EXPECT_EQ(values.nonzero, 4U);
  ASSERT_EQ(values.labels.size(), 3U);
  EXPECT_EQ(values.labels[0].label, 0);
  EXPECT_FALSE(values.labels[0].betti);
  EXPECT_EQ(values.labels[1].label, 3);
  EXPECT_EQ(values.labels[1].voxels, 3U);
  EXPECT_DOUBLE_EQ(values.labels[1].volume, 3);
  EXPECT_EQ(values.labels[1].betti, (BettiNumbers{2, 0, 0}));
  EXPECT_EQ(values.labels[2].label, -1);
}

TEST(ImageValues, OnlyTheMostFrequentLabelsAreShown) {
  std::vector<std::uint32_t> values;
  for (std::uint32_t label = 1; label <= 50; ++label) values.insert(values.end(), label, label);
  const ImageValues found = image_values(row_of(std::move(values)), 4);
  EXPECT_EQ(found.distinct, 50U);
  ASSERT_EQ(found.labels.size(), 4U);
  EXPECT_EQ(found.labels.front().label, 50);
  EXPECT_EQ(found.labels.back().label, 47);
}

TEST(ImageValues, FractionsAreNotLabels) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ImageValues found = image_values(row_of<double>({0.5, nan, 2, 2}));
  EXPECT_FALSE(found.distinct);
  EXPECT_TRUE(found.labels.empty());
  EXPECT_EQ(found.not_numbers, 1U);
  EXPECT_FALSE(image_values(row_of<double>({nan, nan})).range);
}

TEST(ImageValues, MessagesAboutMissingLabelsListExistingOnes) {
  const auto told = [](const VoxelImage& image, const LabelSelection& selection) {
    return nothing_selected_text(image, selection);
  };
  EXPECT_EQ(told(row_of<std::uint8_t>({0, 2, 1, 2}), LabelSelection::of_label(7)),
            "no voxel of the image has the label 7: its labels are 1 and 2");
  EXPECT_EQ(told(row_of<std::uint8_t>({0, 0}), LabelSelection::of_label(7)),
            "no voxel of the image has the label 7: its labels are 0 only");
  EXPECT_EQ(told(row_of<float>({0.5F, 2}), LabelSelection::at_least(3)),
            "no voxel of the image reaches the threshold 3: its values are 0.5 to 2");
  EXPECT_EQ(told(row_of<float>({0, 0}), {}), "no voxel of the image is selected: none differs from 0");
  std::vector<std::int64_t> many(30);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<std::int64_t>(i);
  EXPECT_EQ(told(row_of(many), LabelSelection::of_label(99)),
            "no voxel of the image has the label 99: its labels are 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 19 more");
}

TEST(ImageValues, LabelAndThresholdExcludeEachOther) {
  EXPECT_EQ(LabelSelection::of(7, {}).label, 7);
  EXPECT_EQ(LabelSelection::of({}, 0.5).threshold, 0.5);
  EXPECT_EQ(LabelSelection::of({}, {}).rule, LabelSelection::Rule::nonzero);
  EXPECT_THROW((void)LabelSelection::of(7, 0.5), InvalidOption);
}

std::string rounding_error(const VoxelImage& image, std::vector<std::int64_t> labels) {
  try {
    return rounded_labels(image, labels) ? "rounded" : "as they are";
  } catch (const InvalidImage& error) {
    return error.what();
  }
}

TEST(RoundedLabels, AreRoundedIfAllValuesAreNearlyWhole) {
  const auto rounded = rounded_labels(row_of<float>({-0.0004F, 7000.9995F, 2.99F, std::nanf(""), -1.009F, 5}));
  ASSERT_TRUE(rounded);
  const auto& values = std::get<std::vector<float>>(rounded->values);
  EXPECT_EQ(values[0], 0.0F);
  EXPECT_EQ(values[1], 7001.0F);
  EXPECT_EQ(values[2], 3.0F);
  EXPECT_TRUE(std::isnan(values[3]));
  EXPECT_EQ(values[4], -1.0F);
  EXPECT_EQ(values[5], 5.0F);
  EXPECT_EQ(rounded->warning.code, WarningCode::rounded);
  EXPECT_NE(rounded->warning.text.find("4 voxels have labels that are not quite whole"), std::string::npos);
}

TEST(RoundedLabels, AreLeftAloneWhereRoundingIsNotNeededOrNotSafe) {
  EXPECT_EQ(rounding_error(row_of<double>({0, 1, 2, std::nan("")}), {}), "as they are");
  EXPECT_EQ(rounding_error(row_of<std::int16_t>({0, 1, 2}), {1}), "as they are");
  EXPECT_EQ(rounding_error(row_of<double>({0, 0.999, 2.5}), {}), "as they are");
  EXPECT_EQ(rounding_error(row_of<double>({0, 0.999, 2.5}), {2}), "as they are");
  EXPECT_EQ(rounding_error(row_of<double>({0, 0.98}), {1}), "as they are");
  EXPECT_EQ(rounding_error(row_of<double>({0.999, std::numeric_limits<double>::infinity()}), {}), "as they are");
  EXPECT_EQ(rounding_error(row_of<double>({0, 0.98}), {1, 0}), "as they are");
  EXPECT_EQ(rounding_error(row_of<double>({0, 0.991}), {1}), "rounded");
}

TEST(RoundedLabels, AreAnErrorIfALabelIsNearlyThereAndOthersAreNot) {
  const std::string text = rounding_error(row_of<double>({0, 0.999, 2.5}), {4, 1});
  EXPECT_NE(text.find("has the value 0.999, which is nearly the label 1"), std::string::npos) << text;
  EXPECT_NE(text.find("for example 2.5"), std::string::npos) << text;
}

}  // namespace
}  // namespace blum
