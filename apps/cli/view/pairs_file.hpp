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

/// Names of the kinds of pairs, indexed by their numbers.
inline constexpr std::array<std::string_view, 3> pair_kinds{"closest", "collision", "penetration"};
inline constexpr std::size_t most_stages = 8;
inline constexpr std::size_t most_pairs = 2'000'000;

/// Close pairs in the frames of a scene, and durations of the stages that found them: columns, frame by frame.
struct FramePairs {
  std::vector<std::uint32_t> first;  ///< number of the first pair of each frame, then the number of pairs
  std::vector<std::uint8_t> kinds;   ///< see pair_kinds
  std::vector<Vec3d> points;         ///< two for each pair
  std::vector<double> distances;     ///< as in the file
  std::vector<float> times;          ///< 0 to 1; NaN if the file has none
  std::vector<std::string> stages;   ///< in the order of their first occurrence in the file
  std::vector<double> seconds;       ///< for every stage, frame by frame; NaN if the file has none
};

/// Reads JSON of pairs, as docs/guide/viewer.md describes it.
/// @param frames  number of frames of the scene.
/// @throws FileError if the file cannot be read; FormatError that names the wrong member.
[[nodiscard]] FramePairs read_frame_pairs(const std::filesystem::path& path, std::size_t frames);

}  // namespace blum::cli
