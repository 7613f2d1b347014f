// Proves that medial axes of images have the topology of the union of the selected voxels. The tests use single voxels,
// voxels that touch in corners, full images and noise. They vary spacing and direction, and include generated and real
// images.
#include <gtest/gtest.h>

#include <optional>

#include "blum/core/random.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "blum/io/image_io.hpp"
#include "support/data.hpp"
#include "support/medial_check.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::VertexRow;

using Size = std::array<std::int64_t, 3>;

VoxelImage empty_image(const Size& size) {
  VoxelImage image;
  image.grid.size = size;
  image.values = std::vector<std::uint8_t>(image.grid.node_count(), 0);
  return image;
}

void set(VoxelImage& image, std::int64_t i, std::int64_t j, std::int64_t k, std::uint8_t value = 1) {
  std::get<std::vector<std::uint8_t>>(image.values)[image.grid.index(i, j, k)] = value;
}

VoxelImage image_of(const Size& size, const std::vector<Size>& voxels) {
  VoxelImage image = empty_image(size);
  for (const Size& at : voxels) set(image, at[0], at[1], at[2]);
  return image;
}

VoxelImage full_image(const Size& size) {
  VoxelImage image = empty_image(size);
  image.values = std::vector<std::uint8_t>(image.grid.node_count(), 1);
  return image;
}

/// Expects the given Betti numbers of both the voxels and the axis, and exact balls in the voxels' union.
void expect_axis(const VoxelImage& image, const BettiNumbers& betti, const MedialAxisOptions& options = {}) {
  const VoxelSet voxels = selected_voxels(image, options.selection);
  ASSERT_EQ(betti_numbers(voxels), betti);
  const MedialAxis axis = medial_axis(image, options);
  EXPECT_EQ(axis.report().rule, SolidRule::voxels);
  EXPECT_TRUE(axis.report().topology_matches);
  EXPECT_EQ(axis.report().betti, betti);
  test::expect_betti(axis, betti);
  for (const double theta : {0.0, 60.0}) {
    const Certificate certificate = certify(axis.simplify(theta), voxels, image.grid, nullptr);
    EXPECT_TRUE(certificate.holds()) << certificate.mismatches.front();
  }
}

TEST(MedialImage, WithoutASelectedVoxelIsRefused) {
  EXPECT_THROW((void)medial_axis(empty_image({5, 6, 7})), InvalidImage);
  EXPECT_THROW((void)medial_axis(VoxelImage{}), InvalidImage);
  EXPECT_THROW((void)medial_axis(full_image({3, 3, 3}), {.selection = LabelSelection::of_label(2)}), InvalidImage);
  VoxelImage short_of_values = full_image({4, 4, 4});
  short_of_values.grid.size = {5, 4, 4};
  EXPECT_THROW((void)medial_axis(short_of_values), InvalidImage);
}

TEST(MedialImage, OfOneVoxelIsAPoint) {
  for (const Size& size : {Size{1, 1, 1}, Size{3, 3, 3}, Size{9, 5, 7}}) {
    const VoxelImage image = image_of(size, {{size[0] / 2, size[1] / 2, size[2] / 2}});
    expect_axis(image, {1, 0, 0});
    const AxisRows complex = medial_axis(image).simplify(60);
    ASSERT_FALSE(complex.vertices.empty());
    const Vec3d centre = image.grid.position(size[0] / 2, size[1] / 2, size[2] / 2);
    for (const VertexRow& vertex : complex.vertices) EXPECT_LE(length(vertex.position - centre), std::sqrt(0.75));
  }
}

TEST(MedialImage, OfAllVoxelsIsThatOfABox) {
  for (const Size& size : {Size{1, 1, 1}, Size{2, 2, 2}, Size{12, 12, 12}, Size{20, 9, 4}, Size{30, 1, 1}}) {
    expect_axis(full_image(size), {1, 0, 0});
  }
}

TEST(MedialImage, MayTouchItsBorder) {
  VoxelImage image = full_image({14, 12, 10});
  for (std::int64_t k = 0; k < 10; ++k) {
    for (std::int64_t j = 5; j < 8; ++j) {
      for (std::int64_t i = 4; i < 9; ++i) set(image, i, j, k, 0);
    }
  }
  expect_axis(image, {1, 1, 0});
}

TEST(MedialImage, VoxelsThatTouchInACornerOrAnEdgeAreOneComponent) {
  expect_axis(image_of({4, 4, 4}, {{1, 1, 1}, {2, 2, 2}}), {1, 0, 0});
  expect_axis(image_of({4, 4, 4}, {{1, 1, 1}, {2, 2, 1}}), {1, 0, 0});
  expect_axis(image_of({6, 4, 4}, {{1, 1, 1}, {3, 1, 1}}), {2, 0, 0});
  expect_axis(image_of({5, 5, 5}, {{1, 1, 2}, {2, 2, 2}, {1, 3, 2}, {0, 2, 2}}), {1, 1, 0});
  // The six neighbours of a missing voxel enclose a void that is closed only by edges.
  expect_axis(image_of({5, 5, 5}, {{1, 2, 2}, {3, 2, 2}, {2, 1, 2}, {2, 3, 2}, {2, 2, 1}, {2, 2, 3}}), {1, 0, 1});
}

TEST(MedialImage, OfRandomVoxelsHasTheirTopology) {
  for (const double density : {0.1, 0.3, 0.5, 0.8}) {
    SCOPED_TRACE(density);
    const VoxelImage image = make_noise_image({.size = 8, .density = density, .spacing = {1, 0.8, 1.3}, .seed = 5});
    expect_axis(image, betti_numbers(selected_voxels(image, {})));
  }
}

TEST(MedialImage, NoEdgeCrossesTheGapOfAU) {
  // The tips of this U of voxels lie in both layers of the image, its middle only in the upper one.
  const VoxelImage u = image_of(
      {3, 2, 2}, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}, {0, 0, 1}, {2, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 1, 1}});
  expect_axis(u, {1, 0, 0});
}

TEST(MedialImage, OfRandomVoxelsIsCertifiedForAnySpacing) {
  Random random(20261122);
  const auto side = [&] { return static_cast<std::int64_t>(2 + random.below(3)); };
  for (int round = 0; round < 16; ++round) {
    const Size size{side(), side(), side()};
    VoxelImage image = empty_image(size);
    const double share = random.uniform(0.3, 0.9);
    set(image, 0, 0, 0);
    for (std::uint8_t& value : std::get<std::vector<std::uint8_t>>(image.values)) {
      if (random.uniform() < share) value = 1;
    }
    for (const double ratio : {1.0, 1.5, 2.0, 3.0}) {
      SCOPED_TRACE("round " + std::to_string(round) + ", spacing " + std::to_string(ratio));
      image.grid.spacing = {1, 1, 1};
      image.grid.spacing[static_cast<std::size_t>(round % 3)] = ratio;
      expect_axis(image, betti_numbers(selected_voxels(image, {})));
    }
  }
}

TEST(MedialImage, OfAHollowBallIsAClosedSurface) {
  expect_axis(make_ball_image({.size = 40}), {1, 0, 0});
  expect_axis(make_ball_image({.size = 40, .inner_radius = 0.5}), {1, 0, 1});
}

TEST(MedialImage, IsCertifiedAtEveryAngleOfOneRun) {
  for (const VoxelImage& image : {make_ball_image({}), make_tube_image({}), make_balls_image({})}) {
    const MedialAxis axis = medial_axis(image);
    const VoxelSet voxels = selected_voxels(image, {});
    for (const double theta : {0.0, 20.0, 60.0, 90.0, 120.0, 170.0}) {
      const Certificate certificate =
          certify(axis.simplify(theta), voxels, image.grid, nullptr, {.theta = theta, .lambda = 0, .spacing = 1});
      EXPECT_TRUE(certificate.holds()) << "theta " << theta << ": " << certificate.mismatches.front();
    }
  }
}

TEST(MedialImage, OfTubesIsTheirNetwork) {
  expect_axis(make_tube_image({.nodes = 2, .pitch = 14, .radius = 3}), {1, 5, 0});
  expect_axis(make_tube_image({.nodes = 3, .pitch = 12, .radius = 2.5}), {1, 28, 0});
}

TEST(MedialImage, OfBallsHasOneComponentForEach) {
  const VoxelImage image = make_balls_image({.count = 9});
  expect_axis(image, {9, 0, 0});
  expect_axis(image, {1, 0, 0}, {.selection = LabelSelection::of_label(4)});
  expect_axis(image, {5, 0, 0}, {.selection = LabelSelection::at_least(5)});
}

TEST(MedialImage, SpacingAndDirectionChangeNoTopology) {
  for (const Vec3d& spacing : {Vec3d{1, 1, 3}, Vec3d{0.01, 0.02, 0.015}}) {
    VoxelImage image = make_ball_image({.size = 36, .spacing = spacing, .radius = 0.9, .inner_radius = 0});
    image.grid.origin = {100, -30, 7};
    for (const Mat3& direction : {Mat3{}, test::rotation({1, 2, 3}, 40), Mat3{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}}) {
      SCOPED_TRACE(testing::Message() << "spacing " << spacing.x << " " << spacing.y << " " << spacing.z);
      image.grid.direction = direction;
      expect_axis(image, {1, 0, 0});
    }
    VoxelImage tubes = make_tube_image({.nodes = 2, .pitch = 14, .radius = 3, .spacing = spacing});
    tubes.grid.direction = test::rotation({-2, 1, 5}, 101);
    expect_axis(tubes, {1, 5, 0});
  }
}

/// Returns how far the axis of a ball reaches from its centre, in diagonals of a voxel.
double reach(const VoxelImage& image, double theta, const MedialAxisOptions& options = {}) {
  const Vec3d middle = bounds(image.grid).center();
  double furthest = 0;
  for (const VertexRow& vertex : AxisRows(medial_axis(image, options).simplify(theta)).vertices) {
    furthest = std::max(furthest, length(vertex.position - middle));
  }
  return furthest / length(image.grid.spacing);
}

TEST(MedialImage, OfASmallBallLiesInItsMiddle) {
  VoxelImage image = make_ball_image({.size = 48});
  image.grid.direction = test::rotation({1, 2, 3}, 40);
  for (const double theta : {60.0, 120.0, 150.0}) EXPECT_LE(reach(image, theta), 2) << "theta " << theta;
}

TEST(MedialImage, OfALargerBallLiesInItsMiddle) {
  // The ball's flat tops end in corners one or two voxels wide. The axis of such a corner has a separation angle of 180
  // degrees.
  const VoxelImage image = make_ball_image({.size = 96});
  EXPECT_LE(reach(image, 150, {.lambda = 3}), 2);
  EXPECT_LE(reach(image, 150), 2);
}

TEST(MedialImage, OfABallOfFlatVoxelsLiesInItsMiddle) {
  // Steps three times as high as voxels are wide exceed the noise floor, which is based on the shortest side of a
  // voxel.
  const VoxelImage image = make_ball_image({.size = 48, .spacing = {1, 1, 3}});
  EXPECT_LE(reach(image, 60), 2);
}

struct RealImage {
  std::string file;
  MedialAxisOptions options;
  std::optional<BettiNumbers> betti;  ///< if they are known from elsewhere
};

class MedialRealImage : public testing::TestWithParam<RealImage> {};

TEST_P(MedialRealImage, HasTheTopologyOfItsVoxels) {
  const std::string name = "images/" + GetParam().file;
  const auto file = test::data_file(name);
  if (!file) GTEST_SKIP() << test::no_data(name);
  const VoxelImage image = read_image(*file);
  const BettiNumbers betti = betti_numbers(selected_voxels(image, GetParam().options.selection));
  EXPECT_EQ(betti, GetParam().betti.value_or(betti));
  expect_axis(image, betti, GetParam().options);
}
INSTANTIATE_TEST_SUITE_P(
    Data, MedialRealImage,
    testing::Values(RealImage{"cat10.vol", {}, BettiNumbers{1, 0, 0}},
                    RealImage{"Al.100.vol", {}, BettiNumbers{1, 2, 0}},
                    RealImage{"lobsterCroped2.nii.gz", {.selection = LabelSelection::at_least(60)}, std::nullopt}),
    [](const auto& info) { return test::test_name(info.param.file); });

}  // namespace
}  // namespace blum
