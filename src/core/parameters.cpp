#include "blum/core/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "blum/core/error.hpp"

namespace blum {
namespace {

std::string list_parameters(std::string_view owner, std::span<const Parameter> parameters) {
  std::ostringstream text;
  text << "; '" << owner << "' takes";
  const char* separator = " ";
  for (const Parameter& p : parameters) {
    text << separator << p.name << " (" << (p.integer ? "whole number, " : "") << p.minimum << " to " << p.maximum
         << ", default " << p.default_value << ")";
    separator = ", ";
  }
  return text.str();
}

}  // namespace

ParameterValues complete_parameters(std::string_view owner, std::span<const Parameter> parameters,
                                    const ParameterValues& given) {
  ParameterValues complete;
  for (const Parameter& p : parameters) complete[p.name] = p.default_value;
  for (const auto& [name, value] : given) {
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&name = name](const Parameter& p) { return p.name == name; });
    std::ostringstream problem;
    if (found == parameters.end()) {
      problem << "there is no parameter '" << name << "'";
    } else if (!(value >= found->minimum && value <= found->maximum)) {
      problem << "parameter '" << name << "' is " << value << ", out of its range";
    } else if (found->integer && value != std::floor(value)) {
      problem << "parameter '" << name << "' is " << value << ", but must be a whole number";
    }
    if (problem.tellp() > 0) throw InvalidOption(problem.str() + list_parameters(owner, parameters));
    complete[name] = value;
  }
  return complete;
}

}  // namespace blum
