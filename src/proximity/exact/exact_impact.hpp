// Blum: times at which moving features meet, without rounding. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::detail {

/// Returns the first time at which a vertex and a face, or two edges, are at most a given distance apart. The distance
/// must be positive. Times are defined as for vertex_face_impact(). Cost: at most a few milliseconds for usual
/// coordinates.
[[nodiscard]] std::optional<double> exact_vertex_face_approach(const FourMovingPoints& points, double distance,
                                                               double tolerance);
[[nodiscard]] std::optional<double> exact_edge_edge_approach(const FourMovingPoints& points, double distance,
                                                             double tolerance);

/// Computes the results of vertex_face_impact() and edge_edge_impact() by integers alone, for any finite coordinates.
/// Cost: about 10 to 100 times that of filtered_impact(), if filtered_impact() decides the answer.
[[nodiscard]] std::optional<double> exact_vertex_face_impact(const FourMovingPoints& points, double tolerance);
[[nodiscard]] std::optional<double> exact_edge_edge_impact(const FourMovingPoints& points, double tolerance);

}  // namespace blum::detail
