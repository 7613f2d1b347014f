// Blum: which solid a medial axis belongs to. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/certified/medial_metadata.hpp"
#include "blum/core/warning.hpp"

namespace blum {

/// What of an image or a mesh is the solid, as an option or a file says it.
struct SolidSelection {
  std::optional<std::int64_t> label = {};  ///< images: the voxels of this value; at most one of label and threshold
  std::optional<double> threshold = {};    ///< images: those of this value or more
  std::optional<double> weld = {};         ///< meshes: MeshReadOptions::weld, mesh units
};

/// How a front end writes its options in messages: `--label 2` or `label=2`.
enum class OptionStyle : std::uint8_t { command_line, python };

struct AxisSolid {
  SolidSelection selection;
  std::vector<Warning> warnings;  ///< WarningCode::other_solid where the axis says otherwise
};

/// The solid of an axis: as options say where they are given, else as the axis says. A label or threshold replaces both
/// of the axis's. Of images, weld is not looked at; of meshes, label and threshold.
/// @param axis  what the warning calls it.
[[nodiscard]] AxisSolid solid_of_axis(const SolidSelection& given, bool is_image, const MedialMetadata& metadata,
                                      const std::string& axis, OptionStyle style);

}  // namespace blum
