// Blum: what results say where a solid is not that of the mesh as it was given. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/warning.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// That triangles or shells were reversed (WarningCode::reversed_shells); none where both are 0.
/// @param triangles, shells  Solid::reversed_triangles(), Solid::reversed_shells(), or those of a CleanReport.
[[nodiscard]] std::vector<Warning> reversal_warnings(std::size_t triangles, std::size_t shells);

/// That results are those of Solid::surface(), which has no crossings, and not of the mesh
/// (WarningCode::crossings_removed); none where nothing was resolved.
[[nodiscard]] std::vector<Warning> crossing_warnings(const Solid& solid);

/// Both of a solid.
[[nodiscard]] std::vector<Warning> solid_warnings(const Solid& solid);

}  // namespace blum
