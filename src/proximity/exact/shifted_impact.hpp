// Blum: times at which features meet that keep their shape. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/proximity/impact.hpp"
#include "proximity/impact_filter.hpp"

namespace blum::detail {

/// Returns the time at which two features meet, if each of them only translates: its vertices all move by exactly the
/// same vector. Faces and edges of rigid bodies that do not rotate only translate, and may be parallel or coplanar.
///
/// Exact: uses integers of a fixed width that no intermediate result exceeds. Returns `unknown` if a feature does more
/// than translate, or if a triangle has no area or an edge no length. Also returns `unknown` if coordinates along an
/// axis need more than 62 bits. Cost: 0.1 microseconds for coordinates of at most 10 bits, about 1 microsecond for
/// those of 62 bits.
[[nodiscard]] FilteredImpact shifted_impact(const FourMovingPoints& points, FeatureKinds kinds, double tolerance);

}  // namespace blum::detail
