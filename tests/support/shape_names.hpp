// Blum: names of generated shapes, as names of tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <string>
#include <vector>

#include "blum/shapes/shape_catalog.hpp"

namespace blum::test {

/// Replaces all characters that names of tests may not contain.
inline std::string test_name(std::string name) {
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

/// The names of all shapes.
inline std::vector<std::string> catalog_names() {
  std::vector<std::string> names;
  for (const ShapeInfo& shape : shape_catalog()) names.push_back(shape.name);
  return names;
}

}  // namespace blum::test
