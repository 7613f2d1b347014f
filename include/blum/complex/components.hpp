// Blum: connected components of complexes, and their union. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// For each vertex the smallest vertex of its connected component, which stands for it.
/// @throws InvalidOption for an edge or a triangle that names a vertex that is none, or one twice. Cost: near-linear.
[[nodiscard]] std::vector<std::uint32_t> components(const ComplexView& complex);

/// All of some complexes in one, one behind the other, with nothing joined.
/// @throws InvalidOption unless those that have vertices (edges, triangles) have the same columns on them, in one
/// order.
[[nodiscard]] Complex disjoint_union(std::span<const Complex> parts);

}  // namespace blum
