// Blum: what scenes of the viewer are made of. SPDX-License-Identifier: Apache-2.0
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

/// What a browser can be asked to draw.
inline constexpr std::size_t most_triangles_shown = 20'000'000;

/// Places as single precision keeps them best: as seen from `origin`, the middle of the box around them.
[[nodiscard]] Json add_places(SceneBlob& blob, std::span<const Vec3d> places, const Vec3d& origin);

/// Corners of triangles or ends of segments, one after the other.
template <std::size_t corners>
[[nodiscard]] Json add_cells(SceneBlob& blob, const std::vector<std::array<std::uint32_t, corners>>& cells) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(corners * cells.size());
  for (const auto& cell : cells) numbers.insert(numbers.end(), cell.begin(), cell.end());
  return blob.add(numbers);
}

/// A line of the page's text.
[[nodiscard]] Json fact(const char* label, const std::string& text);

/// @throws FileError where an item's "bounds" are smaller or larger than browsers can draw.
/// @param what  the beginning of the message: "'part.ply'".
void check_extent(const Json& item, std::string_view what);

/// The header of a scene: the items, and what the page has from here only.
[[nodiscard]] Json scene_header(SceneBlob& blob, Json items);

}  // namespace blum::cli
