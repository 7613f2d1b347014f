// Blum: random points on surfaces and near them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct SampleOptions {
  /// Seed of the random numbers. Different seeds give different points.
  std::uint64_t seed = 0;
  /// True: points are evenly spaced (blue noise). Five times the requested number of points are drawn, and sample
  /// elimination (Yuksel 2015) keeps the requested number. Blue noise takes 3 us per point; without it, a point takes
  /// 0.1 us.
  bool blue_noise = false;
};

template <>
struct Description<SampleOptions> {
  static constexpr std::string_view name = "SampleOptions";
  static constexpr std::string_view doc = "Options of random points on a surface";
  static constexpr std::tuple members{
      Member{"seed", &SampleOptions::seed, "", "seed of the random numbers", Range::between(0, 0x1p62)},
      Member{"blue_noise", &SampleOptions::blue_noise, "",
             "evenly spaced points on the surface (blue noise), which take 30 times as long as random points"},
  };
};

/// Points of a surface. Entry k of each list belongs to point k.
struct SurfaceSamples {
  std::vector<Vec3d> points;          ///< mesh units
  std::vector<Vec3d> normals;         ///< unit normal of the triangle, on the side from which its corners run
                                      ///< counter-clockwise
  std::vector<TriangleId> triangles;  ///< triangle that contains the point
};

/// Returns random points of a surface, uniform by area. The points are independent of each other, unless
/// SampleOptions::blue_noise is true.
///
/// @param mesh   must have a triangle of non-zero area. The mesh's segments and points are ignored.
/// @param count  number of points, at most 2^31; with blue noise at most a fifth of 2^31.
/// @return       `count` points in random order. The same mesh, count and options give the same points, for any number
///               of threads.
/// @throws InvalidMesh if no triangle has an area, OutOfMemory, Cancelled. Cost: O(triangles + count log triangles).
[[nodiscard]] SurfaceSamples sample_surface(const MeshView& mesh, std::size_t count, const SampleOptions& options = {},
                                            const Context& context = {});

struct NearSampleOptions {
  /// Standard deviation of the offset from the surface along each axis, mesh units, > 0. Unset: a hundredth of the
  /// diagonal of the mesh's bounds.
  std::optional<double> sigma = {};
  /// Fraction of the points that are uniformly distributed in a box instead of near the surface, 0 to 1. The box is the
  /// mesh's bounds, with all sides multiplied by 1.1 about its centre.
  double in_box = 0;
  std::uint64_t seed = 0;
  /// Rule for the signs of distances, as for closest_points().
  SignMode sign = SignMode::automatic;
};

template <>
struct Description<NearSampleOptions> {
  static constexpr std::string_view name = "NearSampleOptions";
  static constexpr std::string_view doc = "Options of random points near a surface";
  static constexpr std::tuple members{
      Member{"sigma", &NearSampleOptions::sigma, "mesh units; default: 1/100 of the diagonal of the mesh's box",
             "standard deviation of the offset from the surface along each axis", Range::positive()},
      Member{"in_box", &NearSampleOptions::in_box, "",
             "fraction of the points that are uniform in the mesh's box (sides times 1.1) instead of near the surface; "
             "these points come last",
             Range::between(0, 1)},
      Member{"seed", &NearSampleOptions::seed, "", "seed of the random numbers", Range::between(0, 0x1p62)},
      Member{"sign", &NearSampleOptions::sign, "", "rule for the sign of distances, as for closest points"},
  };
};

/// Points near a surface, and for each point the closest point of the surface. Such points are training data for models
/// that learn signed distances.
struct NearSamples {
  std::vector<Vec3d> points;          ///< mesh units
  std::vector<ClosestPoint> closest;  ///< for each point: the closest point of the surface, with the signed distance
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;        ///< reason for sign_rule, one sentence
  std::vector<Warning> warnings;  ///< as ClosestPointQuery::warnings()
};

/// Returns points of a surface, moved by normally distributed offsets, with their exact signed distances.
///
/// @param count  number of points. The points near the surface come first, then the points in the box.
/// @return       the points and their distances; they are the same for any number of threads.
/// @throws as sample_surface() and closest_points(); InvalidOption.
/// Cost: that of sample_surface() and closest_points().
[[nodiscard]] NearSamples sample_near(const MeshView& mesh, std::size_t count, const NearSampleOptions& options = {},
                                      const Context& context = {});

}  // namespace blum
