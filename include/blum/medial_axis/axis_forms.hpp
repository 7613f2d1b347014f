// Blum: the forms that a medial axis is written in. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/core/context.hpp"
#include "blum/medial_axis/medial_axis.hpp"

namespace blum {

/// A way to take an axis of one angle from that of all angles.
struct AxisForm {
  bool is_fitted = false;           ///< MedialAxis::fitted(), not simplify()
  std::optional<double> tolerance;  ///< vertices go within it (decimate()), mesh units; without it all stay
  std::string without;  ///< what the next form lacks that this one has, for a sentence that goes on with why
};

/// Another grid to try an axis on.
struct MovedGrid {
  double shift = 0;       ///< MedialAxisOptions::grid_shift, voxels
  std::string as_it_was;  ///< how a sentence begins that says that the grid was moved, and goes on with why
};

/// Grids to try where an axis is not certified in any form, although the model of its solid passes: how parts thinner
/// than a voxel lie in the cells is a matter of luck then.
/// @param grid_shift  of the grid that it was not certified on, voxels, from -1 to 1.
[[nodiscard]] std::vector<MovedGrid> moved_grids(double grid_shift);

/// The forms of an axis, the best first: with its borders where they belong and few vertices; with few vertices; as the
/// cells have it. The last one is as good as the cells; the others are for people, and where walls are thin one may
/// fail that the next one does not (see certified_axis()).
/// @param tolerance  mesh units, >= 0; 0 keeps all vertices, and leaves the last form only. Default: a quarter of the
///                   smallest side of a voxel.
[[nodiscard]] std::vector<AxisForm> axis_forms(const MedialAxisReport& report, std::optional<double> tolerance = {});

/// The axis at an angle in a form. @throws as MedialAxis::fitted() and decimate().
[[nodiscard]] DecimatedAxis axis_in_form(const MedialAxis& axis, double theta, const AxisForm& form,
                                         const Context& context = {});

/// What a form leaves of an axis that is given, whether it was fitted or not. @throws as decimate().
[[nodiscard]] DecimatedAxis decimate(Complex whole, const AxisForm& form, const Context& context = {});

/// The smallest side of a voxel of any body, mesh units.
[[nodiscard]] double least_spacing(const MedialAxisReport& report);

}  // namespace blum
