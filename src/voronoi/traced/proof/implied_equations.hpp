// Blum: equations of contacts that follow from symmetry. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// The plane of a mirror that implies equations: in it, two groups have the same distance.
struct MirrorPlane {
  std::size_t first, second;  ///< groups
  Vec3d normal;               ///< unit vector
};

/// Equations that other equations imply, exactly, and the symmetry that shows it.
struct ImpliedEquations {
  std::vector<bool> distance;  ///< for each group: its distance is that of the first group
  std::vector<bool> planes;    ///< for each group: points lie in the planes between members
  /// The mirror image of each group, if there is one; otherwise the group itself.
  std::vector<std::size_t> image;
  std::size_t mirrors = 0;  ///< number of mirrors that imply equations
  std::vector<MirrorPlane> planes_of_mirrors;
  bool has_slabs = false;  ///< equal widths imply equations

  [[nodiscard]] bool is_any() const { return mirrors > 0 || has_slabs; }
};

/// Finds implied equations of groups of sites with one distance. Doubles with rounding cannot show them, but
/// coordinates can.
///
/// Slabs: faces exactly at right angles to an axis that face each other. The sum of both distances is the width. Slabs
/// across several axes may have the same width, as in a square bar. One face of each slab after the first is then
/// implied.
///
/// Mirrors: the corners of one group are those of another one, mirrored along an axis, or with two axes exchanged. The
/// distances of both are equal in the plane of the mirror, and so are the planes between their members. Several pairs
/// may have the same mirror. One distance of each pair after the first is then implied.
///
/// @param mesh    of the sites.
/// @param groups  the first one has no equation for its distance.
[[nodiscard]] ImpliedEquations implied_equations(const TracedSites& traced, const MeshView& mesh,
                                                 const std::vector<std::vector<TracedSites::Index>>& groups);

}  // namespace blum::voronoi
