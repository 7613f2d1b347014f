// Blum: warnings about solids that differ from the given mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/warning.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// Returns a warning that triangles or shells were reversed (WarningCode::reversed_shells); none if both numbers are 0.
/// @param triangles, shells Solid::reversed_triangles(), Solid::reversed_shells(), or those of a CleanReport.
[[nodiscard]] std::vector<Warning> reversal_warnings(std::size_t triangles, std::size_t shells);

/// Returns a warning that results refer to Solid::surface(), which has no crossings, and not to the mesh
/// (WarningCode::crossings_removed). Returns none if nothing was resolved.
[[nodiscard]] std::vector<Warning> crossing_warnings(const Solid& solid);

/// Returns both kinds of warnings of a solid.
[[nodiscard]] std::vector<Warning> solid_warnings(const Solid& solid);

}  // namespace blum
