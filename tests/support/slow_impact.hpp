// Blum: simple, slow times of impact of moving features. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::test {

/// An interval that contains the time of the first contact. It is at most 2^-60 wide, and has width zero if the time is
/// exact.
struct ContactTime {
  double low;
  double high;
};

/// Uses rational arithmetic and shares no code with the library. Contact can begin only at the start, or at a root of
/// one of the polynomials that decide it. The function checks all these times.
[[nodiscard]] std::optional<ContactTime> slow_vertex_face_impact(const FourMovingPoints& points);
[[nodiscard]] std::optional<ContactTime> slow_edge_edge_impact(const FourMovingPoints& points);

/// The first time at which the features are at most a positive distance apart.
[[nodiscard]] std::optional<ContactTime> slow_vertex_face_approach(const FourMovingPoints& points, double distance);
[[nodiscard]] std::optional<ContactTime> slow_edge_edge_approach(const FourMovingPoints& points, double distance);

}  // namespace blum::test
