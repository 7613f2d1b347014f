// Proves that bodies and images become the voxels whose centres lie inside. The grid leaves room around them, and each
// voxel has its depth and closest site.
#include "medial_axis/cells/voxelize.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/image_reference.hpp"
#include "blum/field/reference.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using detail::voxelize_body;
using detail::voxelize_by_winding;
using detail::voxelize_image;
using detail::Voxelized;
using detail::VoxelSolid;

SolidBody body_of(const TriangleMesh& mesh) {
  const Solid solid = Solid::of(mesh);
  return solid.bodies().front();
}

void expect_free_layer(const VoxelSolid& solid) {
  const auto& size = solid.voxels.size();
  ASSERT_EQ(size, solid.grid.size);
  test::for_each_voxel(size, 0, [&](auto i, auto j, auto k) {
    if (std::min({i, j, k}) > 0 && i + 1 < size[0] && j + 1 < size[1] && k + 1 < size[2]) return;
    ASSERT_FALSE(solid.voxels.contains(i, j, k));
  });
}

/// Compares voxels, depths and sites with brute force, except for points that rounding makes ambiguous.
void expect_inside(const VoxelSolid& solid, const TriangleMesh& mesh) {
  const reference::BruteForce brute(mesh);
  test::for_each_voxel(solid.grid.size, 1, [&](auto i, auto j, auto k) {
    const Vec3d at = solid.grid.position(i, j, k);
    const std::size_t voxel = solid.grid.index(i, j, k);
    const double distance = brute.nearest(at).distance;
    ASSERT_NEAR(std::abs(solid.depth[voxel]), distance, 1e-6);
    ASSERT_NEAR(brute.site_distance(solid.site[voxel], at), distance, 1e-6);
    if (distance < 1e-6) return;
    const bool is_inside = reference::winding_number(mesh, at) > 0.5;
    ASSERT_EQ(solid.depth[voxel] > 0, is_inside);
    ASSERT_EQ(solid.voxels.contains(i, j, k), is_inside);
  });
}

TEST(Voxelize, BodiesAreTheVoxelsWithTheirCentreInside) {
  for (const TriangleMesh& mesh :
       {make_box({.size = {1, 0.6, 0.8}}), make_torus({.ring_segments = 12, .tube_segments = 6}),
        test::moved(make_sphere({.frequency = 3}), 0.5, {100, 0, -3})}) {
    const SolidBody body = body_of(mesh);
    const Voxelized out = voxelize_body(body, 0.09, {});
    EXPECT_TRUE(out.report.topology_matches);
    EXPECT_EQ(out.report.betti, body.betti);
    EXPECT_EQ(out.report.spacing, 0.09);
    EXPECT_EQ(out.report.voxels, out.solid.voxels.count());
    EXPECT_TRUE(out.report.failures.empty());
    expect_free_layer(out.solid);
    expect_inside(out.solid, body.mesh);
  }
}

/// A layer of nodes outside the body stays free, and so do the cells of the model around it.
TEST(Voxelize, GridsReachBeyondTheBody) {
  const Voxelized out = voxelize_body(body_of(make_box({.size = {1, 0.613, 0.2}})), 0.05, {});
  const Box3 box = bounds(make_box({.size = {1, 0.613, 0.2}}));
  const Box3 grid = bounds(out.solid.grid);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_LT(grid.lower[a], box.lower[a] - 2 * 0.05);
    EXPECT_GT(grid.upper[a], box.upper[a] + 2 * 0.05);
  }
}

TEST(Voxelize, OpenMeshesAreTheVoxelsOfWindingNumberAboveAHalf) {
  TriangleMesh mesh = make_box({.segments = {2, 2, 2}});
  mesh.triangles.pop_back();
  const Voxelized out = voxelize_by_winding(mesh, 0.11, {});
  EXPECT_TRUE(out.report.topology_matches);
  EXPECT_EQ(out.report.betti, (BettiNumbers{1, 0, 0}));
  expect_free_layer(out.solid);
  expect_inside(out.solid, mesh);
}

TEST(Voxelize, BoxesThatCrossAreOneSolid) {
  TriangleMesh mesh = test::box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, test::box_between({0.5, 0.4, 0.3}, {1.5, 1.3, 1.6}));
  const Voxelized out = voxelize_by_winding(mesh, 0.1, {});
  EXPECT_EQ(out.report.betti, (BettiNumbers{1, 0, 0}));
  expect_inside(out.solid, mesh);
}

/// An image with labels 0, 1 and 2, also at its border.
VoxelImage labelled_image(const GridSpec& grid, Random& random) {
  VoxelImage image;
  image.grid = grid;
  std::vector<std::uint8_t> values(grid.node_count());
  for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(random.below(8));
  for (std::uint8_t& value : values) value = value > 2 ? 0 : value;
  image.values = std::move(values);
  return image;
}

TEST(Voxelize, ImagesAreTheSelectedVoxelsWhereTheyLie) {
  Random random(1);
  for (const std::array<std::int64_t, 3>& size : {std::array<std::int64_t, 3>{9, 8, 7}, {1, 1, 1}, {70, 3, 2}}) {
    VoxelImage image = labelled_image(test::turned_grid(size), random);
    std::get<std::vector<std::uint8_t>>(image.values).back() = 2;
    for (const LabelSelection& selection :
         {LabelSelection{}, LabelSelection::of_label(2), LabelSelection::at_least(2)}) {
      const VoxelSet selected = selected_voxels(image, selection);
      std::array<std::int64_t, 3> first{};
      const Voxelized out = voxelize_image(selected_voxels(image, selection), image.grid, first, {});
      ASSERT_EQ(out.report.voxels, selected.count());
      ASSERT_EQ(out.report.betti, betti_numbers(selected));
      ASSERT_EQ(out.report.spacing, 0.5);
      ASSERT_TRUE(out.report.topology_matches);
      expect_free_layer(out.solid);
      test::for_each_voxel(out.solid.grid.size, 0, [&](auto i, auto j, auto k) {
        ASSERT_EQ(out.solid.voxels.contains(i, j, k), selected.contains(i + first[0], j + first[1], k + first[2]));
        const Vec3d in_image = image.grid.position(i + first[0], j + first[1], k + first[2]);
        ASSERT_LT(length(out.solid.grid.position(i, j, k) - in_image), 1e-12);
      });
    }
  }
}

TEST(Voxelize, VoxelsOfImagesHaveTheClosestVoxelOfTheOtherKind) {
  Random random(2);
  const VoxelImage image = labelled_image(test::turned_grid({8, 7, 6}), random);
  std::array<std::int64_t, 3> first{};
  const Voxelized out = voxelize_image(selected_voxels(image, {}), image.grid, first, {});
  std::vector<std::uint8_t> inside;
  test::for_each_voxel(out.solid.grid.size, 0,
                       [&](auto i, auto j, auto k) { inside.push_back(out.solid.voxels.contains(i, j, k)); });
  std::vector<std::uint8_t> outside(inside);
  for (std::uint8_t& value : outside) value = 1 - value;
  for (std::size_t voxel = 0; voxel < inside.size(); ++voxel) {
    const auto nearest = reference::nearest_voxel(out.solid.grid, inside[voxel] != 0 ? outside : inside, voxel);
    const double sign = inside[voxel] != 0 ? 1 : -1;
    ASSERT_NEAR(out.solid.depth[voxel], sign * std::sqrt(nearest.squared), 1e-6);
    ASSERT_NEAR(reference::squared_distance(out.solid.grid, voxel, out.solid.site[voxel].value), nearest.squared, 1e-9);
  }
}

TEST(Voxelize, TooSmallSpacingIsRejected) {
  EXPECT_THROW((void)voxelize_body(body_of(make_box({})), 1e-9, {}), InvalidOption);
  EXPECT_THROW((void)voxelize_by_winding(make_box({}), 1e-9, {}), InvalidOption);
}

}  // namespace
}  // namespace blum
