// Blum: connected components of complexes, and their union. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Returns for each vertex the smallest vertex index in its connected component. This index identifies the component.
/// @throws InvalidOption if an edge or a triangle has a vertex that does not exist, or the same vertex twice.
/// Cost: near-linear.
[[nodiscard]] std::vector<std::uint32_t> components(const ComplexView& complex);

/// Returns one complex with the cells of all given complexes, one complex after the other. No vertices are merged.
/// @throws InvalidOption if two complexes with vertices have different vertex columns, or the same columns in another
/// order. Columns of edges and columns of triangles must agree in the same way. Also thrown if the result has more than
/// 2^31 - 1 vertices.
[[nodiscard]] Complex disjoint_union(std::span<const Complex> parts);

}  // namespace blum
