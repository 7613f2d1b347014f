// Blum: the point of a surface that is furthest from another one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// A part of a surface, and another one that it lies in.
struct DeepPatch {
  std::vector<std::array<Vec3d, 3>> triangles;  ///< at least one
  TriangleMesh surface;                         ///< with triangles
};

/// How deep the deepest point of patches is.
struct DeepestPoint {
  double distance = 0;
  double bound = 0;  ///< no point of the patches is deeper than this, but for rounding
  Vec3d point;
  Vec3d closest;             ///< of the surface
  std::size_t patch = 0;     ///< that the point is of
  std::size_t triangle = 0;  ///< of the patch
  std::uint32_t other = 0;   ///< triangle of the surface
};

/// The point of patches that is furthest from the surface that its patch lies in, by branch and bound (Guthe and others
/// 2005): the distance from a fixed triangle is convex, so over a part of a triangle it is largest at a corner, and the
/// distance from a surface is no larger than that from any of its triangles.
/// @param known      a depth that another point is known to have: patches that are nowhere deeper are not looked at
///                   closely.
/// @param tolerance  how much larger than the distance told the bound may be, as a part of it; unless 200,000 points
/// are not enough for that: then the bound says how far they went. @throws Cancelled.
[[nodiscard]] DeepestPoint deepest_point(std::span<const DeepPatch> patches, double known, double tolerance,
                                         const Context& context);

}  // namespace blum::detail
