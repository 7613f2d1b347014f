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

/// Voxels outside the shape are 0, and the shape does not touch the border of the image, unless stated otherwise. The
/// stated topology is that of the non-zero voxels, 26-connected, in a 6-connected background. All functions throw
/// InvalidOption for options out of range, and for more than 2^30 voxels. Cost: O(voxels).
namespace blum {

struct BallImageOptions {
  int size = 64;            ///< voxels along each side, 8 to 1024
  Vec3d spacing{1, 1, 1};   ///< > 0, in world units
  double radius = 0.7;      ///< as a fraction of half the shortest side, 0.3 to 0.9
  double inner_radius = 0;  ///< radius of a void, as a fraction of the ball's radius, 0 to 0.7; 0: no void
};
/// Makes a ball in the middle of the image, round in world units. With an inner radius it is hollow. Values uint8:
/// 0, 1. Rejects a wall between void and outside that is thinner than three voxels, and a ball or void smaller than a
/// voxel.
[[nodiscard]] VoxelImage make_ball_image(const BallImageOptions& options = {});

struct TubeImageOptions {
  int nodes = 3;           ///< nodes of a cubic lattice along each axis, 1 to 50
  int pitch = 20;          ///< distance between neighbouring nodes in voxels, 6 to 500
  double radius = 4;       ///< of the tubes between neighbouring nodes, in voxels, 1 to pitch / 2 - 2
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
  bool labelled = false;   ///< tubes along x, y, z get labels 1, 2, 3 (the first to reach a voxel); else all get 1
};
/// Makes a network of tubes along the lines of a cubic lattice, round in voxels. Values uint8.
[[nodiscard]] VoxelImage make_tube_image(const TubeImageOptions& options = {});

struct BallsImageOptions {
  int count = 8;           ///< 1 to 65,535
  int pitch = 16;          ///< distance between centres in voxels, 6 to 500
  double radius = 5.5;     ///< in voxels, 1 to pitch / 2 - 1
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
};
/// Makes balls on a cubic lattice, each with its own label from 1 to count. Values uint16.
[[nodiscard]] VoxelImage make_balls_image(const BallsImageOptions& options = {});

struct NoiseImageOptions {
  int size = 64;           ///< voxels along each side, 1 to 1024
  double density = 0.01;   ///< fraction of voxels that are set, 0 to 1
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
  std::uint64_t seed = 1;
};
/// Makes single random voxels, also at the border. Values uint8: 0, 1.
[[nodiscard]] VoxelImage make_noise_image(const NoiseImageOptions& options = {});

/// Image that Blum generates.
struct ImageInfo {
  std::string name;
  std::string description;  ///< one line
  std::vector<Parameter> parameters;
  /// Makes the image. All parameters must be given and in range; make_image() takes care of both.
  std::function<VoxelImage(const ParameterValues&)> make;
  /// Returns the Betti numbers of the non-zero voxels (components, tunnels, voids) if the construction determines them.
  std::function<std::optional<std::array<std::int64_t, 3>>(const ParameterValues&)> betti;
};

/// Returns all images, sorted by name. shape_catalog() does not use their names.
[[nodiscard]] const std::vector<ImageInfo>& image_catalog();

/// Returns the image of that name. @throws InvalidOption that lists the known names.
[[nodiscard]] const ImageInfo& find_image(std::string_view name);

/// Generates an image by name, with defaults for parameters not given.
/// @throws InvalidOption that lists parameters and ranges.
[[nodiscard]] VoxelImage make_image(std::string_view name, const ParameterValues& parameters = {});

}  // namespace blum
