// Blum: Betti numbers and Euler characteristic of complexes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/complex/complex.hpp"
#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Returns the Betti numbers over Z/2 of a complex. The function reduces boundary matrices. Sides of triangles count as
/// edges, even if they are not listed. An edge or triangle that is listed twice counts once.
/// @throws InvalidOption if an edge or triangle has a vertex that does not exist, or the same vertex twice; Cancelled.
/// Cost: near-linear for surfaces that meet along few seams.
[[nodiscard]] BettiNumbers homology(const ComplexView& complex, const Context& context = {});

/// Returns the number of vertices, minus the number of edges, plus the number of triangles. The Euler characteristic is
/// the alternating sum of the Betti numbers. Sides of triangles count as edges, even if they are not listed. An edge or
/// triangle that is listed twice counts once.
/// @throws as homology().
/// Cost: that of constructing Incidence.
[[nodiscard]] std::int64_t euler_characteristic(const ComplexView& complex, const Context& context = {});

}  // namespace blum
