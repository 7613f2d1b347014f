// Proves on every back end that the distance transform of images equals brute force in distance, closest voxel, ties,
// sign and band. Images are random or degenerate, of every value type, with exact and inexact spacings. The bytes are
// the same for any number of threads, and on the CPU for every instruction set.
#include "blum/field/distance_transform.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <stop_token>
#include <string>

#include "blum/core/error.hpp"
#include "blum/field/image_reference.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "support/back_ends.hpp"
#include "support/field_check.hpp"

namespace blum {
namespace {

using Size = std::array<std::int64_t, 3>;

VoxelImage random_image(const Size& size, const Vec3d& spacing, double density, unsigned seed) {
  VoxelImage image;
  image.grid.size = size;
  image.grid.spacing = spacing;
  std::vector<std::uint8_t> values(image.grid.node_count());
  std::mt19937 random(seed);
  std::bernoulli_distribution selected(density);
  for (auto& value : values) value = selected(random) ? 1 : 0;
  image.values = std::move(values);
  return image;
}

std::vector<std::uint8_t> mask_of(const VoxelImage& image) {
  return std::get<std::vector<std::uint8_t>>(image.values);
}

bool has_both_kinds(const std::vector<std::uint8_t>& mask) {
  std::size_t count = 0;
  for (const auto value : mask) count += value != 0 ? 1U : 0U;
  return count > 0 && count < mask.size();
}

std::vector<std::uint8_t> inverted(std::vector<std::uint8_t> mask) {
  for (auto& value : mask) value = value != 0 ? 0 : 1;
  return mask;
}

/// Compares every voxel (or every `step`-th) with brute force. `exact` means that the spacings make squared distances
/// exact. Then distances must be correctly rounded, and ties must select the smallest index.
void expect_brute_force(const VoxelImage& image, const std::vector<std::uint8_t>& mask, const Field& field, bool exact,
                        std::size_t step = 1) {
  const bool is_signed = field.sign_rule == SignRule::label;
  const auto outside = inverted(mask);
  for (std::size_t voxel = 0; voxel < mask.size(); voxel += step) {
    const bool inside = is_signed && mask[voxel] != 0;
    const auto expected = reference::nearest_voxel(image.grid, inside ? outside : mask, voxel);
    const double distance = std::sqrt(expected.squared);
    const float sign = inside ? -1.0F : 1.0F;
    const SiteId site = field.site[voxel];
    if (exact) {
      ASSERT_EQ(field.distance[voxel], sign * static_cast<float>(distance)) << "voxel " << voxel;
      ASSERT_EQ(site, expected.site) << "voxel " << voxel;
    } else {
      ASSERT_NEAR(field.distance[voxel], sign * distance, 1.2e-7 * distance) << "voxel " << voxel;
      ASSERT_LT(site.value, mask.size());
      ASSERT_NE((inside ? outside : mask)[site.value], 0);
      ASSERT_LE(reference::squared_distance(image.grid, voxel, site.value), expected.squared * (1 + 1e-14));
    }
  }
}

constexpr std::array<Size, 14> sizes = {{{1, 1, 3},
                                         {1, 37, 1},
                                         {70, 1, 1},
                                         {2, 1, 1},
                                         {1, 9, 21},
                                         {33, 1, 5},
                                         {65, 7, 1},
                                         {2, 40, 3},
                                         {16, 16, 16},
                                         {17, 13, 11},
                                         {15, 1, 40},
                                         {31, 9, 14},
                                         {3, 33, 29},
                                         {80, 5, 6}}};

class DistanceTransform : public test::BackEndTest {
 protected:
  /// Returns the transform. Expects that the transform without sites has the same bytes of distances.
  [[nodiscard]] Field transform(const VoxelImageView& image, const DistanceTransformOptions& options = {},
                                const Context& how = {}) const {
    Field field = distance_transform(image, options, context(how));
    EXPECT_EQ(field.device, device());
    DistanceTransformOptions without = options;
    without.sites = false;
    const Field half = distance_transform(image, without, context(how));
    EXPECT_TRUE(half.site.empty());
    EXPECT_TRUE(std::ranges::equal(std::as_bytes(half.distance.span()), std::as_bytes(field.distance.span())));
    return field;
  }

  /// Expects that an image of another value type gives the field of its mask.
  template <class T>
  void expect_selects(const std::vector<T>& values, const LabelSelection& selection,
                      const std::vector<bool>& selected) const {
    VoxelImage image;
    image.grid.size = {static_cast<std::int64_t>(values.size()), 1, 1};
    image.values = values;
    const Field field = transform(image, {.selection = selection, .is_signed = false});
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_EQ(field.distance[i] == 0.0F, selected[i])
          << "value " << +values[i] << " at " << i << " of type " << image.values.index();
    }
  }

  template <class T>
  void expect_labels_and_thresholds() const;

  [[nodiscard]] std::string message_of(const VoxelImage& image, const DistanceTransformOptions& options = {}) const {
    try {
      (void)transform(image, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

INSTANTIATE_TEST_SUITE_P(On, DistanceTransform, test::every_back_end(), test::back_end_name);

TEST_P(DistanceTransform, EqualsBruteForceWhereSquaresAreExact) {
  unsigned seed = 0;
  int compared = 0;  // of 420; the others contain only one kind of voxel
  for (const Vec3d spacing : {Vec3d{1, 1, 1}, {1, 1, 3}, {3, 3, 3}, {0.5, 0.75, 1}, {5, 2, 1}}) {
    for (const Size& size : sizes) {
      for (const double density : {0.001, 0.03, 0.3, 0.5, 0.9, 0.999}) {
        const VoxelImage image = random_image(size, spacing, density, ++seed);
        const auto mask = mask_of(image);
        if (!has_both_kinds(mask)) continue;
        SCOPED_TRACE(testing::Message() << size[0] << "x" << size[1] << "x" << size[2] << " spacing " << spacing.x
                                        << " " << spacing.y << " " << spacing.z << " density " << density);
        const std::size_t step = mask.size() > 1000 ? 5 : 1;  // brute force is slow; 5 visits every column and row
        expect_brute_force(image, mask, transform(image), true, step);
        expect_brute_force(image, mask, transform(image, {.is_signed = false}), true, step);
        if (HasFatalFailure()) return;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 250);
}

TEST_P(DistanceTransform, EqualsBruteForceWithinRoundingForAnySpacing) {
  unsigned seed = 1000;
  for (const Vec3d spacing : {Vec3d{0.3, 0.7, 1.1},
                              {1e-9, 1.3e-9, 1e-9},
                              {1e12, 3.3e11, 7.7e11},
                              {0.1, 0.1, 0.1},
                              {1, 1e-3, 3.14159},
                              {0.488281, 0.488281, 1.25},
                              {1e-30, 1.7e-30, 1e-30}}) {
    for (const Size& size : sizes) {
      for (const double density : {0.01, 0.5, 0.97}) {
        const VoxelImage image = random_image(size, spacing, density, ++seed);
        const auto mask = mask_of(image);
        if (!has_both_kinds(mask)) continue;
        SCOPED_TRACE(testing::Message() << size[0] << "x" << size[1] << "x" << size[2] << " spacing " << spacing.x);
        const std::size_t step = mask.size() > 1000 ? 7 : 1;
        expect_brute_force(image, mask, transform(image), false, step);
        expect_brute_force(image, mask, transform(image, {.is_signed = false}), false, step);
        if (HasFatalFailure()) return;
      }
    }
  }
}

/// Returns a shape whose closest voxels differ much between neighbouring columns: a solid ball (signed: its centre), a
/// thin sphere, or alternating distant stripes.
VoxelImage shape_image(std::int64_t n, const Vec3d& spacing, int shape) {
  VoxelImage image = random_image({n, n, n}, spacing, 0, 0);
  auto& values = std::get<std::vector<std::uint8_t>>(image.values);
  const double centre = static_cast<double>(n - 1) / 2;
  for (std::int64_t k = 0; k < n; ++k) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i) {
        const Vec3d p{static_cast<double>(i) - centre, static_cast<double>(j) - centre,
                      static_cast<double>(k) - centre};
        const double r = length(p) / centre;
        bool selected = false;
        if (shape == 0) selected = r < 0.9;
        if (shape == 1) selected = r > 0.95;
        if (shape == 2) selected = i % 2 == 0 ? j == 0 || k == 0 : j == n - 1 || k == n - 1;
        if (shape == 3) selected = i % 2 == 0 ? (j + k) % 3 == 0 : r > 1.1;
        values[image.grid.index(i, j, k)] = selected ? 1 : 0;
      }
    }
  }
  return image;
}

TEST_P(DistanceTransform, EqualsBruteForceOnShapes) {
  for (int shape = 0; shape < 4; ++shape) {
    const VoxelImage image = shape_image(37, {1, 1, 1}, shape);
    const auto mask = mask_of(image);
    SCOPED_TRACE(shape);
    expect_brute_force(image, mask, transform(image), true, 37);
    expect_brute_force(image, mask, transform(image, {.is_signed = false}), true, 37);
    const VoxelImage stretched = shape_image(37, {1, 0.7, 1.3}, shape);
    expect_brute_force(stretched, mask, transform(stretched), false, 37);
    if (HasFatalFailure()) return;
  }
}

TEST_P(DistanceTransform, TiesGoToTheSmallestIndex) {
  VoxelImage image = random_image({3, 3, 3}, {1, 1, 1}, 0, 0);
  auto& values = std::get<std::vector<std::uint8_t>>(image.values);
  for (const std::size_t site : {4U, 10U, 12U, 14U, 16U, 22U}) values[site] = 1;  // the six neighbours of the centre
  EXPECT_EQ(transform(image).site[13], SiteId(4));
  values[4] = 0;
  EXPECT_EQ(transform(image).site[13], SiteId(10));
  values[10] = 0;
  EXPECT_EQ(transform(image).site[13], SiteId(12));
}

TEST_P(DistanceTransform, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const Vec3d spacing : {Vec3d{1, 1, 1}, {0.3, 0.7, 1.1}}) {
    for (const Size size : {Size{130, 61, 50}, Size{1500, 900, 1}}) {
      for (const double density : {0.0005, 0.5}) {
        const VoxelImage image = random_image(size, spacing, density, 5);
        const Field one = transform(image, {}, {.threads = 1});
        EXPECT_TRUE(test::same_bytes(one, transform(image, {}, {.threads = 2})));
        EXPECT_TRUE(test::same_bytes(one, transform(image, {}, {.threads = 7})));
      }
    }
  }
}

TEST(DistanceTransformOnTheCpu, EveryInstructionSetGivesTheSameField) {
  for (const Vec3d spacing : {Vec3d{1, 1, 1}, {1, 1, 3}, {0.5, 0.7, 1.1}}) {
    const VoxelImage random = random_image({45, 31, 38}, spacing, 0.01, 11);
    const VoxelImage striped = shape_image(40, spacing, 3);  // neighbouring columns disagree, so each is solved alone
    const std::array<Field, 2> best = {distance_transform(random), distance_transform(striped)};
    for (const std::string& target : cpu::simd_targets()) {
      SCOPED_TRACE(target);
      cpu::use_simd_target(target);
      EXPECT_TRUE(test::same_bytes(best[0], distance_transform(random)));
      EXPECT_TRUE(test::same_bytes(best[1], distance_transform(striped)));
      expect_brute_force(random, mask_of(random), distance_transform(random), spacing.x == 1.0, 97);
    }
    cpu::use_simd_target("");
  }
}

/// Rows are far apart along x, so columns are independent, and the sites alternate between the ends. The closest rows
/// of neighbouring columns are 599 apart, so the passes solve each column alone.
TEST_P(DistanceTransform, ColumnsThatDisagreeEqualBruteForce) {
  for (const double spacing : {1000.0, 1000.3}) {
    for (const Size size : {Size{32, 600, 2}, Size{32, 2, 600}}) {
      VoxelImage image = random_image(size, {spacing, 1, 1}, 0, 0);
      auto& values = std::get<std::vector<std::uint8_t>>(image.values);
      for (std::int64_t i = 0; i < 32; ++i) {
        values[i % 2 == 0 ? image.grid.index(i, 0, 0) : image.grid.index(i, size[1] - 1, size[2] - 1)] = 1;
      }
      for (const bool is_signed : {false, true}) {
        expect_brute_force(image, mask_of(image), transform(image, {.is_signed = is_signed}), spacing == 1000.0, 29);
      }
    }
  }
}

TEST_P(DistanceTransform, LargePlanesEqualBruteForce) {
  const VoxelImage image = random_image({1500, 900, 1}, {1, 1, 1}, 0.0001, 6);
  expect_brute_force(image, mask_of(image), transform(image), true, 30011);
}

TEST_P(DistanceTransform, DistancesOfExactlyTheBandAreWithinIt) {
  for (const double step : {1.0, 0.7, 0.1, 0.3, 1.0 / 3, 1e-3, 123.4}) {
    for (const int steps : {1, 2, 3}) {
      VoxelImage image;
      image.grid.size = {9, 1, 1};
      image.grid.spacing = {step, 5 * step, step};
      image.values = std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0};
      const Field field = transform(image, {.band = steps * step});
      for (int i = 0; i < 9; ++i) {
        EXPECT_EQ(field.site[static_cast<std::size_t>(i)].has_value(), std::abs(i - 4) <= steps)
            << "voxel " << i << ", band of " << steps << " steps of " << step;
      }
    }
  }
}

TEST_P(DistanceTransform, LayersWithoutNeighboursMayHaveAnySpacing) {
  VoxelImage image;
  image.grid.size = {3, 1, 1};
  image.grid.spacing = {1, 1e38, 1e-40};
  image.values = std::vector<std::uint8_t>{1, 0, 0};
  EXPECT_EQ(transform(image).distance[2], 2.0F);
}

TEST_P(DistanceTransform, BandClipsDistancesAndSites) {
  const VoxelImage image = random_image({40, 30, 20}, {1, 1, 1}, 0.001, 7);
  const Field full = transform(image);
  const Field banded = transform(image, {.band = 5.0});
  EXPECT_EQ(banded.band, 5.0);
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < full.distance.size(); ++i) {
    if (std::abs(full.distance[i]) <= 5.0F) {
      ASSERT_EQ(banded.distance[i], full.distance[i]);
      ASSERT_EQ(banded.site[i], full.site[i]);
    } else {
      ASSERT_EQ(banded.distance[i], std::copysign(5.0F, full.distance[i]));
      ASSERT_EQ(banded.site[i], SiteId::none());
      ++beyond;
    }
  }
  EXPECT_GT(beyond, 100U);
  EXPECT_LT(beyond, full.distance.size() - 100);
}

TEST_P(DistanceTransform, KeepsTheGridAndNamesItsSignRule) {
  VoxelImage image = random_image({4, 5, 6}, {1, 2, 3}, 0.5, 8);
  image.grid.origin = {7, 8, 9};
  image.grid.direction = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
  const Field field = transform(image);
  EXPECT_EQ(field.grid, image.grid);
  EXPECT_EQ(field.site_ids, SiteIds::voxels);
  EXPECT_EQ(field.sign_rule, SignRule::label);
  EXPECT_EQ(transform(image, {.is_signed = false}).sign_rule, SignRule::none);
}

template <class T>
void DistanceTransform::expect_labels_and_thresholds() const {
  const T low = std::numeric_limits<T>::lowest();
  const T high = std::numeric_limits<T>::max();
  const std::vector<T> values = {0, 3, low, high, 4, 100, 3};
  const bool lowest_is_zero = low == T(0);
  expect_selects<T>(values, {}, {false, true, !lowest_is_zero, true, true, true, true});
  expect_selects<T>(values, LabelSelection::of_label(3), {false, true, false, false, false, false, true});
  expect_selects<T>(values, LabelSelection::at_least(3.5), {false, false, false, true, true, true, false});
  expect_selects<T>(values, LabelSelection::at_least(4), {false, false, false, true, true, true, false});
  expect_selects<T>(values, LabelSelection::at_least(-1e300),
                    {true, true, !std::is_same_v<T, double>, true, true, true, true});
  VoxelImage image;
  image.grid.size = {7, 1, 1};
  image.values = values;
  EXPECT_THROW((void)transform(image, {.selection = LabelSelection::of_label(77)}), InvalidImage);
}

TEST_P(DistanceTransform, SelectsLabelsAndThresholdsOfEveryType) {
  expect_labels_and_thresholds<std::uint8_t>();
  expect_labels_and_thresholds<std::int8_t>();
  expect_labels_and_thresholds<std::uint16_t>();
  expect_labels_and_thresholds<std::int16_t>();
  expect_labels_and_thresholds<std::uint32_t>();
  expect_labels_and_thresholds<std::int32_t>();
  expect_labels_and_thresholds<std::uint64_t>();
  expect_labels_and_thresholds<std::int64_t>();
  expect_labels_and_thresholds<float>();
  expect_labels_and_thresholds<double>();
}

TEST_P(DistanceTransform, SelectsExactlyAtTheLimitsOfTypes) {
  constexpr std::int64_t large = (std::int64_t{1} << 53) + 1;  // not a double
  expect_selects<std::int64_t>({large, large - 1, large + 1}, LabelSelection::of_label(large), {true, false, false});
  expect_selects<double>({9007199254740992.0, 5}, LabelSelection::of_label(5), {false, true});
  VoxelImage image;
  image.grid.size = {2, 1, 1};
  image.values = std::vector<double>{9007199254740992.0, 0};
  EXPECT_THROW((void)transform(image, {.selection = LabelSelection::of_label(large)}), InvalidImage);
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_selects<double>({infinity, 1, nan, -infinity}, LabelSelection::at_least(infinity),
                         {true, false, false, false});
  expect_selects<double>({infinity, 1, nan, -infinity}, LabelSelection::at_least(-infinity), {true, true, false, true});
  expect_selects<double>({0, nan, -1e-320, 1}, {}, {false, false, true, true});
  const auto inf = static_cast<float>(infinity);
  expect_selects<float>({inf, 3e38F, -inf}, LabelSelection::at_least(1e300), {true, false, false});
  expect_selects<float>({0.1F, 0.2F}, LabelSelection::at_least(0.1), {true, true});                // 0.1F is above 0.1
  expect_selects<float>({0.3F, 0.7F, 0.8F}, LabelSelection::at_least(0.7), {false, false, true});  // 0.7F is below 0.7
  expect_selects<std::uint8_t>({255, 254}, LabelSelection::at_least(254.5), {true, false});
  EXPECT_THROW((void)transform(image, {.selection = LabelSelection::at_least(nan)}), InvalidOption);
}

TEST_P(DistanceTransform, SeveralLabelsEqualOneByOne) {
  VoxelImage image = random_image({50, 40, 30}, {1, 1, 2}, 0, 0);
  auto& values = std::get<std::vector<std::uint8_t>>(image.values);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>((i / 7 + i / 1999) % 4);
  const std::array<LabelSelection, 4> selections = {LabelSelection::of_label(1), LabelSelection::of_label(3),
                                                    LabelSelection::at_least(2), LabelSelection{}};
  const auto fields = distance_transforms(image, selections, {}, context());
  ASSERT_EQ(fields.size(), selections.size());
  for (std::size_t i = 0; i < selections.size(); ++i) {
    EXPECT_TRUE(test::same_bytes(fields[i], transform(image, {.selection = selections[i]})));
  }
  EXPECT_TRUE(distance_transforms(image, {}, {}, context()).empty());
}

TEST_P(DistanceTransform, RefusesImagesWithoutTwoKinds) {
  const VoxelImage empty = random_image({3, 4, 5}, {1, 1, 1}, 0, 0);
  const VoxelImage full = random_image({3, 4, 5}, {1, 1, 1}, 1, 0);
  EXPECT_THROW((void)transform(empty), InvalidImage);
  EXPECT_THROW((void)transform(empty, {.is_signed = false}), InvalidImage);
  EXPECT_THROW((void)transform(full), InvalidImage);
  EXPECT_NE(message_of(full).find("every voxel"), std::string::npos);
  EXPECT_NE(message_of(empty, {.selection = LabelSelection::of_label(9)}).find("label 9"), std::string::npos);
  const Field zero = transform(full, {.is_signed = false});
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(zero.distance[i], 0.0F);
    EXPECT_EQ(zero.site[i], SiteId(static_cast<std::uint32_t>(i)));
  }
  const VoxelImage one = random_image({1, 1, 1}, {1, 1, 1}, 1, 0);
  EXPECT_THROW((void)transform(one), InvalidImage);
  EXPECT_EQ(transform(one, {.is_signed = false}).distance[0], 0.0F);
  VoxelImage broken = one;
  broken.values = std::vector<float>(2);
  EXPECT_THROW((void)transform(broken), InvalidImage);
  EXPECT_THROW((void)transform(one, {.is_signed = false, .band = 0.0}), InvalidOption);
  EXPECT_THROW((void)transform(one, {.is_signed = false, .band = std::nan("")}), InvalidOption);
}

TEST(DistanceTransformOnTheCpu, StopsWhenAskedAndReportsProgress) {
  const VoxelImage image = random_image({200, 200, 100}, {1, 1, 1}, 0.01, 9);
  std::stop_source source;
  int calls = 0;
  const auto stop = [&](double, std::string_view) {
    if (++calls == 3) source.request_stop();
  };
  EXPECT_THROW((void)distance_transform(image, {}, {.threads = 2, .progress = stop, .cancel = source.get_token()}),
               Cancelled);
  std::vector<std::string> phases;
  const auto record = [&](double fraction, std::string_view phase) {
    EXPECT_GE(fraction, 0.0);
    EXPECT_LE(fraction, 1.0);
    if (phases.empty() || phases.back() != phase) phases.emplace_back(phase);
  };
  (void)distance_transform(image, {}, {.threads = 2, .progress = record});
  EXPECT_EQ(phases, (std::vector<std::string>{"select voxels", "rows and columns", "depth"}));
}

TEST_P(DistanceTransform, DoesNotStartWhenAskedToStop) {
  std::stop_source stop;
  stop.request_stop();
  const VoxelImage image = random_image({20, 20, 20}, {1, 1, 1}, 0.1, 12);
  EXPECT_THROW((void)transform(image, {}, {.cancel = stop.get_token()}), Cancelled);
}

TEST_P(DistanceTransform, RefusesExtentsThatFloat32CannotHold) {
  for (const Vec3d& spacing : {Vec3d{1e200, 1e200, 1e200}, Vec3d{1, 1, 1e37}, Vec3d{1e-200, 1e-200, 1e-200}}) {
    VoxelImage image{.grid = {.spacing = spacing, .size = {4, 4, 4}}, .values = std::vector<std::uint8_t>(64)};
    std::get<std::vector<std::uint8_t>>(image.values)[21] = 1;
    EXPECT_THROW((void)transform(image), InvalidImage) << spacing.x << ' ' << spacing.y << ' ' << spacing.z;
  }
}

}  // namespace
}  // namespace blum
