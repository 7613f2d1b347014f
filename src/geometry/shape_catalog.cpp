#include "blum/geometry/shape_catalog.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "blum/core/error.hpp"
#include "geometry/catalog_parts.hpp"

namespace blum {
namespace {

std::vector<ShapeInfo> make_catalog() {
  std::vector<ShapeInfo> catalog = detail::round_shapes();
  for (auto group : {detail::machined_shapes(), detail::loose_shapes()}) {
    catalog.insert(catalog.end(), group.begin(), group.end());
  }
  std::sort(catalog.begin(), catalog.end(), [](const ShapeInfo& a, const ShapeInfo& b) { return a.name < b.name; });
  return catalog;
}

std::string list_parameters(const ShapeInfo& shape) {
  std::ostringstream text;
  text << "; '" << shape.name << "' takes";
  const char* separator = " ";
  for (const ShapeParameter& p : shape.parameters) {
    text << separator << p.name << " (" << (p.integer ? "whole number, " : "") << p.minimum << " to " << p.maximum
         << ", default " << p.default_value << ")";
    separator = ", ";
  }
  return text.str();
}

}  // namespace

const std::vector<ShapeInfo>& shape_catalog() {
  static const std::vector<ShapeInfo> catalog = make_catalog();
  return catalog;
}

const ShapeInfo& find_shape(std::string_view name) {
  for (const ShapeInfo& shape : shape_catalog()) {
    if (shape.name == name) return shape;
  }
  std::string message = "there is no shape '" + std::string(name) + "'; known shapes:";
  const char* separator = " ";
  for (const ShapeInfo& shape : shape_catalog()) {
    message += separator + shape.name;
    separator = ", ";
  }
  throw InvalidOption(message);
}

ShapeParameters complete_parameters(const ShapeInfo& shape, const ShapeParameters& given) {
  ShapeParameters complete;
  for (const ShapeParameter& p : shape.parameters) complete[p.name] = p.default_value;
  for (const auto& [name, value] : given) {
    const auto found = std::find_if(shape.parameters.begin(), shape.parameters.end(),
                                    [&name = name](const ShapeParameter& p) { return p.name == name; });
    if (found == shape.parameters.end()) {
      throw InvalidOption("there is no parameter '" + name + "'" + list_parameters(shape));
    }
    if (!(value >= found->minimum && value <= found->maximum)) {
      std::ostringstream text;
      text << "parameter '" << name << "' is " << value << ", out of its range" << list_parameters(shape);
      throw InvalidOption(text.str());
    }
    if (found->integer && value != std::floor(value)) {
      throw InvalidOption("parameter '" + name + "' must be a whole number" + list_parameters(shape));
    }
    complete[name] = value;
  }
  return complete;
}

TriangleMesh make_shape(std::string_view name, const ShapeParameters& parameters) {
  const ShapeInfo& shape = find_shape(name);
  return shape.make(complete_parameters(shape, parameters));
}

}  // namespace blum
