// Blum: certified bounds on the Hausdorff distance of meshes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <tuple>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct HausdorffOptions {
  /// Largest width of the interval that contains the distance, > 0, mesh units. Default: 1/10,000 of the diagonal of
  /// the box around both meshes.
  std::optional<double> tolerance = {};
  /// Largest number of points of a mesh that the search stores: the mesh's vertices, and points added between them. If
  /// more points are needed, the search stops with a wider interval. Each point takes up to 150 bytes. Values above
  /// max_id_count are treated as max_id_count.
  std::size_t max_points = 20'000'000;
};

template <>
struct Description<HausdorffOptions> {
  static constexpr std::string_view name = "HausdorffOptions";
  static constexpr std::string_view doc = "Precision of a Hausdorff distance";
  static constexpr std::tuple members{
      Member{"tolerance", &HausdorffOptions::tolerance,
             "mesh units; default: 1/10,000 of the diagonal of the box around both meshes",
             "largest width of the interval", Range::positive()},
      Member{"max_points", &HausdorffOptions::max_points, "",
             "largest number of examined points per mesh; if more are needed, the search stops with a wider interval",
             Range::between(1, 1e15)},
  };
};

/// Interval, from `lower` to `upper`, that contains the one-sided Hausdorff distance: the largest distance of a point
/// of a mesh from another mesh.
struct DirectedHausdorff {
  double lower = 0;  ///< mesh units
  double upper = 0;
  /// A point of the mesh whose distance from the other mesh is at least `lower`, and its closest point on the other
  /// mesh.
  std::array<Vec3d, 2> points;
  /// index of the primitive of the mesh that contains the first point; triangles are numbered first, then segments,
  /// then points
  std::size_t primitive = 0;
  SiteId site;                  ///< site of the other mesh that contains the second point
  std::size_t evaluations = 0;  ///< number of points at which the distance was computed
};

template <>
struct Description<DirectedHausdorff> {
  static constexpr std::string_view name = "DirectedHausdorff";
  static constexpr std::string_view doc = "Largest distance of the points of a mesh from another mesh";
  static constexpr std::tuple members{
      Member{"lower", &DirectedHausdorff::lower, "mesh units", "lower bound of the distance"},
      Member{"upper", &DirectedHausdorff::upper, "mesh units", "upper bound of the distance"},
      Member{"points", &DirectedHausdorff::points, "mesh units",
             "point of the mesh whose distance from the other mesh is at least 'lower', and its closest point on the "
             "other mesh"},
      Member{"primitive", &DirectedHausdorff::primitive, "",
             "index of the primitive of the mesh that contains the first point: triangles first, then segments, then "
             "points"},
      Member{"site", &DirectedHausdorff::site, "", "site of the other mesh that contains the second point"},
      Member{"evaluations", &DirectedHausdorff::evaluations, "", "number of points at which the distance was computed"},
  };
};

/// Interval, from `lower` to `upper`, that contains the Hausdorff distance of two meshes: the larger of the two
/// one-sided distances.
struct HausdorffDistance {
  double lower = 0;  ///< Mesh units.
  double upper = 0;
  /// A point of the first mesh, then a point of the second mesh. The two points are at least `lower` apart, and one of
  /// them is the closest point of its mesh to the other point.
  std::array<Vec3d, 2> points;
  DirectedHausdorff forward;   ///< distance of the first mesh from the second
  DirectedHausdorff backward;  ///< distance of the second mesh from the first
};

template <>
struct Description<HausdorffDistance> {
  static constexpr std::string_view name = "HausdorffDistance";
  static constexpr std::string_view doc = "Hausdorff distance of two meshes";
  static constexpr std::tuple members{
      Member{"lower", &HausdorffDistance::lower, "mesh units", "lower bound of the distance"},
      Member{"upper", &HausdorffDistance::upper, "mesh units", "upper bound of the distance"},
      Member{"points", &HausdorffDistance::points, "mesh units",
             "a point of each mesh, at least 'lower' apart; one of them is the closest point of its mesh to the other "
             "point"},
      Member{"forward", &HausdorffDistance::forward, "", "distance of the first mesh from the second"},
      Member{"backward", &HausdorffDistance::backward, "", "distance of the second mesh from the first"},
  };
};

/// Computes the one-sided Hausdorff distance of `mesh` from `other`.
///
/// @param mesh, other  any soups of triangles, segments and points.
/// @return             an interval that contains the distance, rounding included. The interval is at most as wide as
///                     the tolerance, unless max_points ended the search. Tolerances below 1e-13 times the largest
///                     coordinate are raised to this value. The result is the same for any number of threads.
/// @throws InvalidMesh, also if the larger mesh, or the distance between the meshes, is more than 1e140 times as large
/// as the smaller mesh.
/// @throws InvalidOption, Cancelled.
/// Cost: two hierarchies of boxes are built, and the distance of each vertex is found by one search. Then the search
/// adds points near the points with the largest distances, until the tolerance is reached. If n triangles coincide
/// without sharing vertices, the cost is O(n^2).
/// Method: docs/theory/surface-maps.md.
[[nodiscard]] DirectedHausdorff directed_hausdorff_distance(const MeshView& mesh, const MeshView& other,
                                                            const HausdorffOptions& options = {},
                                                            const Context& context = {});

/// Computes the Hausdorff distance of two meshes: the larger of the two one-sided distances. The distances are those of
/// all points of the primitives, not only of vertices.
[[nodiscard]] HausdorffDistance hausdorff_distance(const MeshView& a, const MeshView& b,
                                                   const HausdorffOptions& options = {}, const Context& context = {});

}  // namespace blum
