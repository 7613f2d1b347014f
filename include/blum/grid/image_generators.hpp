// Blum: voxel images for tests and demonstrations. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/parameters.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/voxel_image.hpp"

/// In generated images, voxels outside the shape are 0. The shape does not touch the border of the image, unless stated
/// otherwise. Stated topologies are those of the non-zero voxels (26-connected; the background is 6-connected). All
/// functions throw InvalidOption for options out of range, and for more than 2^30 voxels. Cost: O(voxels).
namespace blum {

struct BallImageOptions {
  int size = 64;            ///< voxels along each side, 8 to 1024
  Vec3d spacing{1, 1, 1};   ///< > 0, in world units
  double radius = 0.7;      ///< radius of the ball, as a fraction of half the shortest side of the image, 0.3 to 0.9
  double inner_radius = 0;  ///< radius of a void, as a fraction of the ball's radius, 0 to 0.7; 0: no void
};
/// Makes a ball in the middle of the image. The ball is round in world units. If the inner radius is not 0, the ball is
/// hollow. Values are uint8: 0, 1. The ball and the void must not be smaller than a voxel. The wall around the void
/// must be at least three voxels thick.
[[nodiscard]] VoxelImage make_ball_image(const BallImageOptions& options = {});

struct TubeImageOptions {
  int nodes = 3;           ///< number of nodes of a cubic lattice along each axis, 1 to 50
  int pitch = 20;          ///< distance between neighbouring nodes in voxels, 6 to 500
  double radius = 4;       ///< radius of the tubes between neighbouring nodes, in voxels, 1 to pitch / 2 - 2
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
  bool labelled = false;   ///< true: tubes along x, y, z have labels 1, 2, 3 (voxels in several tubes: the smallest);
                           ///< false: all tubes have label 1
};
/// Makes a network of tubes along the lines of a cubic lattice. The tubes are round in voxels. Values are uint8.
[[nodiscard]] VoxelImage make_tube_image(const TubeImageOptions& options = {});

struct BallsImageOptions {
  int count = 8;           ///< number of balls, 1 to 65,535
  int pitch = 16;          ///< distance between centres in voxels, 6 to 500
  double radius = 5.5;     ///< radius of a ball in voxels, 1 to pitch / 2 - 1
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
};
/// Makes balls on a cubic lattice, each with its own label from 1 to `count`. Values are uint16.
[[nodiscard]] VoxelImage make_balls_image(const BallsImageOptions& options = {});

struct NoiseImageOptions {
  int size = 64;           ///< voxels along each side, 1 to 1024
  double density = 0.01;   ///< fraction of voxels that are 1, from 0 to 1
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
  std::uint64_t seed = 1;
};
/// Makes an image in which each voxel is set or not at random, also at the border. Values are uint8: 0, 1.
[[nodiscard]] VoxelImage make_noise_image(const NoiseImageOptions& options = {});

/// Kind of image that Blum generates.
struct ImageInfo {
  std::string name;
  std::string description;  ///< one line
  std::vector<Parameter> parameters;
  /// Makes the image. All parameters must be given and in range; make_image() adds defaults and checks ranges.
  std::function<VoxelImage(const ParameterValues&)> make;
  /// Returns the Betti numbers of the non-zero voxels (components, tunnels, voids) if the construction determines them.
  std::function<std::optional<std::array<std::int64_t, 3>>(const ParameterValues&)> betti;
};

/// Returns all kinds of images, sorted by name. No shape in shape_catalog() has the same name.
[[nodiscard]] const std::vector<ImageInfo>& image_catalog();

/// Returns the kind of image with a given name. @throws InvalidOption that lists the known names.
[[nodiscard]] const ImageInfo& find_image(std::string_view name);

/// Generates an image by name, with defaults for parameters that are not given.
/// @throws InvalidOption that lists parameters and ranges.
[[nodiscard]] VoxelImage make_image(std::string_view name, const ParameterValues& parameters = {});

}  // namespace blum
