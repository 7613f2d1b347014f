// Blum: checks of what a field is asked for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/field/field.hpp"

namespace blum {

/// @throws InvalidOption.
void check_options(const FieldOptions& options);

}  // namespace blum
