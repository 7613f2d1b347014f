// Blum: connected components of complexes, and their union. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Returns for each vertex the smallest vertex of its connected component, which represents it.
/// @throws InvalidOption if an edge or a triangle names a vertex that does not exist, or one twice.
/// Cost: near-linear.
[[nodiscard]] std::vector<std::uint32_t> components(const ComplexView& complex);

/// Returns all given complexes in one, one after the other, without joining anything.
/// @throws InvalidOption if the complexes that have vertices (edges, triangles) differ in their columns or the order of
/// these. Also if the result has more than 2^31 - 1 vertices.
[[nodiscard]] Complex disjoint_union(std::span<const Complex> parts);

}  // namespace blum
