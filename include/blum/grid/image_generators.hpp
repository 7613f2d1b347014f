// Blum: voxel images to test with and to show. SPDX-License-Identifier: Apache-2.0
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

/// Voxels are 0 outside the shape; the shape touches no border of the image. Topology is that of the non-zero voxels,
/// 26-connected, before a 6-connected background. All functions throw InvalidOption for options out of their ranges and
/// for more than 2^30 voxels. Cost: O(voxels).
namespace blum {

struct BallImageOptions {
  int size = 64;            ///< voxels along each side, 8 to 1024
  Vec3d spacing{1, 1, 1};   ///< > 0, in world units
  double radius = 0.7;      ///< as a fraction of half the shortest side, 0.3 to 0.9
  double inner_radius = 0;  ///< of a void inside, as a fraction of the ball's radius, 0 to 0.7; 0: no void
};
/// A ball, round in world units, in the middle of the image; with an inner radius, hollow. Values uint8: 0, 1.
/// A wall between void and outside thinner than three voxels is refused.
[[nodiscard]] VoxelImage make_ball_image(const BallImageOptions& options = {});

struct TubeImageOptions {
  int nodes = 3;           ///< nodes of a cubic lattice along each axis, 1 to 50
  int pitch = 20;          ///< voxels from node to node, 6 to 500
  double radius = 4;       ///< of the tubes between neighbouring nodes, in voxels, 1 to pitch / 2 - 2
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
  bool labelled = false;  ///< tubes along x, y, z have labels 1, 2, 3 (the first that reaches a voxel); else all have 1
};
/// A network of tubes along the lines of a cubic lattice, round in voxels. Values uint8.
[[nodiscard]] VoxelImage make_tube_image(const TubeImageOptions& options = {});

struct BallsImageOptions {
  int count = 8;           ///< 1 to 65,535
  int pitch = 16;          ///< voxels between centres, 6 to 500
  double radius = 5.5;     ///< in voxels, 1 to pitch / 2 - 1
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
};
/// Balls on a cubic lattice, each with its own label from 1 to count. Values uint16.
[[nodiscard]] VoxelImage make_balls_image(const BallsImageOptions& options = {});

struct NoiseImageOptions {
  int size = 64;           ///< voxels along each side, 1 to 1024
  double density = 0.01;   ///< fraction of voxels that are set, 0 to 1
  Vec3d spacing{1, 1, 1};  ///< > 0, in world units
  std::uint64_t seed = 1;
};
/// Single random voxels, also at the border. Values uint8: 0, 1.
[[nodiscard]] VoxelImage make_noise_image(const NoiseImageOptions& options = {});

/// An image that Blum generates.
struct ImageInfo {
  std::string name;
  std::string description;  ///< one line
  std::vector<Parameter> parameters;
  /// Makes the image. Every parameter must be there and in its range; make_image() sees to both.
  std::function<VoxelImage(const ParameterValues&)> make;
  /// Betti numbers of the non-zero voxels (components, tunnels, voids), where they are known from the construction.
  std::function<std::optional<std::array<std::int64_t, 3>>(const ParameterValues&)> betti;
};

/// All images, sorted by name. Their names are not used by shape_catalog().
[[nodiscard]] const std::vector<ImageInfo>& image_catalog();

/// The image of that name. @throws InvalidOption that lists the known names.
[[nodiscard]] const ImageInfo& find_image(std::string_view name);

/// Generates an image by name, with defaults for parameters not given.
/// @throws InvalidOption naming parameters and ranges.
[[nodiscard]] VoxelImage make_image(std::string_view name, const ParameterValues& parameters = {});

}  // namespace blum
