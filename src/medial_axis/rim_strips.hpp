// Blum: triangles between a rim of a medial axis and a line in front of it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/function_ref.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// A rim edge and the points in front of it.
struct StripOutline {
  std::array<Vec3d, 2> rim;     ///< its ends, in the order of its triangle
  std::span<const Vec3d> line;  ///< from the first end's side to the other's, at least one point
  Vec3d normal;                 ///< of its triangle, of unit length
};

/// Triangles over the points rim[0], rim[1], line[0], line[1], ... by number. One of them has both ends of the rim, and
/// all face as the rim's triangle does. Of the ways to do it, that one whose worst triangle is the best; nullopt where
/// none keeps all within 80 degrees of the normal.
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> fill_strip(const StripOutline& outline);

/// Whether the middles of triangles of fill_strip() and of their sides are inside, but for those of the line, which
/// is the border.
[[nodiscard]] bool is_strip_inside(const StripOutline& outline, std::span<const std::array<std::uint32_t, 3>> triangles,
                                   FunctionRef<bool(const Vec3d&)> is_inside);

}  // namespace blum
