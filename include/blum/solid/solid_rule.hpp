// Blum: rules that define a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "blum/core/describe.hpp"

namespace blum {

/// Rule that defines a solid, and so the meaning of a certificate.
enum class SolidRule : std::uint8_t {
  polyhedron,  ///< Bounded by the closed shells of a mesh. Tunnels and voids are known exactly.
  winding,  ///< Where the winding number is above 1/2. The mesh is open, crosses itself or is not manifold. As voxels
            ///< it consists of those whose centre is inside, and only their topology is preserved.
  voxels    ///< Union of the selected, closed voxels of an image.
};

template <>
struct Description<SolidRule> {
  static constexpr std::string_view name = "SolidRule";
  static constexpr std::array values{NamedValue{SolidRule::polyhedron, "polyhedron"},
                                     NamedValue{SolidRule::winding, "winding"},
                                     NamedValue{SolidRule::voxels, "voxels"}};
};

}  // namespace blum
