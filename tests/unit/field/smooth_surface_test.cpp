// Proves that smooth_surface() gives closed, oriented manifolds without self-intersections. They have the topology of
// the union of the voxels, and each voxel's centre lies on its side. The tests cover every set of 2x2x2 voxels, noise,
// plates and contacts. They bound the error against the balls, tubes and tori that voxels sample. The bytes are the
// same for any number of threads.
#include "blum/field/smooth_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"

namespace blum {
namespace {

using Size = std::array<std::int64_t, 3>;

VoxelImage image_of(const Size& size, const std::function<bool(std::int64_t, std::int64_t, std::int64_t)>& is_in) {
  VoxelImage image;
  image.grid.size = size;
  std::vector<std::uint8_t> values(image.grid.node_count());
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      for (std::int64_t i = 0; i < size[0]; ++i) values[image.grid.index(i, j, k)] = is_in(i, j, k) ? 1 : 0;
    }
  }
  image.values = std::move(values);
  return image;
}

VoxelImage noise(const Size& size, double density, std::uint64_t seed) {
  Random random(seed);
  return image_of(size, [&](auto, auto, auto) { return random.uniform() < density; });
}

void expect_parts_centres(const TriangleMesh& mesh, const VoxelImage& image, const VoxelSet& voxels) {
  const WindingNumber winding(mesh);
  const Size& size = image.grid.size;
  for (std::int64_t k = -1; k <= size[2]; ++k) {
    for (std::int64_t j = -1; j <= size[1]; ++j) {
      for (std::int64_t i = -1; i <= size[0]; ++i) {
        ASSERT_EQ(winding.is_inside(image.grid.position(i, j, k)), voxels.contains(i, j, k))
            << i << " " << j << " " << k;
      }
    }
  }
}

/// Checks all promises of smooth_surface() except smoothness.
void expect_surface(const VoxelImage& image, int iterations = SmoothSurfaceOptions{}.iterations) {
  const SmoothSurface surface = smooth_surface(image, {}, {.iterations = iterations});
  const TriangleMesh& mesh = surface.mesh;
  const Topology facts = topology(mesh);
  ASSERT_TRUE(facts.closed);
  ASSERT_TRUE(facts.manifold);
  ASSERT_TRUE(facts.faces_outwards);
  ASSERT_TRUE(find_self_intersections(mesh, 10).pairs.empty());
  const VoxelSet voxels = selected_voxels(image, {});
  ASSERT_EQ(facts.betti, betti_numbers(voxels));
  ASSERT_LT(surface.largest_move, 0.5);
  expect_parts_centres(mesh, image, voxels);
}

TEST(SmoothSurface, EverySetOfEightVoxels) {
  for (unsigned set = 1; set < 256; ++set) {
    SCOPED_TRACE("set " + std::to_string(set));
    const VoxelImage image = image_of({4, 4, 4}, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      if (std::min({i, j, k}) < 1 || std::max({i, j, k}) > 2) return false;
      return (set >> ((i - 1) + 2 * (j - 1) + 4 * (k - 1)) & 1U) != 0;
    });
    expect_surface(image);
    expect_surface(image, 0);
    if (HasFatalFailure()) return;
  }
}

TEST(SmoothSurface, EverySetOfEightVoxelsAsHoles) {
  for (unsigned set = 1; set < 256; ++set) {
    SCOPED_TRACE("set " + std::to_string(set));
    const VoxelImage image = image_of({4, 4, 4}, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      if (std::min({i, j, k}) < 1 || std::max({i, j, k}) > 2) return true;
      return (set >> ((i - 1) + 2 * (j - 1) + 4 * (k - 1)) & 1U) == 0;
    });
    expect_surface(image);
    expect_surface(image, 0);
    if (HasFatalFailure()) return;
  }
}

TEST(SmoothSurface, Noise) {
  for (const double density : {0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(std::to_string(density) + " seed " + std::to_string(seed));
      const VoxelImage image = noise({13, 9, 11}, density, seed);
      expect_surface(image);
      expect_surface(image, 0);
      expect_surface(image, 400);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(SmoothSurface, PlatesRodsAndVoxelsAtTheBorder) {
  const auto always = [](auto, auto, auto) { return true; };
  for (const Size& size : {Size{1, 1, 1}, Size{7, 1, 1}, Size{1, 1, 7}, Size{9, 1, 8}, Size{70, 3, 2}, Size{64, 1, 1},
                           Size{63, 2, 1}, Size{65, 1, 2}}) {
    SCOPED_TRACE(std::to_string(size[0]) + " " + std::to_string(size[1]) + " " + std::to_string(size[2]));
    expect_surface(image_of(size, always));
  }
  // Plates one voxel apart, and a slanted plate one voxel thick.
  expect_surface(image_of({12, 12, 9}, [](auto, auto, std::int64_t k) { return k % 2 == 0; }));
  expect_surface(image_of({14, 14, 14},
                          [](std::int64_t i, std::int64_t j, std::int64_t k) { return (i + 2 * j + 3 * k) / 4 == 9; }));
  // A board of voxels that touch in edges, and one of voxels that touch in corners.
  expect_surface(image_of({8, 8, 1}, [](std::int64_t i, std::int64_t j, auto) { return (i + j) % 2 == 0; }));
  expect_surface(image_of(
      {8, 8, 8}, [](std::int64_t i, std::int64_t j, std::int64_t k) { return i % 2 == j % 2 && j % 2 == k % 2; }));
  expect_surface(
      image_of({6, 6, 6}, [](std::int64_t i, std::int64_t j, std::int64_t k) { return (i + j + k) % 2 == 0; }));
}

TEST(SmoothSurface, GridsOfAnyKind) {
  for (const bool is_mirrored : {false, true}) {
    VoxelImage image = noise({9, 10, 11}, 0.4, 5);
    image.grid.origin = {-30, 12, 500};
    image.grid.spacing = {0.3, 1, 2.7};
    const double c = 0.6;
    const double s = 0.8;
    image.grid.direction.columns[0] = {c, s, 0};
    image.grid.direction.columns[1] = {-s, c, 0};
    image.grid.direction.columns[2] = {0, 0, is_mirrored ? -1.0 : 1.0};
    expect_surface(image);
    const TriangleMesh mesh = smooth_surface(image).mesh;
    // Smoothing works in voxel units, so the result is the same surface, stretched.
    VoxelImage plain = image;
    plain.grid = {};
    plain.grid.size = image.grid.size;
    const TriangleMesh straight = smooth_surface(plain).mesh;
    ASSERT_EQ(mesh.vertices.size(), straight.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vec3d& p = straight.vertices[v];
      const Vec3d there = image.grid.origin + image.grid.direction * Vec3d{0.3 * p.x, p.y, 2.7 * p.z};
      EXPECT_LT(length(there - mesh.vertices[v]), 1e-9);
    }
  }
}

using Distance = std::function<double(const Vec3d&)>;

struct Errors {
  double mean = 0;    ///< of the signed distance, weighted by area
  double normal = 0;  ///< mean angle, degrees
};

/// Returns the errors of the surface of sampled voxels against the shape, away from the border of the image.
Errors errors_of(const Distance& shape, int size) {
  const VoxelImage image = image_of({size, size, size}, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    return shape({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}) < 0;
  });
  const TriangleMesh mesh = smooth_surface(image).mesh;
  Errors sum;
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.vertices[t[0]];
    const Vec3d normal = 0.5 * cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    const Vec3d middle = 1.0 / 3 * (a + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
    const double low = std::min({middle.x, middle.y, middle.z});
    const double high = std::max({middle.x, middle.y, middle.z});
    if (low < 3 || high > size - 4) continue;
    Vec3d slope{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3d step{};
      step[axis] = 1e-4;
      slope[axis] = shape(middle + step) - shape(middle - step);
    }
    const double cosine = dot(slope, normal) / (length(slope) * length(normal));
    sum.mean += length(normal) * shape(middle);
    sum.normal += length(normal) * std::acos(std::clamp(cosine, -1.0, 1.0)) * 57.29578;
    area += length(normal);
  }
  return {sum.mean / area, sum.normal / area};
}

Distance tube(const Vec3d& middle, const Vec3d& along, double radius) {
  const Vec3d u = 1 / length(along) * along;
  return [=](const Vec3d& p) { return length(p - middle - dot(p - middle, u) * u) - radius; };
}

TEST(SmoothSurface, TubesKeepTheirRadius) {
  Random random(7);
  for (const double radius : {1.5, 2.0, 3.0, 4.0, 6.0, 8.0}) {
    for (int draw = 0; draw < 4; ++draw) {
      const Vec3d middle{random.uniform(19, 21), random.uniform(19, 21), random.uniform(19, 21)};
      const Vec3d along{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      const Errors errors = errors_of(tube(middle, along, radius), 40);
      SCOPED_TRACE("radius " + std::to_string(radius) + " draw " + std::to_string(draw));
      EXPECT_LT(std::abs(errors.mean), 0.1);
      EXPECT_LT(errors.normal, radius < 3 ? 14 : 8);
    }
  }
}

TEST(SmoothSurface, BallsAndToriKeepTheirRadius) {
  const Vec3d middle{23.3, 23.6, 23.8};
  for (const double radius : {2.0, 3.0, 4.0, 6.0, 8.0, 15.0}) {
    const Errors ball = errors_of([&](const Vec3d& p) { return length(p - middle) - radius; }, 48);
    EXPECT_LT(std::abs(ball.mean), 0.1) << radius;
    if (radius > 6) continue;
    const Vec3d axis = 1 / std::sqrt(1.01) * Vec3d{0.2, 0.4, 0.9};
    const Errors torus = errors_of(
        [&](const Vec3d& p) {
          const double height = dot(p - middle, axis);
          return std::hypot(length(p - middle - height * axis) - 14, height) - radius;
        },
        48);
    EXPECT_LT(std::abs(torus.mean), 0.1) << radius;
  }
}

TEST(SmoothSurface, PlanesAreFlat) {
  // On this thick slanted slab, the normals of voxel faces are off by up to 55 degrees.
  const Vec3d up = 1 / std::sqrt(0.78) * Vec3d{0.3, 0.2, 0.8};
  const Errors errors = errors_of([&](const Vec3d& p) { return std::abs(dot(p - Vec3d{20, 20, 20}, up)) - 7.3; }, 40);
  EXPECT_LT(std::abs(errors.mean), 0.1);
  EXPECT_LT(errors.normal, 6);
}

TEST(SmoothSurface, LabelsAndThresholds) {
  VoxelImage image = noise({8, 8, 8}, 0.5, 9);
  for (std::uint8_t& value : std::get<std::vector<std::uint8_t>>(image.values)) value = value != 0 ? 7 : 3;
  const TriangleMesh all = smooth_surface(image, LabelSelection::of_label(7)).mesh;
  EXPECT_EQ(all.vertices, smooth_surface(image, LabelSelection::at_least(5)).mesh.vertices);
  EXPECT_NE(all.vertices, smooth_surface(image, LabelSelection::of_label(3)).mesh.vertices);
}

TEST(SmoothSurface, SameBytesForAnyNumberOfThreads) {
  const VoxelImage image = noise({24, 25, 26}, 0.45, 3);
  const SmoothSurface one = smooth_surface(image, {}, {}, {.threads = 1});
  for (const int threads : {2, 7}) {
    const SmoothSurface many = smooth_surface(image, {}, {}, {.threads = threads});
    EXPECT_EQ(one.mesh.triangles, many.mesh.triangles);
    ASSERT_EQ(one.mesh.vertices.size(), many.mesh.vertices.size());
    EXPECT_EQ(
        std::memcmp(one.mesh.vertices.data(), many.mesh.vertices.data(), one.mesh.vertices.size() * sizeof(Vec3d)), 0);
    EXPECT_EQ(one.largest_move, many.largest_move);
  }
}

TEST(SmoothSurface, RejectsInvalidInputAndCanBeCancelled) {
  const VoxelImage empty = image_of({4, 4, 4}, [](auto, auto, auto) { return false; });
  EXPECT_THROW((void)smooth_surface(empty), InvalidImage);
  const VoxelImage image = noise({8, 8, 8}, 0.5, 1);
  EXPECT_THROW((void)smooth_surface(image, LabelSelection::of_label(5)), InvalidImage);
  EXPECT_THROW((void)smooth_surface(image, {}, {.iterations = -1}), InvalidOption);
  EXPECT_THROW((void)smooth_surface(image, {}, {.iterations = 1001}), InvalidOption);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)smooth_surface(image, {}, {}, {.cancel = stop.get_token()}), Cancelled);
}

}  // namespace
}  // namespace blum
