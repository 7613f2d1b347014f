// Blum: where the borders of an axis go on. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/fit/kind.hpp"

namespace blum {

/// Directions in which vertices of rims, and ends of seams and curves, may slide; of unit length, or zero where none is
/// told.
class BorderDirections {
 public:
  /// @param kinds  of the vertices. All must stay.
  BorderDirections(const AxisLists& lists, const Incidence& incidence, const std::vector<Kind>& kinds)
      : lists_(lists), incidence_(incidence), kinds_(kinds) {}

  /// Away from the sheet, from edges of the rim near by.
  [[nodiscard]] Vec3d of_rim(std::uint32_t v) const;
  /// Along the sheet to where it is less deep: over convex edges that it ends at.
  [[nodiscard]] Vec3d towards_surface(std::uint32_t v) const;
  /// Away from the only neighbour along a seam (of at least so many triangles) or curve (of none).
  [[nodiscard]] Vec3d of_end(std::uint32_t v, std::size_t triangles) const;
  /// Whether a curve that ends at a vertex comes back there beside a longer edge: it is to be taken away, and not to
  /// follow the other one.
  [[nodiscard]] bool comes_back(std::uint32_t v) const;

 private:
  /// From a triangle outwards through its side, as long as the side.
  [[nodiscard]] Vec3d outwards_of(std::uint32_t e) const;

  const AxisLists& lists_;
  const Incidence& incidence_;
  const std::vector<Kind>& kinds_;
};

}  // namespace blum
