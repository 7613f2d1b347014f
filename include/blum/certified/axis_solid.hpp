// Blum: the solid that a medial axis belongs to. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/certified/medial_metadata.hpp"
#include "blum/core/warning.hpp"

namespace blum {

/// Part of an image or a mesh that is the solid, from options or from a file.
struct SolidSelection {
  std::optional<std::int64_t> label = {};  ///< Images: voxels of this value. At most one of label and threshold is set.
  std::optional<double> threshold = {};    ///< Images: voxels of this value or more.
  std::optional<double> weld = {};         ///< Meshes: MeshReadOptions::weld, mesh units.
};

/// Form of options in messages of a front end: `--label 2` or `label=2`.
enum class OptionStyle : std::uint8_t { command_line, python };

struct AxisSolid {
  SolidSelection selection;
  std::vector<Warning> warnings;  ///< WarningCode::other_solid if the axis names another solid.
};

/// Returns the solid of an axis. Given options take precedence over those that the axis records. A given label or
/// threshold replaces both of the axis's. For images, weld is ignored; for meshes, label and threshold are.
/// @param axis  name of the axis in the warning.
[[nodiscard]] AxisSolid solid_of_axis(const SolidSelection& given, bool is_image, const MedialMetadata& metadata,
                                      const std::string& axis, OptionStyle style);

}  // namespace blum
