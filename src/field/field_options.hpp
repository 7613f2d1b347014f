// Blum: checks of what a field is asked for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/field/field.hpp"

namespace blum {

/// @throws InvalidOption.
void check_options(const FieldOptions& options);

/// @param has_free_parts  whether the mesh has segments or points, which lie on no triangle.
/// @throws InvalidOption where triangle ids are asked for.
void check_site_ids(const FieldOptions& options, bool has_free_parts);

}  // namespace blum
