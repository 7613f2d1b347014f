// Blum: spot checks, so that no wrong answer counts as a fast one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include "blum/field/field.hpp"
#include "support/shapes.hpp"

namespace blum::bench {

/// Compares random nodes of a field (100, fewer on meshes above 400,000 sites) with brute force in double: distance,
/// the distance of the site or triangle that the field names, and, when signed, the side by the full winding number.
/// Nodes whose distance is NaN were not computed and are passed over; so is the site where it is none().
/// Adds the counters checked and worst_error (relative to the diagonal of mesh and grid), and fails the benchmark when
/// an error is above the tolerance.
void spot_check(benchmark::State& state, const Shape& shape, const Field& field, double tolerance = 1e-6);

}  // namespace blum::bench
