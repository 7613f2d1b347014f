// Blum: what a solid is. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace blum {

/// What a solid is, and so what a certificate is worth.
enum class SolidRule : std::uint8_t {
  polyhedron,  ///< what the closed shells of a mesh bound: tunnels and voids are known exactly
  winding,  ///< where the winding number is above 1/2: the mesh is open, crosses itself or is not manifold. As voxels
            ///< it is those whose centre is inside, and only the topology of these voxels is kept
  voxels    ///< the union of the selected, closed voxels of an image
};

[[nodiscard]] constexpr std::string_view to_string(SolidRule rule) {
  switch (rule) {
    case SolidRule::polyhedron:
      return "polyhedron";
    case SolidRule::winding:
      return "winding";
    case SolidRule::voxels:
      return "voxels";
  }
  return "unknown";
}

}  // namespace blum
