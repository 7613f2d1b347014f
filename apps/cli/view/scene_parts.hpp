// Blum: parts of scenes of the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/vec3.hpp"
#include "view/scene_blob.hpp"

namespace blum::cli {

/// Largest number of triangles that the viewer shows.
inline constexpr std::size_t most_triangles_shown = 20'000'000;

/// Adds places in single precision, relative to `origin`, the centre of their bounds.
[[nodiscard]] Json add_places(SceneBlob& blob, std::span<const Vec3d> places, const Vec3d& origin);

/// Adds the corners of triangles or the ends of segments, one after the other.
template <std::size_t corners>
[[nodiscard]] Json add_cells(SceneBlob& blob, const std::vector<std::array<std::uint32_t, corners>>& cells) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(corners * cells.size());
  for (const auto& cell : cells) numbers.insert(numbers.end(), cell.begin(), cell.end());
  return blob.add(numbers);
}

/// Returns a line of the page's text.
[[nodiscard]] Json fact(const char* label, const std::string& text);

/// @throws FileError if an item's "bounds" are smaller or larger than browsers can draw.
/// @param what  start of the message: "'part.ply'".
void check_extent(const Json& item, std::string_view what);

/// Returns the header of a scene: items, colours, and the numbers of roles.
[[nodiscard]] Json scene_header(SceneBlob& blob, Json items);

}  // namespace blum::cli
