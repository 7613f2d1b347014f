// Blum: what of an axis lies outside of its exact borders. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/fit/fit_axis.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum::detail {

/// Takes vertices out of sheets, as decimate() does, but far from all that fitting may move: borders, seams and curves;
/// vertices that know of one wall only, see little more than theta, or lie next to the surface; and where a sheet
/// bends. Most vertices of large parts are none of these, and each step of fitting looks at all that there are.
/// @param incidence  of the lists.
/// @return  how far sheets moved at most, mesh units: a sixteenth of the tolerance of the target.
/// @throws Cancelled. Cost: near-linear, about 2 us for each vertex.
double thin_insides(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context);

/// What take_crumbs() takes away.
struct CrumbLimits {
  double area = 0;    ///< square mesh units: sheets up to this size,
  double beside = 0;  ///< mesh units: whose points are this close to the triangles of other sheets around them
};

/// Takes away small sheets that lie on the sheets that they are attached to, as contractions in thin walls leave them:
/// collapses each from its free borders, or leaves it whole where that would leave something of it. The homotopy type
/// stays, and what is left is as it was.
/// @param incidence  of the lists.
/// @return  whether there were any.  @throws Cancelled. Cost: linear in the lists, near-linear in what is taken.
bool take_crumbs(AxisLists& lists, const Incidence& incidence, const CrumbLimits& limits, const Context& context);

/// What trim() takes away.
struct TrimLimits {
  double theta = 0;  ///< degrees
  double thin = 0;   ///< mesh units: triangles that are this close to their other sides all over go
  /// The same where all corners are in the middle of what is round: more is seen there than between their footprints.
  double thin_if_round = 0;
  double whiskers = 0;  ///< mesh units: ends of curves up to this length that stick out of a rim go
  double beside = 0;    ///< mesh units: ends of curves this close to a sheet go
};

/// Collapses triangles and edges none of whose vertices sees two footprints at more than theta apart, from the free
/// borders inwards and as long as homotopy lets them go: the cells that an axis is made of reach up to a voxel beyond
/// where the angle is theta. So go flat triangles that lie on their other sides.
/// @param incidence  of the lists.
/// @param angles     that each vertex sees, degrees.
/// @return  whether lists are others than before, be it in their order only.  @throws Cancelled. Cost: near-linear.
bool trim(AxisLists& lists, const Incidence& incidence, const std::vector<double>& angles, const TrimLimits& limits,
          const Context& context);

}  // namespace blum::detail
