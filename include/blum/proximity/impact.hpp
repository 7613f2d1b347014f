// Blum: times of impact of moving vertices, faces and edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Four points that move along straight lines, each at its own constant speed, from time 0 to time 1.
struct FourMovingPoints {
  std::array<Vec3d, 4> start;  ///< Mesh units, finite.
  std::array<Vec3d, 4> end;    ///< Mesh units, finite.
};

/// Options of continuous collisions.
struct ImpactOptions {
  /// Largest time by which a reported impact may precede the true one, as a fraction of the motion: 2^-40 to 1.
  double tolerance = 1e-6;
  /// Distance at or below which a vertex and a face, or two edges, meet: 0 to 1e150, mesh units. With 0, they meet only
  /// if they have a point in common.
  double min_separation = 0;
};

template <>
struct Description<ImpactOptions> {
  static constexpr std::string_view name = "ImpactOptions";
  static constexpr std::string_view doc = "Options of continuous collisions";
  static constexpr std::tuple members{
      Member{"tolerance", &ImpactOptions::tolerance, "parts of the motion",
             "largest time by which a reported impact may precede the true one", Range::between(0x1p-40, 1)},
      Member{"min_separation", &ImpactOptions::min_separation, "mesh units",
             "distance at or below which features meet; 0: they must have a point in common", Range::between(0, 1e150)},
  };
};

/// Checks the options.
/// @throws InvalidOption if an option is out of range.
void check(const ImpactOptions& options);

/// Returns the first time at which a moving vertex lies in a moving triangle, its border included.
///
/// If options.min_separation is above 0, returns the first time at which the distance of vertex and triangle is at most
/// options.min_separation.
///
/// The existence of a contact is exact for the given coordinates: for every motion, no contact is missed, and no
/// reported contact is false. Triangles may lose their area and turn over. The four points may stay in one plane, or
/// not move at all.
/// @param points  the vertex, then the corners of the triangle.
/// @return        nullopt if vertex and triangle never meet. Otherwise the time of the first contact, 0 to 1. The time
///                is rounded down to a multiple of the largest power of two that is at most options.tolerance.
/// @throws InvalidMesh if a coordinate is not finite; InvalidOption.
/// Cost: 0.1 microseconds if simple bounds separate vertex and triangle, 1 microsecond for most contacts. If both
/// features only translate: 0.2 to 1 microsecond. For other motions that doubles do not decide: about 10.
/// Method: docs/theory/proximity.md.
[[nodiscard]] std::optional<double> vertex_face_impact(const FourMovingPoints& points,
                                                       const ImpactOptions& options = {});

/// Returns the first time at which two moving edges, including their ends, have a point in common. For options, errors
/// and cost see vertex_face_impact().
/// @param points  the two ends of the first edge, then the two ends of the second edge.
[[nodiscard]] std::optional<double> edge_edge_impact(const FourMovingPoints& points, const ImpactOptions& options = {});

/// Return the times of impact of many pairs: of a vertex and a face, or of two edges. Several threads share the work.
/// @throws Cancelled; otherwise as vertex_face_impact().
[[nodiscard]] std::vector<std::optional<double>> vertex_face_impacts(std::span<const FourMovingPoints> points,
                                                                     const ImpactOptions& options = {},
                                                                     const Context& context = {});
[[nodiscard]] std::vector<std::optional<double>> edge_edge_impacts(std::span<const FourMovingPoints> points,
                                                                   const ImpactOptions& options = {},
                                                                   const Context& context = {});

}  // namespace blum
