// Blum: pictures of a slice through a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/io/picture.hpp"

namespace blum::cli {

/// One layer of a field: u to the right, v upwards.
struct Slice {
  std::size_t axis = 2;    ///< the axis that it is perpendicular to
  std::int64_t index = 0;  ///< of the layer
  std::size_t u_axis = 0;
  std::size_t v_axis = 1;
  std::int64_t width = 0;  ///< nodes
  std::int64_t height = 0;
  double u_step = 1;  ///< distance between nodes, mesh units
  double v_step = 1;
  std::vector<float> distance;  ///< u fastest, v rising
  std::vector<SiteId> site;     ///< empty where the field has none
  bool is_signed = false;
  double band = 0;     ///< 0: none
  double minimum = 0;  ///< of the distances within the band
  double maximum = 0;
  std::string place;  ///< "z = 0.25, layer 12 of 0 to 63"
};

/// 1 or -1 where an axis of a grid runs along the world's axis of the same name, or against it.
[[nodiscard]] std::optional<double> along_world(const GridSpec& grid, std::size_t axis);

/// @param index  within the field's grid.
[[nodiscard]] Slice take_slice(const Field& field, std::size_t axis, std::int64_t index);

/// Pixels for each step of the finer axis such that the longer side has at least 800, and at most 4,096 where the slice
/// has that many nodes.
[[nodiscard]] double default_scale(const Slice& slice);

/// Distances as colours with contour lines at round steps, a strong line at the surface, and a scale.
/// @throws InvalidOption when the picture would have more than 50 million pixels.
[[nodiscard]] Picture distance_picture(const Slice& slice, double scale, const Context& context);
/// One colour for each Voronoi region, with borders, and a strong line at the surface where the field is signed.
/// @throws InvalidOption as above.
[[nodiscard]] Picture sites_picture(const Slice& slice, double scale, const Context& context);

}  // namespace blum::cli
