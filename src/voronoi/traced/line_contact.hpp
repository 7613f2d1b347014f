// Blum: where a site becomes one of the closest along a line. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// A line on which some sites have the same distance.
struct SeamLine {
  TracedSites::Index own = 0;  ///< one of the sites
  Vec3d start;
  Vec3d along;  ///< unit vector
};

/// Returns a path length from the start of a line. Before this length, a site is not as close as the line's own site,
/// or the line lies outside of the site's domain. Distances within twice the tolerance are treated as equal. Sites that
/// are as close at the start, but not 16 tolerances further, are considered only if they become as close again.
///
/// Along a line, distances from planes and squared distances from lines and points are polynomials of degree 1 and 2.
/// So are the heights above the sides of domains. (docs/theory/voronoi.md, "Traced solids".)
/// @param most  larger results may be any value of at least `most`, mesh units.
[[nodiscard]] double way_to_contact(const TracedSites& sites, const SeamLine& line, TracedSites::Index other,
                                    double most);

}  // namespace blum::voronoi
