// Blum: files of pairs in moving scenes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::cli {

/// Names of the kinds of pairs, in the order of their numbers.
inline constexpr std::array<std::string_view, 3> pair_kinds{"closest", "collision", "penetration"};
inline constexpr std::size_t most_stages = 8;
inline constexpr std::size_t most_pairs = 2'000'000;

/// What is close in the frames of a scene, and how long finding it took: columns, frame by frame.
struct FramePairs {
  std::vector<std::uint32_t> first;  ///< number of the first pair of each frame, and of all pairs
  std::vector<std::uint8_t> kinds;   ///< see pair_kinds
  std::vector<Vec3d> points;         ///< two of each pair
  std::vector<double> distances;     ///< as the file has them
  std::vector<float> times;          ///< from 0 to 1; NaN where the file has none
  std::vector<std::string> stages;   ///< in the order in which the file names them first
  std::vector<double> seconds;       ///< of every stage, frame after frame; NaN where the file has none
};

/// Reads the JSON that docs/guide/viewer.md describes.
/// @param frames  how many frames the scene has.
/// @throws FileError where it cannot be read; FormatError naming the member that is wrong.
[[nodiscard]] FramePairs read_frame_pairs(const std::filesystem::path& path, std::size_t frames);

}  // namespace blum::cli
