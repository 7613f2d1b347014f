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
  /// Number of rounds of smoothing, 0 to 1000. With 0, the result is the surface of the voxels' boxes, changed slightly
  /// where boxes touch only in an edge or a corner.
  int iterations = 60;
};

template <>
struct Description<SmoothSurfaceOptions> {
  static constexpr std::string_view name = "SmoothSurfaceOptions";
  static constexpr std::string_view doc = "Options of smoothing the surface of voxels";
  static constexpr std::tuple members{
      Member{"iterations", &SmoothSurfaceOptions::iterations, "",
             "rounds of smoothing; 0: the surface of the voxels' boxes", Range::between(0, 1000)},
  };
};

struct SmoothSurface {
  TriangleMesh mesh;
  /// Largest move of a vertex from its start position along any axis, as a fraction of the spacing along that axis: at
  /// most 0.59. Start positions lie on the surface of the boxes, except where boxes touch only in an edge or a corner.
  /// In that case, start positions are 0.1 or 0.2 away from the surface of the boxes, so the move can exceed 1/2. Along
  /// each axis, each final vertex is within 0.49 of its original position on the surface of the boxes.
  double largest_move = 0;
  std::size_t held_vertices = 0;  ///< number of vertices that were moved back towards their start positions, because
                                  ///< the surface would have crossed itself. Each step back is a quarter of the
                                  ///< vertex's move
};

/// Computes a smooth, closed surface between the selected voxels of an image and all other voxels.
///
/// - The centre of each selected voxel is inside. The centre of every other voxel, and all space beyond the image, is
///   outside.
///
/// - The solid has the homotopy type of the union of the selected, closed voxels (betti_numbers(VoxelSet)). Voxels that
///   touch in an edge or a corner are joined.
///
/// - The surface is an oriented manifold that does not cross or touch itself, also if the grid's direction mirrors.
///
/// - Along each axis, each vertex stays within half a voxel of its original position on the surface of the boxes.
///
/// - Taubin's filter (1995) smooths the surface and hardly shrinks it. Waves of the surface shorter than about 5 voxels
///   nearly vanish; longer waves remain. For round tubes with a radius of at least 1.5 voxels, the mean radius of the
///   result is correct within 0.1 voxels. The mean radius of balls is equally accurate if it is at least 2 voxels.
///
/// @return      vertices in world coordinates. The bytes are the same for any number of threads.
/// @throws InvalidImage, also if no voxel is selected.
/// @throws InvalidOption, also for more than max_id_count vertices or triangles.
/// @throws InvalidGrid if the spacing is too small relative to the coordinates of the origin. With such a spacing,
/// rounded coordinates make the surface cross itself.
/// @throws OutOfMemory, Cancelled.
/// Cost: O(voxels / 64), and about 5 microseconds of one core and 300 bytes for each face between a selected and an
/// unselected voxel.
/// Method: docs/theory/smooth-surfaces.md.
[[nodiscard]] SmoothSurface smooth_surface(const VoxelImageView& image, const LabelSelection& selection = {},
                                           const SmoothSurfaceOptions& options = {}, const Context& context = {});

}  // namespace blum
