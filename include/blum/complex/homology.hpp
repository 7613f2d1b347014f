// Blum: Betti numbers and Euler characteristic of complexes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/complex/complex.hpp"
#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Returns the Betti numbers over Z/2 of a complex, which consists of its vertices, edges, triangles and sides of
/// triangles. They are computed by reduction of boundary matrices. Edges and triangles that occur twice count once.
/// @throws InvalidOption if a corner is not a vertex, or an edge or triangle names one twice; Cancelled.
/// Cost: near-linear for surfaces that meet along few seams.
[[nodiscard]] BettiNumbers homology(const ComplexView& complex, const Context& context = {});

/// Returns the number of vertices minus edges plus triangles, which is the alternating sum of the Betti numbers. Sides
/// of triangles are edges, too. Each cell counts once.
/// @throws as homology().
/// Cost: that of Incidence.
[[nodiscard]] std::int64_t euler_characteristic(const ComplexView& complex, const Context& context = {});

}  // namespace blum
