// Blum: what a solid is. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "blum/core/describe.hpp"

namespace blum {

/// What a solid is, and so what a certificate is worth.
enum class SolidRule : std::uint8_t {
  polyhedron,  ///< what the closed shells of a mesh bound: tunnels and voids are known exactly
  winding,  ///< where the winding number is above 1/2: the mesh is open, crosses itself or is not manifold. As voxels
            ///< it is those whose centre is inside, and only the topology of these voxels is kept
  voxels    ///< the union of the selected, closed voxels of an image
};

template <>
struct Description<SolidRule> {
  static constexpr std::string_view name = "SolidRule";
  static constexpr std::array values{NamedValue{SolidRule::polyhedron, "polyhedron"},
                                     NamedValue{SolidRule::winding, "winding"},
                                     NamedValue{SolidRule::voxels, "voxels"}};
};

}  // namespace blum
