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
  std::size_t axis = 2;    ///< the axis perpendicular to the layer
  std::int64_t index = 0;  ///< number of the layer
  std::size_t u_axis = 0;
  std::size_t v_axis = 1;
  std::int64_t width = 0;  ///< nodes
  std::int64_t height = 0;
  double u_step = 1;  ///< distance between nodes, mesh units
  double v_step = 1;
  std::vector<float> distance;  ///< u fastest, v rising
  std::vector<SiteId> site;     ///< empty if the field has none
  bool is_signed = false;
  double band = 0;     ///< 0: none
  double minimum = 0;  ///< of the distances within the band
  double maximum = 0;
  std::string place;  ///< "z = 0.25, layer 12 of 0 to 63"
};

/// Returns 1 if an axis of a grid points along the world axis of the same name, -1 if against it, else nothing.
[[nodiscard]] std::optional<double> along_world(const GridSpec& grid, std::size_t axis);

/// @param index  layer within the field's grid.
[[nodiscard]] Slice take_slice(const Field& field, std::size_t axis, std::int64_t index);

/// Returns the pixels per step of the finer axis. The longer side gets at least 800 pixels, and at most 4,096 if it has
/// more steps than that.
[[nodiscard]] double default_scale(const Slice& slice);

/// Draws distances as colours, with contour lines at round steps, a strong line at the surface, and a scale.
/// @throws InvalidOption if the picture would have more than 50 million pixels or a side above 65,000.
[[nodiscard]] Picture distance_picture(const Slice& slice, double scale, const Context& context);
/// Draws one colour for each Voronoi region, with borders. A signed field gets a strong line at the surface.
/// @throws InvalidOption as above.
[[nodiscard]] Picture sites_picture(const Slice& slice, double scale, const Context& context);

}  // namespace blum::cli
