// Blum: the solid of a file of a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/certified/axis_solid.hpp"
#include "blum/io/medial_io.hpp"
#include "common/solid_input.hpp"

namespace blum::cli {

/// Reads the values of --label, --threshold and --weld for one axis. @throws UsageError, InvalidOption.
[[nodiscard]] SolidSelection parse_solid(const std::vector<std::string>& labels,
                                         const std::optional<std::string>& threshold,
                                         const std::optional<std::string>& weld);

/// Calls blum::solid_of_axis() with option names of the command line in messages. @param axis  its file.
[[nodiscard]] AxisSolid solid_of_axis(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                                      const std::filesystem::path& axis);

/// Records the selection or the weld tolerance of the input in the metadata of an axis.
void record(const LabelSelection& selection, std::optional<double> weld, InputKind kind, MedialMetadata& metadata);

/// Returns advice on options that may be missing if a certificate fails. Empty if the axis's file records its solid, or
/// an option is given.
[[nodiscard]] std::string missing_options(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                                          bool topology_holds);

}  // namespace blum::cli
