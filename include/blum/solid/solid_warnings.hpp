// Blum: warnings about solids that differ from the given mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/warning.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// Returns a warning if triangles were reversed, and another warning if shells were reversed. The code of both is
/// WarningCode::reversed_shells.
/// @param triangles, shells  numbers of reversed triangles and shells, from Solid::reversed_triangles() and
///                           Solid::reversed_shells(), or from a CleanReport.
[[nodiscard]] std::vector<Warning> reversal_warnings(std::size_t triangles, std::size_t shells);

/// If crossings were resolved, returns a warning that results refer to Solid::surface(), not to the mesh
/// (WarningCode::crossings_removed). Otherwise returns an empty list.
[[nodiscard]] std::vector<Warning> crossing_warnings(const Solid& solid);

/// Returns reversal_warnings() and crossing_warnings() of a solid.
[[nodiscard]] std::vector<Warning> solid_warnings(const Solid& solid);

}  // namespace blum
