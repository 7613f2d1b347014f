// Blum: from the options of fields to requests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/field_request.hpp"
#include "field/sign/policy.hpp"

namespace blum {

/// @throws InvalidOption.
void check_options(const FieldOptions& options);

/// @throws InvalidOption where objects are of no use.
void check_objects(const FieldOptions& options);

/// @param has_free_parts  whether the mesh has segments or points, which lie on no triangle.
/// @throws InvalidOption where triangle ids are asked for.
void check_site_ids(const FieldOptions& options, bool has_free_parts);

/// What to compute for a mesh whose signs are planned; without memory yet.
[[nodiscard]] FieldRequest make_field_request(const GridSpec& grid, const FieldOptions& options,
                                              const sign::Plan& plan);

}  // namespace blum
