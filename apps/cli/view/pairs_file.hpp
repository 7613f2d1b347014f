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

/// Close pairs in the frames of a scene, and durations of the stages that found them. They are stored as columns, one
/// frame after the other.
struct FramePairs {
  std::vector<std::uint32_t> first;  ///< for each frame: index of its first pair; the last entry is the number of pairs
  std::vector<std::uint8_t> kinds;   ///< one per pair: index in pair_kinds
  std::vector<Vec3d> points;         ///< two per pair
  std::vector<double> distances;     ///< one per pair, as in the file
  std::vector<float> times;          ///< one per pair, 0 to 1; NaN if the file has none
  std::vector<std::string> stages;   ///< names of stages, in the order in which the file first uses them
  std::vector<double> seconds;       ///< frame by frame, one per stage; NaN if the file has none
};

/// Reads a JSON file of pairs. docs/guide/viewer.md describes the format.
/// @param frames  number of frames of the scene.
/// @throws FileError if the file cannot be read; FormatError if a member is wrong. The message contains the member's
/// path.
[[nodiscard]] FramePairs read_frame_pairs(const std::filesystem::path& path, std::size_t frames);

}  // namespace blum::cli
