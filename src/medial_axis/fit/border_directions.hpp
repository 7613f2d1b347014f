// Blum: directions in which borders of sheets and ends of curves slide. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum::detail {

/// Directions in which vertices of rims, and ends of seams and curves, may slide. They are unit vectors, or zero if
/// unknown.
class BorderDirections {
 public:
  /// @param kinds  the kind of each vertex. All arguments must outlive this object.
  BorderDirections(const AxisLists& lists, const Incidence& incidence, const std::vector<Kind>& kinds)
      : lists_(lists), incidence_(incidence), kinds_(kinds) {}

  /// Returns the direction away from the sheet at a vertex of a rim, computed from up to four edges of the rim on
  /// either side.
  [[nodiscard]] Vec3d of_rim(std::uint32_t v) const;
  /// Returns the direction along the sheet in which its depth decreases: from a vertex towards its two footprints.
  [[nodiscard]] Vec3d towards_surface(std::uint32_t v) const;
  /// Returns the direction in which a seam or curve ends at a vertex, from the last one or two of its edges. Edges are
  /// used if they have at least `triangles` triangles; for curves, `triangles` is 0, and only edges without triangles
  /// are used.
  [[nodiscard]] Vec3d of_end(std::uint32_t v, std::size_t triangles) const;
  /// Returns true if the last edge of a curve runs beside another, longer edge of a curve from the same vertex. Such an
  /// edge will be removed, so its end must not slide along the longer edge.
  [[nodiscard]] bool comes_back(std::uint32_t v) const;

 private:
  /// Returns a vector in the plane of the only triangle of an edge. It points outwards, at right angles to the edge,
  /// and is as long as the edge.
  [[nodiscard]] Vec3d outwards_of(std::uint32_t e) const;

  const AxisLists& lists_;
  const Incidence& incidence_;
  const std::vector<Kind>& kinds_;
};

}  // namespace blum::detail
