// Blum: when moving features meet, slowly and obviously. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::test {

/// An interval of times that holds the first contact, and is no wider than 2^-60; of width zero where it is met
/// exactly.
struct ContactTime {
  double low;
  double high;
};

/// By rational arithmetic: whether the features meet is asked at all roots of all polynomials that say it, as it can
/// begin nowhere else but at the start. Shares nothing with the library.
[[nodiscard]] std::optional<ContactTime> slow_vertex_face_impact(const FourMovingPoints& points);
[[nodiscard]] std::optional<ContactTime> slow_edge_edge_impact(const FourMovingPoints& points);

/// The first time at which they are no further apart than a distance, which is positive.
[[nodiscard]] std::optional<ContactTime> slow_vertex_face_approach(const FourMovingPoints& points, double distance);
[[nodiscard]] std::optional<ContactTime> slow_edge_edge_approach(const FourMovingPoints& points, double distance);

}  // namespace blum::test
