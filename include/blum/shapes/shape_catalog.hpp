// Blum: the shape generators by name. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/parameters.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

using ShapeParameters = ParameterValues;
using ShapeParameter = Parameter;

/// Shape that Blum generates.
struct ShapeInfo {
  std::string name;
  std::string description;  ///< one line
  std::vector<ShapeParameter> parameters;
  /// Makes the mesh. All parameters must be given and in range; make_shape() adds defaults and checks ranges.
  std::function<TriangleMesh(const ShapeParameters&)> make;
  /// Returns the Betti numbers of the solid (components, tunnels, voids), known from the construction. The numbers are
  /// unset if the mesh does not bound a solid: open surfaces, soups, segments, points.
  std::function<std::optional<std::array<std::int64_t, 3>>(const ShapeParameters&)> betti;
};

/// Returns all shapes, sorted by name.
[[nodiscard]] const std::vector<ShapeInfo>& shape_catalog();

/// Returns the shape with the given name.
/// @throws InvalidOption if no shape has the name; the message lists the known names.
[[nodiscard]] const ShapeInfo& find_shape(std::string_view name);

/// Returns values for all parameters of a shape: the given ones, and defaults for the others.
/// @throws InvalidOption if a parameter is unknown or out of range, or if it must be a whole number and is not. The
/// message lists the shape's parameters and ranges.
[[nodiscard]] ShapeParameters complete_parameters(const ShapeInfo& shape, const ShapeParameters& given);

/// Generates the shape with the given name; generators.hpp describes the shapes. Coordinates are the same on every
/// platform, except for the last bits of sines and cosines.
/// @throws InvalidOption as find_shape() and complete_parameters(), and for more than 50 million triangles. It is also
/// thrown for parameters that contradict each other: for example, a tube thicker than its ring, or holes that overlap.
[[nodiscard]] TriangleMesh make_shape(std::string_view name, const ShapeParameters& parameters = {});

}  // namespace blum
