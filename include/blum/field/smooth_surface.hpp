// Blum: the smooth surface that the voxels of an image sample. SPDX-License-Identifier: Apache-2.0
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
  static constexpr std::string_view doc = "How the surface of voxels is smoothed";
  static constexpr std::tuple members{
      Member{"iterations", &SmoothSurfaceOptions::iterations, "", "rounds of smoothing; 0: the surface of the boxes",
             Range::between(0, 1000)},
  };
};

struct SmoothSurface {
  TriangleMesh mesh;
  /// How far a vertex is at most from the surface of the voxels' boxes where it began, in voxels: the largest of the
  /// three axes' numbers. Below 1/2.
  double largest_move = 0;
  std::size_t held_vertices = 0;  ///< that were put back, whole or half way, as the surface would have crossed itself
};

/// A smooth, closed surface between the voxels of an image that are selected and those that are not.
///
/// - The centre of each selected voxel is inside, and that of each other one is outside, as is all beyond the image.
/// - What it bounds has the homotopy type of the union of the selected, closed voxels (betti_numbers(VoxelSet)): voxels
///   that touch in an edge or a corner are joined.
/// - It is an oriented manifold that does not cross or touch itself, also where the grid's direction mirrors.
/// - Each vertex stays within half a voxel of its place on the surface of the boxes, along each axis.
/// - Smoothing is by Taubin's filter (1995), which hardly shrinks: waves of the surface that are shorter than some 5
///   voxels go, long ones stay. Of round tubes of radius 1.5 voxels and more, and balls of 2 and more, the mean radius
///   is right within 0.1 voxels.
///
/// @return      vertices in world coordinates. The same bytes for any number of threads.
/// @throws InvalidImage (also when no voxel is selected), InvalidOption (also for more than max_id_count vertices or
/// triangles), InvalidGrid where the spacing is too small beside the origin for coordinates to tell voxels apart;
/// OutOfMemory, Cancelled.
/// Cost: O(voxels / 64) and, for each of the surface's faces, about 5 microseconds of a core and 300 bytes.
/// Method: docs/theory/smooth-surfaces.md.
[[nodiscard]] SmoothSurface smooth_surface(const VoxelImageView& image, const LabelSelection& selection = {},
                                           const SmoothSurfaceOptions& options = {}, const Context& context = {});

}  // namespace blum
