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

/// Calls blum::solid_of_axis(). In its messages, uses the names of the command line's options. @param axis file of the
/// axis.
[[nodiscard]] AxisSolid solid_of_axis(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                                      const std::filesystem::path& axis);

/// Returns the label of a selection, if it has one.
[[nodiscard]] std::vector<std::int64_t> labels_of(const SolidSelection& selection);

/// Records the input's selection of voxels or its weld tolerance in the metadata of an axis.
void record(const LabelSelection& selection, std::optional<double> weld, InputKind kind, MedialMetadata& metadata);

/// For a failed certificate, returns advice on options that may be missing. Returns an empty text if the axis's file
/// records its solid, or if an option is given.
[[nodiscard]] std::string missing_options(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                                          bool topology_holds);

}  // namespace blum::cli
