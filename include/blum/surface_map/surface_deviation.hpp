// Blum: deviation of a surface from another one, over all of its area. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct DeviationOptions {
  /// The surface is cut into about this many pieces, and more if triangles are long; 1 to 10^9.
  std::size_t pieces = 1'000'000;
  /// Rule for signs, as for closest_points(). Signed deviations are negative where the surface is inside of the other
  /// mesh.
  SignMode sign = SignMode::none;
};

template <>
struct Description<DeviationOptions> {
  static constexpr std::string_view name = "DeviationOptions";
  static constexpr std::string_view doc = "Precision of deviations";
  static constexpr std::tuple members{
      Member{"pieces", &DeviationOptions::pieces, "",
             "approximate number of pieces of the surface; errors fall with their size", Range::between(1, 1e9)},
      Member{"sign", &DeviationOptions::sign, "", "rule for signs: negative inside the other mesh"},
  };
};

/// Distances of all points of a surface from another mesh, by area. The surface is cut into small pieces; the exact
/// distance at its centroid stands for each. Errors are guaranteed bounds, not estimates, and far above likely errors.
/// A distance changes by at most the distance moved, so distances on a piece are known to within its size.
struct SurfaceDeviation {
  static constexpr std::array<double, 7> percents{1, 5, 25, 50, 75, 95, 99};

  double mean = 0;        ///< Mesh units; signed if signs are requested.
  double mean_error = 0;  ///< The true mean is at most this far from `mean`.
  double rms = 0;         ///< Root of the mean square.
  double rms_error = 0;
  double smallest = 0;  ///< At the centroids.
  double largest = 0;
  std::array<double, 7> percentiles{};  ///< This many percent of the area are below: see `percents`.
  double percentile_error = 0;          ///< Bound for each of them, and for smallest and largest.
  double area = 0;                      ///< Area of the surface, square mesh units.
  std::size_t pieces = 0;
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;
};

template <>
struct Description<SurfaceDeviation> {
  static constexpr std::string_view name = "SurfaceDeviation";
  static constexpr std::string_view doc = "Distances of all points of a surface from another mesh, by area";
  static constexpr std::tuple members{
      Member{"mean", &SurfaceDeviation::mean, "mesh units", "mean, signed if signs are requested"},
      Member{"mean_error", &SurfaceDeviation::mean_error, "mesh units", "guaranteed bound for the error of the mean"},
      Member{"rms", &SurfaceDeviation::rms, "mesh units", "root of the mean square"},
      Member{"rms_error", &SurfaceDeviation::rms_error, "mesh units", "guaranteed bound for the error of rms"},
      Member{"smallest", &SurfaceDeviation::smallest, "mesh units", "smallest value at the centroids of the pieces"},
      Member{"largest", &SurfaceDeviation::largest, "mesh units", "largest value at the centroids of the pieces"},
      Member{"percentiles", &SurfaceDeviation::percentiles, "mesh units",
             "values that 1, 5, 25, 50, 75, 95 and 99 percent of the area are below"},
      Member{"percentile_error", &SurfaceDeviation::percentile_error, "mesh units",
             "guaranteed bound for the error of each percentile, and of smallest and largest"},
      Member{"area", &SurfaceDeviation::area, "square mesh units", "area of the surface"},
      Member{"pieces", &SurfaceDeviation::pieces, "", "number of pieces"},
      Member{"sign_rule", &SurfaceDeviation::sign_rule, "", "rule that found the signs"},
      Member{"sign_reason", &SurfaceDeviation::sign_reason, "", "reason for this rule"},
  };
};

/// Computes the mean, root mean square and percentiles of the distance of a surface from another mesh.
///
/// @param mesh   must have a triangle with an area; its segments and points are ignored.
/// @param other  any soup of triangles, segments and points.
/// @return       the same for any number of threads.
/// @throws InvalidMesh, InvalidOption, OutOfMemory, Cancelled.
/// Cost: one closest point for each piece.
[[nodiscard]] SurfaceDeviation surface_deviation(const MeshView& mesh, const MeshView& other,
                                                 const DeviationOptions& options = {}, const Context& context = {});

}  // namespace blum
