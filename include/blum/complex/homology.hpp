// Blum: Betti numbers and Euler characteristic of complexes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/complex/complex.hpp"
#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Betti numbers over Z/2 of the complex of the vertices, the edges, the triangles and their edges, by reduction of
/// boundary matrices. Edges and triangles that are named twice count once.
/// @throws InvalidOption for a corner that is no vertex, or an edge or triangle that names one twice; Cancelled.
/// Cost: near-linear for surfaces that meet along few seams.
[[nodiscard]] BettiNumbers homology(const ComplexView& complex, const Context& context = {});

/// Vertices less edges plus triangles, each counted once, also the edges of triangles: the alternating sum of the Betti
/// numbers. @throws as homology(). Cost: that of Incidence.
[[nodiscard]] std::int64_t euler_characteristic(const ComplexView& complex, const Context& context = {});

}  // namespace blum
