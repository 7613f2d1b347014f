// Blum: seams that leave a point. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/vec3.hpp"
#include "voronoi/traced/local_star.hpp"
#include "voronoi/traced/seam_tracer.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// A seam that leaves a point.
struct LeavingSeam {
  SeamRay ray;
  TracedCurve curve;
  Vec3d start;  ///< a point of the seam: the given point, or a point near it
  Vec3d chord;  ///< direction of a point of the seam, a unit vector; seams with one tangent differ in it
};

/// Returns the seams that leave a point. Several seams may have one tangent, and sites may be equally close only to
/// first order. The section with a plane near the point shows which seams exist.
/// @param found  the closest sites of `at`, ascending.
[[nodiscard]] std::vector<LeavingSeam> leaving_seams(const TracedSites& sites, const SeamTracer& tracer,
                                                     const Vec3d& at, const std::vector<TracedSites::Index>& found);

}  // namespace blum::voronoi
