// Blum: when a vertex meets a face, or an edge an edge, as they move. SPDX-License-Identifier: Apache-2.0
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
  std::array<Vec3d, 4> start;  ///< mesh units, finite
  std::array<Vec3d, 4> end;    ///< mesh units, finite
};

/// Options of questions about continuous collisions.
struct ImpactOptions {
  /// How much earlier than the true time of impact the one told may be, as a part of the motion: 2^-40 to 1.
  double tolerance = 1e-6;
  /// How close, in mesh units, counts as meeting: 0 to 1e150. With 0, features must have a point in common.
  double min_separation = 0;
};

template <>
struct Description<ImpactOptions> {
  static constexpr std::string_view name = "ImpactOptions";
  static constexpr std::string_view doc = "What continuous collisions are asked for";
  static constexpr std::tuple members{
      Member{"tolerance", &ImpactOptions::tolerance, "parts of the motion",
             "how much earlier than the true time of impact the one told may be", Range::between(0x1p-40, 1)},
      Member{"min_separation", &ImpactOptions::min_separation, "mesh units",
             "how close counts as meeting; 0: features must have a point in common", Range::between(0, 1e150)},
  };
};

/// @throws InvalidOption.
void check(const ImpactOptions& options);

/// The first time at which a moving vertex lies in a moving triangle, its border included.
///
/// With a minimum separation, the first time at which they are no further apart than that.
///
/// Whether there is one is exact for the coordinates as they are: no contact is missed, none is made up, whatever the
/// motion: triangles may lose their area and turn over, points may stay in a plane or at a place.
/// @param points  the vertex, then the corners of the triangle.
/// @return        nullopt where they never meet; else a time from 0 to 1, no later than the first contact, and no more
///                than options.tolerance earlier.
/// @throws InvalidMesh where a coordinate is not finite; InvalidOption.
/// Cost: 0.1 microseconds where simple bounds tell them apart, 1 for most contacts, some 10 where doubles do not
/// decide. Method: docs/theory/proximity.md.
[[nodiscard]] std::optional<double> vertex_face_impact(const FourMovingPoints& points,
                                                       const ImpactOptions& options = {});

/// The first time at which two moving edges have a point in common, their ends included; see vertex_face_impact().
/// @param points  the ends of one edge, then those of the other.
[[nodiscard]] std::optional<double> edge_edge_impact(const FourMovingPoints& points, const ImpactOptions& options = {});

/// The same for many, threaded. @throws Cancelled besides.
[[nodiscard]] std::vector<std::optional<double>> vertex_face_impacts(std::span<const FourMovingPoints> points,
                                                                     const ImpactOptions& options = {},
                                                                     const Context& context = {});
[[nodiscard]] std::vector<std::optional<double>> edge_edge_impacts(std::span<const FourMovingPoints> points,
                                                                   const ImpactOptions& options = {},
                                                                   const Context& context = {});

}  // namespace blum
