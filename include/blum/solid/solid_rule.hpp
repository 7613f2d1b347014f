// Blum: rules that define a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "blum/core/describe.hpp"

namespace blum {

/// Rule that defines a solid, and so the meaning of a certificate.
enum class SolidRule : std::uint8_t {
  polyhedron,  ///< Solid that the closed shells of a mesh bound. The tunnels and voids of the solid are known exactly.
  winding,     ///< Points with a winding number above 1/2. Used if the mesh is open, crosses itself or is not manifold.
               ///< Results preserve only the topology of the voxels whose centres are inside.
  voxels       ///< Union of the selected, closed voxels of an image.
};

template <>
struct Description<SolidRule> {
  static constexpr std::string_view name = "SolidRule";
  static constexpr std::array values{NamedValue{SolidRule::polyhedron, "polyhedron"},
                                     NamedValue{SolidRule::winding, "winding"},
                                     NamedValue{SolidRule::voxels, "voxels"}};
};

}  // namespace blum
