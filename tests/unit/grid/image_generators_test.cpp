// Proves that generated images have the Betti numbers of their catalog, for every parameter set. The tests use the
// Euler characteristic and counted components.
#include "blum/grid/image_generators.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// The voxels of an image with a margin of zeros.
struct Mask {
  std::array<std::int64_t, 3> size{};
  std::vector<std::uint8_t> set;

  explicit Mask(const VoxelImage& image) {
    for (std::size_t a = 0; a < 3; ++a) size[a] = image.grid.size[a] + 2;
    set.assign(static_cast<std::size_t>(size[0] * size[1] * size[2]), 0);
    std::visit(
        [&](const auto& values) {
          for (std::int64_t k = 0; k < image.grid.size[2]; ++k) {
            for (std::int64_t j = 0; j < image.grid.size[1]; ++j) {
              for (std::int64_t i = 0; i < image.grid.size[0]; ++i) {
                set[at(i + 1, j + 1, k + 1)] = values[image.grid.index(i, j, k)] != 0 ? 1 : 0;
              }
            }
          }
        },
        image.values);
  }
  [[nodiscard]] std::size_t at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * size[1] + j) * size[0] + i);
  }
};

/// Components of the voxels of one value; neighbours differ by at most 1 in at most `axes` coordinates.
std::int64_t count_components(const Mask& mask, std::uint8_t value, int axes) {
  std::vector<bool> seen(mask.set.size(), false);
  std::int64_t count = 0;
  std::vector<std::array<std::int64_t, 3>> stack;
  const auto visit = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    if (i < 0 || j < 0 || k < 0 || i >= mask.size[0] || j >= mask.size[1] || k >= mask.size[2]) return;
    const std::size_t v = mask.at(i, j, k);
    if (seen[v] || mask.set[v] != value) return;
    seen[v] = true;
    stack.push_back({i, j, k});
  };
  for (std::int64_t k = 0; k < mask.size[2]; ++k) {
    for (std::int64_t j = 0; j < mask.size[1]; ++j) {
      for (std::int64_t i = 0; i < mask.size[0]; ++i) {
        if (seen[mask.at(i, j, k)] || mask.set[mask.at(i, j, k)] != value) continue;
        ++count;
        visit(i, j, k);
        while (!stack.empty()) {
          const auto [x, y, z] = stack.back();
          stack.pop_back();
          for (int n = 0; n < 27; ++n) {
            const int dx = n % 3 - 1;
            const int dy = n / 3 % 3 - 1;
            const int dz = n / 9 - 1;
            if (std::abs(dx) + std::abs(dy) + std::abs(dz) <= axes) visit(x + dx, y + dy, z + dz);
          }
        }
      }
    }
  }
  return count;
}

/// V - E + F - C of the union of closed voxels. An element exists if a voxel around it is set.
std::int64_t euler_characteristic(const Mask& mask) {
  std::int64_t sum = 0;
  for (std::int64_t k = 1; k < mask.size[2]; ++k) {
    for (std::int64_t j = 1; j < mask.size[1]; ++j) {
      for (std::int64_t i = 1; i < mask.size[0]; ++i) {
        for (int kind = 0; kind < 8; ++kind) {  // bits: axes along which the element spans a voxel
          bool is_there = false;
          for (int around = 0; around < 8; ++around) {
            if ((around & kind) != 0) continue;
            is_there |= mask.set[mask.at(i - (around & 1), j - (around >> 1 & 1), k - (around >> 2))] != 0;
          }
          const int dimension = (kind & 1) + (kind >> 1 & 1) + (kind >> 2);
          if (is_there) sum += dimension % 2 == 0 ? 1 : -1;
        }
      }
    }
  }
  return sum;
}

std::array<std::int64_t, 3> betti(const VoxelImage& image) {
  const Mask mask(image);
  const std::int64_t components = count_components(mask, 1, 3);
  const std::int64_t voids = count_components(mask, 0, 1) - 1;
  return {components, components + voids - euler_characteristic(mask), voids};
}

struct Case {
  std::string name;
  ParameterValues parameters;
};

TEST(ImageGenerators, HaveTheTopologyOfTheirCatalogEntry) {
  std::vector<Case> cases = {
      {"ball_image", {{"size", 8}}},
      {"ball_image", {{"size", 33}, {"radius", 0.9}}},
      {"ball_image", {{"size", 40}, {"spacing_z", 3}, {"spacing_x", 0.5}, {"radius", 0.9}}},
      {"ball_image", {{"size", 40}, {"inner_radius", 0.5}}},
      {"ball_image", {{"size", 60}, {"inner_radius", 0.4}, {"radius", 0.9}, {"spacing_y", 1.7}}},
      {"tube_image", {{"nodes", 1}}},
      {"tube_image", {{"nodes", 2}, {"pitch", 6}, {"radius", 1}}},
      {"tube_image", {{"nodes", 4}, {"pitch", 9}, {"radius", 2.5}}},
      {"tube_image", {{"labelled", 1}}},
      {"balls_image", {{"count", 1}}},
      {"balls_image", {{"count", 30}, {"pitch", 7}, {"radius", 2.5}}},
  };
  for (const ImageInfo& image : image_catalog()) cases.push_back({image.name, {}});
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const ImageInfo& info = find_image(c.name);
    const VoxelImage image = make_image(c.name, c.parameters);
    ASSERT_NO_THROW(validate(image));
    const auto known = info.betti(complete_parameters(info.name, info.parameters, c.parameters));
    if (known.has_value()) {
      EXPECT_EQ(betti(image), *known);
    }
  }
}

TEST(ImageGenerators, AllLabelsOccur) {
  const VoxelImage balls = make_balls_image({.count = 30, .pitch = 7, .radius = 2});
  const auto& values = std::get<std::vector<std::uint16_t>>(balls.values);
  EXPECT_EQ(std::set<std::uint16_t>(values.begin(), values.end()).size(), 31U);
  const VoxelImage tubes = make_tube_image({.labelled = true});
  const auto& axes = std::get<std::vector<std::uint8_t>>(tubes.values);
  EXPECT_EQ(std::set<std::uint8_t>(axes.begin(), axes.end()), (std::set<std::uint8_t>{0, 1, 2, 3}));
}

TEST(ImageGenerators, BallHasItsVolumeInWorldUnits) {
  const VoxelImage image = make_ball_image({.size = 100, .spacing = {0.5, 1, 0.8}, .radius = 0.8});
  double volume = 0;
  for (const std::uint8_t v : std::get<std::vector<std::uint8_t>>(image.values)) volume += v * 0.5 * 1 * 0.8;
  EXPECT_NEAR(volume, 4.0 / 3 * 3.14159265 * 20 * 20 * 20, 100);
}

TEST(ImageGenerators, NoiseHasItsDensity) {
  const VoxelImage image = make_noise_image({.size = 64, .density = 0.25, .seed = 9});
  double sum = 0;
  for (const std::uint8_t v : std::get<std::vector<std::uint8_t>>(image.values)) sum += v;
  EXPECT_NEAR(sum / (64 * 64 * 64), 0.25, 0.005);
}

TEST(ImageGenerators, RefuseInvalidParameters) {
  const std::vector<Case> bad = {
      {"ball", {}},
      {"ball_image", {{"size", 4}}},
      {"ball_image", {{"size", 20.5}}},
      {"ball_image", {{"spacing_x", 0}}},
      {"ball_image", {{"size", 10}, {"inner_radius", 0.5}}},
      {"ball_image", {{"size", 8}, {"radius", 0.3}, {"spacing_z", 5}}},
      {"tube_image", {{"radius", 9}}},
      {"tube_image", {{"nodes", 50}, {"pitch", 500}}},
      {"balls_image", {{"radius", 8}}},
      {"noise_image", {{"density", 1.5}}},
      {"noise_image", {{"colour", 1}}},
  };
  for (const Case& c : bad) {
    EXPECT_THROW(static_cast<void>(make_image(c.name, c.parameters)), InvalidOption) << c.name;
  }
}

}  // namespace
}  // namespace blum
