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
  /// Makes the mesh. All parameters must be given and in range; make_shape() takes care of both.
  std::function<TriangleMesh(const ShapeParameters&)> make;
  /// Returns the Betti numbers of the solid (components, tunnels, voids), known from the construction. They are unset
  /// if the mesh does not bound a solid: open surfaces, soups, segments, points.
  std::function<std::optional<std::array<std::int64_t, 3>>(const ShapeParameters&)> betti;
};

/// Returns all shapes, sorted by name.
[[nodiscard]] const std::vector<ShapeInfo>& shape_catalog();

/// Returns the shape of that name. @throws InvalidOption that lists the known names.
[[nodiscard]] const ShapeInfo& find_shape(std::string_view name);

/// Returns the parameters of a shape, with defaults for those not given.
/// @throws InvalidOption if a parameter is unknown, out of range or not a whole number although it must be. The message
/// lists the shape's parameters and ranges.
[[nodiscard]] ShapeParameters complete_parameters(const ShapeInfo& shape, const ShapeParameters& given);

/// Generates a shape by name; see generators.hpp for each. Numbers are the same on every platform, up to the last bits
/// of its sine and cosine.
/// @throws InvalidOption as above, and for parameters that contradict each other. Examples are holes that overlap, a
/// tube thicker than its ring, or more than 50 million triangles.
[[nodiscard]] TriangleMesh make_shape(std::string_view name, const ShapeParameters& parameters = {});

}  // namespace blum
