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

/// Largest number of triangles that the viewer can show.
inline constexpr std::size_t most_triangles_shown = 20'000'000;

/// Adds positions in single precision. They are relative to `origin`, the centre of their bounds.
[[nodiscard]] Json add_places(SceneBlob& blob, std::span<const Vec3d> places, const Vec3d& origin);

/// Adds the vertex indices of triangles or segments, one element after the other.
template <std::size_t corners>
[[nodiscard]] Json add_cells(SceneBlob& blob, const std::vector<std::array<std::uint32_t, corners>>& cells) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(corners * cells.size());
  for (const auto& cell : cells) numbers.insert(numbers.end(), cell.begin(), cell.end());
  return blob.add(numbers);
}

/// Returns a line of text for the page.
[[nodiscard]] Json fact(const char* label, const std::string& text);

/// @throws FileError if the extent of an item's "bounds" is too small or too large for browsers to draw.
/// @param what  start of the message, for example "'part.ply'".
void check_extent(const Json& item, std::string_view what);

/// Returns the header of a scene: items, colours, and the numbers that stand for roles.
[[nodiscard]] Json scene_header(SceneBlob& blob, Json items);

}  // namespace blum::cli
