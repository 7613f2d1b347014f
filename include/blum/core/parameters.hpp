// Blum: named numeric parameters of generators. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace blum {

/// Values of parameters by name.
using ParameterValues = std::map<std::string, double>;

/// Numeric parameter of a generator.
struct Parameter {
  std::string name;         ///< name on the command line, without leading dashes
  std::string description;  ///< one line, including the unit
  double default_value = 0;
  double minimum = 0;  ///< inclusive
  double maximum = 0;  ///< inclusive
  bool integer = false;
};

/// Returns the values of all parameters. Parameters that are not in `given` have their default values.
/// @param owner  name of the generator, for messages.
/// @throws InvalidOption if a parameter is unknown or out of range, or if an integer parameter is not a whole number.
/// The message lists all parameters and ranges.
[[nodiscard]] ParameterValues complete_parameters(std::string_view owner, std::span<const Parameter> parameters,
                                                  const ParameterValues& given);

}  // namespace blum
