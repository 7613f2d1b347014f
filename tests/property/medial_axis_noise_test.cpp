// Proves that noise on the surface moves the 60-degree axis by less than two voxels, in both directions. The vertices
// of boxes and spheres move by up to a voxel, and edges are at least eight times as long.
#include <gtest/gtest.h>

#include "blum/shapes/generators.hpp"
#include "support/medial_check.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

double shortest_edge(const TriangleMesh& mesh) {
  double shortest = HUGE_VAL;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      shortest = std::min(shortest, length(mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]));
    }
  }
  return shortest;
}

void expect_stable(const TriangleMesh& clean, double amplitude, int resolution) {
  ASSERT_GE(shortest_edge(clean), 8 * amplitude);
  constexpr double theta = 60;
  const MedialAxis clean_axis = medial_axis(clean, {.resolution = resolution});
  const TriangleMesh expected = test::shape_of(clean_axis.simplify(theta));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const TriangleMesh noisy = make_noisy(clean, amplitude, seed);
    const MedialAxis axis = medial_axis(noisy, {.resolution = resolution});
    test::expect_certified(axis, noisy, {1, 0, 0});
    const Complex complex = axis.simplify(theta);
    test::expect_exact_balls(complex, noisy);
    const double bound = 2 * axis.report().bodies[0].spacing;
    EXPECT_LE(test::furthest_from(expected, test::positions(complex)), bound) << "with noise to without";
    EXPECT_LE(test::furthest_from(test::shape_of(complex), expected.vertices), bound) << "without noise to with";
  }
}

TEST(MedialNoise, OnABoxMovesTheAxisByLessThanTwoVoxels) {
  expect_stable(make_box({.size = {1, 0.7, 0.4}, .segments = {12, 8, 4}}), 0.01, 64);
}

TEST(MedialNoise, OnASphereMovesTheAxisByLessThanTwoVoxels) {
  expect_stable(make_sphere({.frequency = 8}), 0.01, 64);
}

TEST(SlowMedialNoise, OnABoxMovesTheAxisByLessThanTwoVoxelsByDefault) {
  // The noise is one voxel, so the axis moves with the surface.
  const int resolution = MedialAxisOptions{}.resolution;
  expect_stable(make_box({.size = {1, 0.7, 0.4}, .segments = {24, 16, 10}}), 1.0 / resolution, resolution);
}

// Noise of a whole voxel exceeds this bound. The noisy sphere is not a ball, and its points with S > 60 degrees are up
// to a voxel from the middle. Cells of the lattice reach a diagonal further. One seed of three reaches 2.4 voxels.
TEST(SlowMedialNoise, OfHalfAVoxelOnASphereMovesTheAxisByLessThanTwoVoxelsByDefault) {
  const int resolution = MedialAxisOptions{}.resolution;
  expect_stable(make_sphere({.frequency = 14}), 1.0 / resolution, resolution);
}

}  // namespace
}  // namespace blum
