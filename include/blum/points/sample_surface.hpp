// Blum: random points of surfaces, and near them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct SampleOptions {
  /// Another number gives other points.
  std::uint64_t seed = 0;
  /// Points keep their distance from each other (blue noise): the most even of five times as many, by sample
  /// elimination (Yuksel 2015). Takes 3 us for each instead of 0.1.
  bool blue_noise = false;
};

template <>
struct Description<SampleOptions> {
  static constexpr std::string_view name = "SampleOptions";
  static constexpr std::string_view doc = "How points of a surface are chosen";
  static constexpr std::tuple members{
      Member{"seed", &SampleOptions::seed, "", "another number gives other points", Range::between(0, 0x1p62)},
      Member{"blue_noise", &SampleOptions::blue_noise, "",
             "points keep their distance from each other; takes 30 times as long"},
  };
};

/// Points of a surface; entry k of each list belongs to point k.
struct SurfaceSamples {
  std::vector<Vec3d> points;          ///< mesh units
  std::vector<Vec3d> normals;         ///< of length 1: of the triangle, counter-clockwise as its corners are given
  std::vector<TriangleId> triangles;  ///< that the points lie on
};

/// Random points of a surface, uniform by area and independent of each other (unless blue noise is asked for).
///
/// @param mesh   with a triangle that has an area; segments and points of the mesh are left out.
/// @param count  of points.
/// @return       as many, in random order. The same for the same mesh and seed on any number of threads.
/// @throws InvalidMesh where no triangle has an area, OutOfMemory, Cancelled. Cost: O(triangles + count log triangles).
[[nodiscard]] SurfaceSamples sample_surface(const MeshView& mesh, std::size_t count, const SampleOptions& options = {},
                                            const Context& context = {});

struct NearSampleOptions {
  /// Standard deviation of the offset from the surface along each axis, mesh units, > 0. Unset: a hundredth of the
  /// diagonal of the mesh's box.
  std::optional<double> sigma = {};
  /// The part of the points that are not near the surface, but uniform in the mesh's box, which is made a tenth larger:
  /// 0 to 1.
  double in_box = 0;
  std::uint64_t seed = 0;
  /// How signs are found, as for closest_points().
  SignMode sign = SignMode::automatic;
};

template <>
struct Description<NearSampleOptions> {
  static constexpr std::string_view name = "NearSampleOptions";
  static constexpr std::string_view doc = "Which points near a surface are chosen";
  static constexpr std::tuple members{
      Member{"sigma", &NearSampleOptions::sigma, "mesh units",
             "standard deviation of the offset from the surface along each axis; else a hundredth of the diagonal",
             Range::positive()},
      Member{"in_box", &NearSampleOptions::in_box, "part of all",
             "points that are uniform in the box, made a tenth larger, instead of near the surface",
             Range::between(0, 1)},
      Member{"seed", &NearSampleOptions::seed, "", "another number gives other points", Range::between(0, 0x1p62)},
      Member{"sign", &NearSampleOptions::sign, "", "how signs are found, as for closest points"},
  };
};

/// Points near a surface, and what is closest to them: what learning signed distances needs.
struct NearSamples {
  std::vector<Vec3d> points;          ///< mesh units
  std::vector<ClosestPoint> closest;  ///< of each, with the signed distance
};

/// Points of a surface, moved by normally distributed offsets, with their exact signed distances.
///
/// @param count   of points: first those near the surface, then those in the box.
/// @throws as sample_surface() and closest_points(), InvalidOption. The same on any number of threads.
/// Cost: that of both.
[[nodiscard]] NearSamples sample_near(const MeshView& mesh, std::size_t count, const NearSampleOptions& options = {},
                                      const Context& context = {});

}  // namespace blum
