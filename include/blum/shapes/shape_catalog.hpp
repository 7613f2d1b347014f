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

/// A shape that Blum generates.
struct ShapeInfo {
  std::string name;
  std::string description;  ///< one line
  std::vector<ShapeParameter> parameters;
  /// Makes the mesh. Every parameter must be there and in its range; make_shape() sees to both.
  std::function<TriangleMesh(const ShapeParameters&)> make;
  /// Betti numbers of the solid (components, tunnels, voids), known from the construction; unset where the mesh does
  /// not bound a solid: open surfaces, soups, segments, points.
  std::function<std::optional<std::array<std::int64_t, 3>>(const ShapeParameters&)> betti;
};

/// All shapes, sorted by name.
[[nodiscard]] const std::vector<ShapeInfo>& shape_catalog();

/// The shape of that name. @throws InvalidOption that lists the known names.
[[nodiscard]] const ShapeInfo& find_shape(std::string_view name);

/// The parameters of a shape, with defaults for those not given.
/// @throws InvalidOption naming the shape's parameters and ranges when one is unknown, out of range or not a whole
/// number where it must be.
[[nodiscard]] ShapeParameters complete_parameters(const ShapeInfo& shape, const ShapeParameters& given);

/// Generates a shape by name; see generators.hpp for each. The same numbers on every platform, up to the last bits of
/// its sine and cosine.
/// @throws InvalidOption as above, and for parameters that contradict each other (holes that overlap, a tube thicker
/// than its ring, more than 50 million triangles).
[[nodiscard]] TriangleMesh make_shape(std::string_view name, const ShapeParameters& parameters = {});

}  // namespace blum
