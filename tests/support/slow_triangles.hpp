// Blum: simple, slow distances of triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

#include "blum/core/vec3.hpp"

namespace blum::test {

/// The squared distance of two triangles, which may be segments or points, in rational numbers. It is the minimum over
/// all pairs of their parts, and 0 if an edge of one passes through the other. Shares no code with the library.
[[nodiscard]] boost::multiprecision::cpp_rational slow_squared_distance(const std::array<Vec3d, 3>& a,
                                                                        const std::array<Vec3d, 3>& b);

}  // namespace blum::test
