// Blum: when moving features meet, without rounding. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::detail {

/// When a vertex and a face, or two edges, are for the first time no further apart than a distance, which is positive:
/// as impacts are told. Some milliseconds at most for usual coordinates.
[[nodiscard]] std::optional<double> exact_vertex_face_approach(const FourMovingPoints& points, double distance,
                                                               double tolerance);
[[nodiscard]] std::optional<double> exact_edge_edge_approach(const FourMovingPoints& points, double distance,
                                                             double tolerance);

/// The answers of vertex_face_impact() and edge_edge_impact() by integers alone: for any finite coordinates, some ten
/// to a hundred times as slow as by doubles where these tell.
[[nodiscard]] std::optional<double> exact_vertex_face_impact(const FourMovingPoints& points, double tolerance);
[[nodiscard]] std::optional<double> exact_edge_edge_impact(const FourMovingPoints& points, double tolerance);

}  // namespace blum::detail
