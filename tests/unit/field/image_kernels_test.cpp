// Proves that the kernels of image transforms give the bytes of the CPU's transform in whole numbers. The tests vary
// shape, spacing, density, band and selection. On the emulated device, the cuts of columns do not matter either.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "blum/field/distance_transform.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "field/image_request.hpp"
#include "field/kernels/emulated_device.hpp"
#include "field/kernels/image_transform.hpp"
#include "support/back_ends.hpp"
#include "support/field_check.hpp"

namespace blum {
namespace {

using Size = std::array<std::int64_t, 3>;
using Mask = std::vector<std::uint8_t>;

constexpr kernels::BandTuning whole_columns{1, 1};
constexpr kernels::BandTuning many_bands{100000, 1};
constexpr kernels::BandTuning bands_of_three{100000, 3};
constexpr kernels::BandTuning bands_of_seven{100000, 7};

struct Result {
  std::vector<float> distance;
  std::vector<std::uint32_t> site;
};

Result transform(const VoxelImageView& image, const DistanceTransformOptions& options,
                 const kernels::BandTuning& tuning) {
  kernels::EmulatedDevice device;
  kernels::ImageTransform<kernels::EmulatedDevice> transform(device, tuning);
  transform.set_request(detail::make_image_request(image.grid, options));
  std::visit([&](const auto& values) { transform.select(values.data(), options.selection); }, image.values);
  Result result;
  result.distance.resize(image.grid.node_count());
  result.site.resize(image.grid.node_count());
  transform.run(result.distance.data(), result.site.data());
  return result;
}

VoxelImage image_of(const Size& size, const Vec3d& spacing, Mask mask) {
  VoxelImage image;
  image.grid.size = size;
  image.grid.spacing = spacing;
  image.values = std::move(mask);
  return image;
}

const Mask& mask_of(const VoxelImage& image) {
  return std::get<Mask>(image.values);
}

Mask random_mask(const Size& size, double density, unsigned seed) {
  Mask mask(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  std::mt19937 random(seed);
  std::bernoulli_distribution selected(density);
  for (auto& value : mask) value = selected(random) ? 1 : 0;
  return mask;
}

/// Returns a few balls, so that runs are long and bands cut them.
Mask ball_mask(const Size& size, unsigned seed) {
  Mask mask(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  std::mt19937 random(seed);
  const auto pick = [&](std::int64_t below) {
    return std::uniform_int_distribution<std::int64_t>(0, below - 1)(random);
  };
  for (int ball = 0; ball < 3; ++ball) {
    const Size center{pick(size[0]), pick(size[1]), pick(size[2])};
    const std::int64_t radius = 1 + pick(1 + std::max({size[0], size[1], size[2]}) / 3);
    for (std::size_t voxel = 0; voxel < mask.size(); ++voxel) {
      const auto index = static_cast<std::int64_t>(voxel);
      const Size at{index % size[0], index / size[0] % size[1], index / size[0] / size[1]};
      std::int64_t squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) squared += (at[axis] - center[axis]) * (at[axis] - center[axis]);
      if (squared <= radius * radius) mask[voxel] = 1;
    }
  }
  return mask;
}

bool has_both_kinds(const Mask& mask) {
  const auto count = static_cast<std::size_t>(std::count(mask.begin(), mask.end(), std::uint8_t{1}));
  return count > 0 && count < mask.size();
}

void expect_same_bytes(const Result& result, const Field& field) {
  for (std::size_t voxel = 0; voxel < result.site.size(); ++voxel) {
    ASSERT_EQ(result.site[voxel], field.site[voxel].value) << "voxel " << voxel;
  }
  ASSERT_EQ(std::memcmp(result.distance.data(), field.distance.data(), result.distance.size() * sizeof(float)), 0);
}

testing::Message describe(const Size& size, const Vec3d& spacing, unsigned seed) {
  return testing::Message() << size[0] << "x" << size[1] << "x" << size[2] << " spacing " << spacing.x << " "
                            << spacing.y << " " << spacing.z << " seed " << seed;
}

constexpr std::array<Size, 17> sizes = {{{1, 1, 3},
                                         {1, 37, 1},
                                         {70, 1, 1},
                                         {2, 1, 1},
                                         {1500, 1, 1},
                                         {1100, 3, 1},
                                         {1, 9, 21},
                                         {33, 1, 5},
                                         {65, 7, 1},
                                         {2, 40, 3},
                                         {16, 16, 16},
                                         {17, 13, 11},
                                         {15, 1, 40},
                                         {31, 9, 14},
                                         {3, 33, 29},
                                         {32, 5, 64},
                                         {80, 5, 6}}};
constexpr std::array<kernels::BandTuning, 4> tunings = {whole_columns, many_bands, bands_of_three, bands_of_seven};

class ImageKernels : public test::BackEndTest {
 protected:
  /// On the host, where cuts can be chosen, tries all of them.
  void expect_cpu_bytes(const VoxelImage& image, const DistanceTransformOptions& options) const {
    const Field field = distance_transform(image, options);
    ASSERT_TRUE(test::same_bytes(distance_transform(image, options, context()), field));
    if (GetParam() != test::BackEnd::host) return;
    for (const auto& tuning : tunings) {
      SCOPED_TRACE(testing::Message() << "bands of " << tuning.fewest_rows << (options.is_signed ? "" : " unsigned"));
      expect_same_bytes(transform(image, options, tuning), field);
      if (HasFatalFailure()) return;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(On, ImageKernels, test::cuda_back_ends(), test::back_end_name);

TEST_P(ImageKernels, EqualTheCpuByteForByteInWholeNumbers) {
  unsigned seed = 1000;
  int compared = 0;
  for (const Vec3d spacing : {Vec3d{1, 1, 1}, {1, 1, 3}, {3, 3, 3}, {0.5, 0.75, 1}, {7, 2, 1}, {1, 1, 200}}) {
    for (const Size& size : sizes) {
      for (const double density : {0.0, 0.001, 0.03, 0.3, 0.7, 0.97, 0.999}) {
        ++seed;
        // Density 0 selects balls.
        const VoxelImage image =
            image_of(size, spacing, density > 0 ? random_mask(size, density, seed) : ball_mask(size, seed));
        if (!has_both_kinds(mask_of(image))) continue;
        SCOPED_TRACE(describe(size, spacing, seed));
        for (const bool is_signed : {true, false}) {
          expect_cpu_bytes(image, {.is_signed = is_signed});
          if (seed % 3 == 0) expect_cpu_bytes(image, {.is_signed = is_signed, .band = 0.4 * (seed % 17) + 1});
          if (HasFatalFailure()) return;
        }
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 500);
}

TEST_P(ImageKernels, EqualTheCpuByteForByteForAnySpacing) {
  unsigned seed = 5000;
  for (const Vec3d spacing : {Vec3d{0.3, 0.7, 1.1},
                              {1e-9, 1.3e-9, 1e-9},
                              {1e12, 3.3e11, 7.7e11},
                              {1, 1e-3, 3.14159},
                              {0.488281, 0.488281, 1.25},
                              {1e-30, 1.7e-30, 1e-30}}) {
    for (const Size& size : sizes) {
      for (const double density : {0.0, 0.01, 0.5, 0.97}) {
        ++seed;
        const VoxelImage image =
            image_of(size, spacing, density > 0 ? random_mask(size, density, seed) : ball_mask(size, seed));
        if (!has_both_kinds(mask_of(image))) continue;
        SCOPED_TRACE(describe(size, spacing, seed));
        for (const bool is_signed : {true, false}) {
          expect_cpu_bytes(image, {.is_signed = is_signed});
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

/// Repeats the passes' arithmetic in double by brute force: the nearest voxel of each row, the nearest row of each
/// plane, then the nearest plane.
std::uint32_t lowest_as_computed(const detail::ImageRequest& plan, const Mask& targets, std::size_t voxel) {
  const std::size_t at[3] = {voxel % plan.size[0], voxel / plan.size[0] % plan.size[1],
                             voxel / plan.size[0] / plan.size[1]};
  const auto square = [&](std::size_t axis, std::size_t to) {
    const double step = static_cast<double>(to) - static_cast<double>(at[axis]);
    return step * step * plan.weight[axis];
  };
  std::uint32_t best = kernels::no_voxel;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t z = 0; z < plan.size[2]; ++z) {
    std::uint32_t best_of_plane = kernels::no_voxel;
    double lowest_of_plane = std::numeric_limits<double>::infinity();
    for (std::size_t index = z * plan.size[0] * plan.size[1]; index < (z + 1) * plan.size[0] * plan.size[1]; ++index) {
      if (targets[index] == 0) continue;
      const double cost = square(0, index % plan.size[0]) + square(1, index / plan.size[0] % plan.size[1]);
      if (!(cost < lowest_of_plane)) continue;
      lowest_of_plane = cost;
      best_of_plane = static_cast<std::uint32_t>(index);
    }
    if (!(lowest_of_plane + square(2, z) < lowest)) continue;
    lowest = lowest_of_plane + square(2, z);
    best = best_of_plane;
  }
  return best;
}

TEST(ImageKernelsAlone, ChooseTheLowestComputedDistanceInDouble) {
  unsigned seed = 9000;
  int compared = 0;
  for (const Vec3d spacing : {Vec3d{0.3, 0.7, 1.1}, {1.1, 0.3, 0.7}, {0.1, 0.1, 0.3}, {0.488281, 0.488281, 1.25}}) {
    for (const Size& size : {Size{19, 17, 23}, {5, 40, 31}, {24, 60, 1}, {9, 12, 40}}) {
      for (const double density : {0.004, 0.02, 0.1, 0.5}) {
        const VoxelImage image = image_of(size, spacing, random_mask(size, density, ++seed));
        const DistanceTransformOptions options{.is_signed = false};
        const detail::ImageRequest plan = detail::make_image_request(image.grid, options);
        if (plan.integer || !has_both_kinds(mask_of(image))) continue;
        SCOPED_TRACE(describe(size, spacing, seed));
        const Result result = transform(image, options, seed % 2 == 0 ? whole_columns : bands_of_seven);
        for (std::size_t voxel = seed % 3; voxel < result.site.size(); voxel += 3) {
          ASSERT_EQ(result.site[voxel], lowest_as_computed(plan, mask_of(image), voxel)) << "voxel " << voxel;
        }
        ++compared;
      }
    }
  }
  EXPECT_GE(compared, 40);
}

TEST_P(ImageKernels, OneVoxelOrAllButOne) {
  for (const Size& size : {Size{45, 38, 1}, {19, 23, 29}, {1, 64, 33}}) {
    const std::size_t count = static_cast<std::size_t>(size[0] * size[1] * size[2]);
    for (const std::size_t voxel : {std::size_t{0}, count / 2, count / 3, count - 1}) {
      for (const std::uint8_t value : {std::uint8_t{0}, std::uint8_t{1}}) {
        Mask mask(count, static_cast<std::uint8_t>(1 - value));
        mask[voxel] = value;
        for (const Vec3d spacing : {Vec3d{1, 1, 1}, {2, 1, 5}}) {
          const VoxelImage image = image_of(size, spacing, mask);
          for (const bool is_signed : {true, false}) expect_cpu_bytes(image, {.is_signed = is_signed});
          expect_cpu_bytes(image, {.band = 4});
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

TEST_P(ImageKernels, ManySmallImages) {
  std::mt19937 random(7);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  for (unsigned trial = 0; trial < 4000; ++trial) {
    const Size size{pick(1, 9), pick(1, 14), pick(1, 14)};
    const Vec3d spacing{static_cast<double>(pick(1, 4)), static_cast<double>(pick(1, 4)),
                        static_cast<double>(pick(1, 4))};
    const VoxelImage image = image_of(size, spacing, random_mask(size, 0.02 + 0.96 * pick(0, 100) / 100.0, trial));
    if (!has_both_kinds(mask_of(image))) continue;
    SCOPED_TRACE(describe(size, spacing, trial));
    expect_cpu_bytes(image, {.is_signed = trial % 3 != 0});
    if (HasFatalFailure()) return;
  }
}

TEST_P(ImageKernels, SeveralSelectionsOfImagesWithLabels) {
  std::mt19937 random(5);
  for (const Size& size : {Size{33, 20, 17}, {70, 1, 5}}) {
    VoxelImage image;
    image.grid.size = size;
    image.grid.spacing = {1, 0.7, 2.1};
    std::vector<std::int16_t> values(image.grid.node_count());
    for (auto& value : values) value = static_cast<std::int16_t>(random() % 30 / 9);
    image.values = std::move(values);
    const std::vector<LabelSelection> selections{LabelSelection::of_label(3), LabelSelection::at_least(1)};
    for (const DistanceTransformOptions& options :
         {DistanceTransformOptions{}, DistanceTransformOptions{.is_signed = false, .band = 1.5}}) {
      const std::vector<Field> cpu = distance_transforms(image, selections, options);
      const std::vector<Field> device = distance_transforms(image, selections, options, context());
      ASSERT_EQ(cpu.size(), device.size());
      for (std::size_t k = 0; k < cpu.size(); ++k) {
        EXPECT_EQ(device[k].device, Device::cuda());
        EXPECT_EQ(cpu[k].sign_reason, device[k].sign_reason);
        EXPECT_TRUE(test::same_bytes(cpu[k], device[k]));
      }
    }
  }
}

template <class T>
class ImageKernelsOf : public testing::Test {};
using ValueTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                                  std::uint64_t, std::int64_t, float, double>;
TYPED_TEST_SUITE(ImageKernelsOf, ValueTypes);

TYPED_TEST(ImageKernelsOf, SelectLikeTheCpu) {
  std::vector<TypeParam> values(41 * 7 * 9);
  std::mt19937 random(11);
  for (auto& value : values) value = static_cast<TypeParam>(std::uniform_int_distribution<int>(0, 5)(random));
  if constexpr (std::is_floating_point_v<TypeParam>) values[5] = std::numeric_limits<TypeParam>::quiet_NaN();
  GridSpec grid;
  grid.size = {41, 7, 9};
  const VoxelImageView image{grid, std::span<const TypeParam>(values)};
  for (const LabelSelection& selection :
       {LabelSelection{}, LabelSelection::of_label(3), LabelSelection::at_least(2.5)}) {
    const DistanceTransformOptions options{.selection = selection};
    expect_same_bytes(transform(image, options, bands_of_seven), distance_transform(image, options));
    kernels::EmulatedDevice device;
    kernels::ImageTransform<kernels::EmulatedDevice> counter(device);
    counter.set_request(detail::make_image_request(grid, options));
    counter.select(values.data(), selection);
    EXPECT_EQ(counter.selected_count(), selected_voxels(image, selection).count());
  }
}

TEST(ImageKernelsAlone, DivideExactly) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::uint32_t> any(0, 0x7fffffffU);
  for (int trial = 0; trial < 200000; ++trial) {
    const std::uint32_t by = std::max(1U, any(random) >> (trial % 31));
    const kernels::Divisor divisor(by);
    const std::uint32_t near = any(random) / by * by;
    for (const std::uint32_t x : {any(random), near, near - (near > 0 ? 1 : 0), 0x7fffffffU, 0U}) {
      ASSERT_EQ(divisor.quotient(x), x / by) << x << " / " << by;
    }
  }
}

TEST(ImageKernelsAlone, ReportTheirScratchMemory) {
  GridSpec grid;
  grid.size = {512, 512, 512};
  using Transform = kernels::ImageTransform<kernels::EmulatedDevice>;
  EXPECT_EQ(Transform::scratch_bytes(detail::make_image_request(grid, {})), std::size_t{512} * 512 * 64 + 8);
  grid.size = {100, 3200, 1};  // 100 bands of 32 rows
  EXPECT_EQ(Transform::scratch_bytes(detail::make_image_request(grid, {})), std::size_t{3200} * 16 + 100 * 100 * 8 + 8);
}

}  // namespace
}  // namespace blum
