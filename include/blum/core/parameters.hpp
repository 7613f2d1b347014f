// Blum: named numbers that generators take. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace blum {

/// Values of parameters by name.
using ParameterValues = std::map<std::string, double>;

/// A number that something can be asked for with.
struct Parameter {
  std::string name;         ///< as on the command line, without dashes in front
  std::string description;  ///< one line, with the unit
  double default_value = 0;
  double minimum = 0;  ///< inclusive
  double maximum = 0;  ///< inclusive
  bool integer = false;
};

/// The values of all parameters, with defaults for those not given.
/// @param owner  what takes them, for messages.
/// @throws InvalidOption naming all parameters and ranges when one is unknown, out of range, or not a whole number
/// where it must be.
[[nodiscard]] ParameterValues complete_parameters(std::string_view owner, std::span<const Parameter> parameters,
                                                  const ParameterValues& given);

}  // namespace blum
