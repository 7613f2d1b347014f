// Blum: checks the options of fields and turns them into requests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/field_request.hpp"
#include "field/sign/policy.hpp"

namespace blum {

/// Checks the options of a field.
/// @throws InvalidOption if a value is out of range.
void check_options(const FieldOptions& options);

/// Checks that objects may be given for a field with these options.
/// @throws InvalidOption unless the order is 2 and the rule for the second site is "other object".
void check_objects(const FieldOptions& options);

/// Checks the kind of site ids that the options request.
/// @param has_free_parts  true if the mesh has segments or points, which lie on no triangle.
/// @throws InvalidOption if triangle ids are requested and has_free_parts is true.
void check_site_ids(const FieldOptions& options, bool has_free_parts);

/// Returns the request for a mesh whose signs are planned. The request's result memory is not set yet.
[[nodiscard]] FieldRequest make_field_request(const GridSpec& grid, const FieldOptions& options,
                                              const sign::Plan& plan);

}  // namespace blum
