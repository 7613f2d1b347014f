// Blum: removal of parts of an axis outside of its exact borders. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/fit/fit_axis.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum::detail {

/// Removes vertices of sheets like decimate(), but only far from all vertices that fitting may move. Fitting may move
/// vertices of borders, seams and curves, and those where a sheet bends. It may also move vertices that have one
/// footprint only, have an angle little above theta, or lie next to the surface. In large parts, fitting moves only a
/// few of the vertices. Each step of fitting examines all vertices, so it is faster with fewer of them.
/// @param incidence  the incidence of the lists.
/// @return  largest move of sheets, mesh units; at most a sixteenth of the tolerance of the target.
/// @throws Cancelled. Cost: near-linear in the number of vertices, about 2 us for each.
double thin_insides(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context);

/// Limits of take_crumbs().
struct CrumbLimits {
  double area = 0;    ///< square mesh units: greatest area of a sheet that is removed
  double beside = 0;  ///< mesh units: greatest distance of such a sheet's points from the triangles of other sheets
};

/// Removes small sheets that lie on the sheets that they are attached to. Contractions in thin parts of the solid leave
/// small sheets on other sheets. Each small sheet is collapsed from its free borders. If a part of the sheet would be
/// left, the whole sheet stays. The homotopy type stays, and the remaining cells do not change.
/// @param incidence  the incidence of the lists.
/// @return  true if any sheet was removed.  @throws Cancelled. Cost: linear in the size of the lists, near-linear in
/// the number of removed cells.
bool take_crumbs(AxisLists& lists, const Incidence& incidence, const CrumbLimits& limits, const Context& context);

/// Limits of trim().
struct TrimLimits {
  double theta = 0;  ///< Degrees.
  double thin = 0;   ///< Mesh units: greatest height of a border triangle that is removed as flat.
  /// Mesh units: the same limit for triangles with all corners in the middle of round parts. The angle of such a corner
  /// is larger than that of its two footprints.
  double thin_if_round = 0;
  double whiskers = 0;  ///< Mesh units: single edges of curves up to this length that stick out of a rim are removed.
  double beside = 0;    ///< Mesh units: ends of curves that are at most this far from a sheet are removed.
};

/// Collapses triangles and edges whose vertices all have an angle of at most theta. Collapses proceed from the free
/// borders inwards, as far as homotopy allows. Such cells exist because the axis extends up to one voxel past the line
/// where the angle is theta. Flat triangles whose longest side is a free border are also collapsed.
/// @param incidence  the incidence of the lists.
/// @param angles     angle of each vertex, degrees.
/// @return  true if the lists changed, even if only in their order.  @throws Cancelled. Cost: near-linear.
bool trim(AxisLists& lists, const Incidence& incidence, const std::vector<double>& angles, const TrimLimits& limits,
          const Context& context);

}  // namespace blum::detail
