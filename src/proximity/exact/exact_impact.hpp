// Blum: times at which moving features meet, without rounding. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::detail {

/// Returns the first time at which a vertex and a face, or two edges, are no further apart than a distance. The
/// distance must be positive. Times are those of vertex_face_impact(). Takes some milliseconds at most for usual
/// coordinates.
[[nodiscard]] std::optional<double> exact_vertex_face_approach(const FourMovingPoints& points, double distance,
                                                               double tolerance);
[[nodiscard]] std::optional<double> exact_edge_edge_approach(const FourMovingPoints& points, double distance,
                                                             double tolerance);

/// Computes the results of vertex_face_impact() and edge_edge_impact() by integers alone, for any finite coordinates.
/// Takes some ten to a hundred times as long as doubles that decide the answer.
[[nodiscard]] std::optional<double> exact_vertex_face_impact(const FourMovingPoints& points, double tolerance);
[[nodiscard]] std::optional<double> exact_edge_edge_impact(const FourMovingPoints& points, double tolerance);

}  // namespace blum::detail
