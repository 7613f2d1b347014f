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

/// One layer of a field. Its axes are u (to the right) and v (upwards).
struct Slice {
  std::size_t axis = 2;    ///< the axis perpendicular to the layer
  std::int64_t index = 0;  ///< index of the layer
  std::size_t u_axis = 0;
  std::size_t v_axis = 1;
  std::int64_t width = 0;  ///< number of nodes along u
  std::int64_t height = 0;
  double u_step = 1;  ///< distance between nodes, mesh units
  double v_step = 1;
  std::vector<float> distance;  ///< one per node: u fastest, v ascending
  std::vector<SiteId> site;     ///< one per node; empty if the field has no sites
  bool is_signed = false;
  double band = 0;     ///< half-width of the band; 0 if there is none
  double minimum = 0;  ///< smallest distance within the band
  double maximum = 0;
  std::string place;  ///< position as text, for example "z = 0.25, layer 12 of 0 to 63"
};

/// Compares an axis of a grid with the world axis of the same name. Returns 1 for the same direction, -1 for the
/// opposite one, else nothing.
[[nodiscard]] std::optional<double> along_world(const GridSpec& grid, std::size_t axis);

/// @param index  index of a layer of the field's grid.
[[nodiscard]] Slice take_slice(const Field& field, std::size_t axis, std::int64_t index);

/// Returns the number of pixels per step of the finer axis. With it, the longer side has at least 800 pixels. It has at
/// most 4,096, unless it has more steps than that.
[[nodiscard]] double default_scale(const Slice& slice);

/// Returns a picture of the distances: colours, contour lines at round values, a strong line at the surface, and a
/// colour scale.
/// @throws InvalidOption if the picture would have more than 50 million pixels or a side of more than 65,000 pixels.
[[nodiscard]] Picture distance_picture(const Slice& slice, double scale, const Context& context);
/// Returns a picture with one colour for each Voronoi region, and borders between regions. If the field is signed,
/// there is a strong line at the surface.
/// @throws InvalidOption as for distance_picture().
[[nodiscard]] Picture sites_picture(const Slice& slice, double scale, const Context& context);

}  // namespace blum::cli
