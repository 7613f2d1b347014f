// Blum: when moving features come close, without rounding. SPDX-License-Identifier: Apache-2.0
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

}  // namespace blum::detail
