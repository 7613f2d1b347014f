// Blum: when moving features meet, without rounding. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::detail {

/// The answers of vertex_face_impact() and edge_edge_impact() by integers alone: for any finite coordinates, some ten
/// to a hundred times as slow as by doubles where these tell.
[[nodiscard]] std::optional<double> exact_vertex_face_impact(const FourMovingPoints& points, double tolerance);
[[nodiscard]] std::optional<double> exact_edge_edge_impact(const FourMovingPoints& points, double tolerance);

}  // namespace blum::detail
