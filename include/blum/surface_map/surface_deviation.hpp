// Blum: deviation of a surface from another one, over all of its area. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct DeviationOptions {
  /// Largest error of means, root mean squares and percentiles, > 0, mesh units. The surface is divided into pieces
  /// until all errors are below this value. Default: 1/2,000 of the diagonal of the box around both meshes, or a tenth
  /// of the mean distance if that is smaller. The default for percentiles is twice this value.
  std::optional<double> max_error = {};
  /// Largest number of pieces that are examined, 1 to 10^9. If more pieces are needed, the division stops with larger
  /// errors. Each triangle is at least one piece, even if the mesh has more triangles than this number. If the mesh has
  /// more triangles than a quarter of this number, the triangles are cut evenly. The cut gives about seven to fifteen
  /// times this number of pieces. For each piece of this cut, only the distance of the centroid is computed.
  std::size_t pieces = 100'000;
  /// Rule for signs, as for closest_points(). Signed deviations are negative where the surface is inside the other
  /// mesh.
  SignMode sign = SignMode::none;
};

template <>
struct Description<DeviationOptions> {
  static constexpr std::string_view name = "DeviationOptions";
  static constexpr std::string_view doc = "Precision of deviations";
  static constexpr std::tuple members{
      Member{
          "max_error", &DeviationOptions::max_error,
          "mesh units; default: 1/2,000 of the diagonal of the box around both meshes, or a tenth of the mean if that "
          "is smaller",
          "largest error of means and percentiles", Range::positive()},
      Member{"pieces", &DeviationOptions::pieces, "",
             "largest number of pieces that are examined; if more are needed, errors stay above max_error",
             Range::between(1, 1e9)},
      Member{"sign", &DeviationOptions::sign, "",
             "rule for the signs of means and percentiles; distances are negative inside the other mesh"},
  };
};

/// Statistics of the distances of all points of a surface from another mesh, weighted by area. The surface is divided
/// into pieces. On pieces with a single closest site, statistics are exact, except for rounding. On other pieces, two
/// linear functions bound the distance from below and above, and statistics are those of the mean of the two functions.
/// Members with `error` in their name are guaranteed bounds on errors, not estimates.
struct SurfaceDeviation {
  static constexpr std::array<double, 7> percents{1, 5, 25, 50, 75, 95, 99};

  double mean = 0;        ///< Mesh units; signed if signs are requested.
  double mean_error = 0;  ///< The true mean differs from `mean` by at most this.
  double rms = 0;         ///< Root of the mean square.
  double rms_error = 0;
  double smallest = 0;  ///< Smallest distance; `percentile_error` bounds its error.
  double largest = 0;
  std::array<double, 7> percentiles{};  ///< Entry k: percents[k] percent of the area have smaller distances.
  double percentile_error = 0;          ///< Bound on the error of each percentile, of `smallest` and of `largest`.
  double area = 0;                      ///< Area of the surface, square mesh units.
  std::size_t pieces = 0;
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;
  std::vector<Warning> warnings = {};  ///< As ClosestPointQuery::warnings().
};

template <>
struct Description<SurfaceDeviation> {
  static constexpr std::string_view name = "SurfaceDeviation";
  static constexpr std::string_view doc = "Distances of all points of a surface from another mesh, by area";
  static constexpr std::tuple members{
      Member{"mean", &SurfaceDeviation::mean, "mesh units", "mean distance, signed if signs are requested"},
      Member{"mean_error", &SurfaceDeviation::mean_error, "mesh units", "guaranteed bound for the error of the mean"},
      Member{"rms", &SurfaceDeviation::rms, "mesh units", "root mean square of the distances"},
      Member{"rms_error", &SurfaceDeviation::rms_error, "mesh units", "guaranteed bound for the error of rms"},
      Member{"smallest", &SurfaceDeviation::smallest, "mesh units", "smallest distance"},
      Member{"largest", &SurfaceDeviation::largest, "mesh units", "largest distance"},
      Member{"percentiles", &SurfaceDeviation::percentiles, "mesh units",
             "values below which 1, 5, 25, 50, 75, 95 and 99 percent of the area lie"},
      Member{"percentile_error", &SurfaceDeviation::percentile_error, "mesh units",
             "guaranteed bound for the error of each percentile, and of smallest and largest"},
      Member{"area", &SurfaceDeviation::area, "square mesh units", "area of the surface"},
      Member{"pieces", &SurfaceDeviation::pieces, "", "number of pieces into which the surface was divided"},
      Member{"sign_rule", &SurfaceDeviation::sign_rule, "", "rule that found the signs"},
      Member{"sign_reason", &SurfaceDeviation::sign_reason, "", "reason for the rule that found the signs"},
      Member{"warnings", &SurfaceDeviation::warnings, "", "warnings about the signs"},
  };
};

/// Computes the mean, root mean square and percentiles of the distance of a surface from another mesh.
///
/// @param mesh   must have a triangle with an area; its segments and points are ignored.
/// @param other  any soup of triangles, segments and points.
/// @return       the same for any number of threads.
/// @throws InvalidMesh, InvalidOption, OutOfMemory, Cancelled.
/// Cost: one search of the closest point for each triangle, and 2 to 10 us of one core for each piece. Two meshes with
/// few triangles, for example boxes, need few pieces.
/// Method: docs/theory/surface-maps.md.
[[nodiscard]] SurfaceDeviation surface_deviation(const MeshView& mesh, const MeshView& other,
                                                 const DeviationOptions& options = {}, const Context& context = {});

}  // namespace blum
