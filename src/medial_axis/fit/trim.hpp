// Blum: removal of parts of an axis outside of its exact borders. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/fit/fit_axis.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum::detail {

/// Takes vertices out of sheets like decimate(), but only far from all that fitting may move. Fitting may move borders,
/// seams, curves and places where a sheet bends. It may also move vertices that know of one wall only, see little more
/// than theta, or lie next to the surface. Most vertices of large parts are none of these, and each step of fitting
/// examines all vertices.
/// @param incidence  of the lists.
/// @return  largest move of sheets, mesh units; at most a sixteenth of the tolerance of the target.
/// @throws Cancelled. Cost: near-linear, about 2 us for each vertex.
double thin_insides(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context);

/// Limits of take_crumbs().
struct CrumbLimits {
  double area = 0;    ///< square mesh units: greatest area of a sheet
  double beside = 0;  ///< mesh units: greatest distance of its points from the triangles of other sheets
};

/// Removes small sheets that lie on the sheets that they are attached to, as contractions in thin walls leave them.
/// Each is collapsed from its free borders, or stays whole if something of it would be left. The homotopy type stays,
/// and the remaining cells are as they were.
/// @param incidence  of the lists.
/// @return  true if any was removed.  @throws Cancelled. Cost: linear in the lists, near-linear in what is taken.
bool take_crumbs(AxisLists& lists, const Incidence& incidence, const CrumbLimits& limits, const Context& context);

/// Limits of trim().
struct TrimLimits {
  double theta = 0;  ///< Degrees.
  double thin = 0;   ///< Mesh units: triangles this close to their other sides all over are removed.
  /// The same if all corners are in the middle of round parts: there, more is seen than between their footprints.
  double thin_if_round = 0;
  double whiskers = 0;  ///< Mesh units: ends of curves up to this length that stick out of a rim are removed.
  double beside = 0;    ///< Mesh units: ends of curves this close to a sheet are removed.
};

/// Collapses triangles and edges none of whose vertices sees two footprints at more than theta apart. Collapses run
/// from the free borders inwards, as far as homotopy allows. Such cells exist because the axis extends up to one
/// voxel past the line where the angle is theta. Flat triangles that lie on their other sides are collapsed, too.
/// @param incidence  of the lists.
/// @param angles     that each vertex sees, degrees.
/// @return  true if the lists changed, if only in their order.  @throws Cancelled. Cost: near-linear.
bool trim(AxisLists& lists, const Incidence& incidence, const std::vector<double>& angles, const TrimLimits& limits,
          const Context& context);

}  // namespace blum::detail
