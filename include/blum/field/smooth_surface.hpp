// Blum: the smooth surface sampled by the voxels of an image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum {

struct SmoothSurfaceOptions {
  /// Rounds of smoothing, 0 to 1000. 0: the surface of the boxes, opened a little where boxes touch only in an edge or
  /// a corner.
  int iterations = 60;
};

template <>
struct Description<SmoothSurfaceOptions> {
  static constexpr std::string_view name = "SmoothSurfaceOptions";
  static constexpr std::string_view doc = "Options of smoothing the surface of voxels";
  static constexpr std::tuple members{
      Member{"iterations", &SmoothSurfaceOptions::iterations, "", "rounds of smoothing; 0: the surface of the boxes",
             Range::between(0, 1000)},
  };
};

struct SmoothSurface {
  TriangleMesh mesh;
  /// Largest move of a vertex from its start along any axis, in voxels of that axis: at most 0.59. Starts lie on the
  /// surface of the boxes, except where boxes touch only in an edge or a corner. There they are already 0.1 or 0.2 away
  /// from it, so the move can exceed 1/2. Each final vertex is within 0.49 of its place on the surface of the boxes,
  /// along each axis.
  double largest_move = 0;
  std::size_t held_vertices = 0;  ///< vertices moved back by quarters of their way, because the surface would have
                                  ///< crossed itself
};

/// Computes a smooth, closed surface between the selected voxels of an image and the others.
///
/// - The centre of each selected voxel is inside. Every other centre is outside, and so is all space beyond the image.
///
/// - The solid has the homotopy type of the union of the selected, closed voxels (betti_numbers(VoxelSet)). Voxels that
///   touch in an edge or a corner are joined.
///
/// - The surface is an oriented manifold that does not cross or touch itself, also if the grid's direction mirrors.
///
/// - Each vertex stays within half a voxel of its place on the surface of the boxes, along each axis.
///
/// - Taubin's filter (1995) smooths the surface and hardly shrinks it. Waves shorter than about 5 voxels vanish, long
///   ones stay. The mean radius is right within 0.1 voxels for round tubes of radius 1.5 voxels or more, and balls of 2
///   or more.
///
/// @return      vertices in world coordinates. The bytes are the same for any number of threads.
/// @throws InvalidImage, also if no voxel is selected.
/// @throws InvalidOption, also for more than max_id_count vertices or triangles.
/// @throws InvalidGrid if the spacing is too small beside the origin: rounded coordinates then make the surface cross
/// itself.
/// @throws OutOfMemory, Cancelled.
/// Cost: O(voxels / 64) and, for each of the surface's faces, about 5 microseconds of a core and 300 bytes.
/// Method: docs/theory/smooth-surfaces.md.
[[nodiscard]] SmoothSurface smooth_surface(const VoxelImageView& image, const LabelSelection& selection = {},
                                           const SmoothSurfaceOptions& options = {}, const Context& context = {});

}  // namespace blum
