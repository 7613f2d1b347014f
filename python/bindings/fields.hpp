// Blum: fields of Python. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>
#include <vector>

#include "blum/field/field.hpp"

namespace blum::python {

namespace nb = nanobind;

/// @throws InvalidOption naming the argument `sign` or `site_ids` and what it may be.
[[nodiscard]] SignMode sign_mode(const std::string& name);
[[nodiscard]] SiteIds site_ids_of(const std::string& name);

/// The same and a band as options.
[[nodiscard]] FieldOptions field_options(const std::string& sign, std::optional<double> band,
                                         const std::string& site_ids);

/// [(phase, seconds), ...].
[[nodiscard]] nb::list phases_of(const std::vector<PhaseTime>& phases);

}  // namespace blum::python
