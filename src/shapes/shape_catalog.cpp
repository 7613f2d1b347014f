#include "blum/shapes/shape_catalog.hpp"

#include <algorithm>
#include <string>

#include "blum/core/error.hpp"
#include "shapes/catalog_parts.hpp"

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
  return complete_parameters(shape.name, shape.parameters, given);
}

TriangleMesh make_shape(std::string_view name, const ShapeParameters& parameters) {
  const ShapeInfo& shape = find_shape(name);
  return shape.make(complete_parameters(shape, parameters));
}

}  // namespace blum
