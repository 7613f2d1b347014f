// Blum: equations of contacts that follow from symmetry. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// Equations that other equations imply, exactly, and the symmetry that shows it.
struct ImpliedEquations {
  std::vector<bool> distance;  ///< for each group: its distance is that of the first group
  std::vector<bool> planes;    ///< for each group: its points lie in the planes between its members
  /// For each group: its mirror image, if there is one; otherwise the group itself.
  std::vector<std::size_t> image;
  std::size_t mirrors = 0;  ///< number of mirrors that imply equations
  bool has_slabs = false;   ///< equal widths imply equations

  [[nodiscard]] bool is_any() const { return mirrors > 0 || has_slabs; }
};

/// Finds implied equations of groups of sites with one distance. Doubles with rounding cannot show them, but
/// coordinates can:
///
/// - Faces at right angles to an axis that face each other make a slab. The sum of both distances is its width. If
/// slabs
///   across several axes have the same width, as in a square bar, one face of each slab after the first is implied.
/// - Two groups are mirror images if the corners of one are those of the other, with coordinates mirrored along an
/// axis.
///   Their distances are equal in the plane of the mirror, and so are the planes between their members. If several
///   pairs have the same mirror, one distance of each pair after the first is implied.
///
/// @param mesh    of the sites.
/// @param groups  the first one has no equation for its distance.
[[nodiscard]] ImpliedEquations implied_equations(const TracedSites& traced, const MeshView& mesh,
                                                 const std::vector<std::vector<TracedSites::Index>>& groups);

}  // namespace blum::voronoi
