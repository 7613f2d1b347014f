// Blum: the solid that a medial axis belongs to. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/certified/medial_metadata.hpp"
#include "blum/core/warning.hpp"

namespace blum {

/// Options that select the solid in an image or a mesh. A selection comes from the user or from the file of an axis.
struct SolidSelection {
  /// Images: voxels of this value form the solid. At most one of `label` and `threshold` is set.
  std::optional<std::int64_t> label = {};
  std::optional<double> threshold = {};  ///< Images: voxels of this value or more form the solid.
  std::optional<double> weld = {};       ///< Meshes: MeshReadOptions::weld, mesh units.
};

/// Form of options in messages of a front end: `--label 2` or `label=2`.
enum class OptionStyle : std::uint8_t { command_line, python };

struct AxisSolid {
  SolidSelection selection;
  std::vector<Warning> warnings;  ///< WarningCode::other_solid if the axis records another selection.
};

/// Returns the selection of the solid of an axis. Given options take precedence over the options that the axis records.
/// A given label or threshold replaces both the label and the threshold that the axis records. For images, `weld` is
/// ignored. For meshes, `label` and `threshold` are ignored.
/// @param axis  name of the axis in the warning.
[[nodiscard]] AxisSolid solid_of_axis(const SolidSelection& given, bool is_image, const MedialMetadata& metadata,
                                      const std::string& axis, OptionStyle style);

}  // namespace blum
