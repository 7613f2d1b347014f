// Blum: numbers of components, tunnels and voids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace blum {

/// Betti numbers of a space in three dimensions: components, tunnels and voids.
using BettiNumbers = std::array<std::int64_t, 3>;

}  // namespace blum
