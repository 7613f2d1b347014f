// Blum: how far triangles are apart, slowly and obviously. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

#include "blum/core/vec3.hpp"

namespace blum::test {

/// The square of the distance of two triangles, which may be segments or points: the least one of all pairs of their
/// parts, in rational numbers; 0 where an edge of one passes through the other. Shares nothing with the library.
[[nodiscard]] boost::multiprecision::cpp_rational slow_squared_distance(const std::array<Vec3d, 3>& a,
                                                                        const std::array<Vec3d, 3>& b);

}  // namespace blum::test
