// Blum: spot checks, so that no wrong result counts as a fast one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include "blum/field/field.hpp"
#include "support/shapes.hpp"

namespace blum::bench {

/// Compares random nodes of a field with brute force in double: 100 nodes, fewer on meshes above 400,000 sites. Checks
/// the distance, the distance of the reported site or triangle and, if signed, the side by the full winding number.
/// Skips nodes whose distance is NaN, which were not computed, and sites that are none().
/// Adds the counters checked and worst_error (relative to the diagonal of mesh and grid). Fails the benchmark if an
/// error is above the tolerance.
void spot_check(benchmark::State& state, const Shape& shape, const Field& field, double tolerance = 1e-6);

}  // namespace blum::bench
