// Blum: which solid a file of a medial axis belongs to. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/certified/axis_solid.hpp"
#include "blum/io/medial_io.hpp"
#include "common/solid_input.hpp"

namespace blum::cli {

/// The values of --label, --threshold and --weld, for one axis. @throws UsageError, InvalidOption.
[[nodiscard]] SolidSelection parse_solid(const std::vector<std::string>& labels,
                                         const std::optional<std::string>& threshold,
                                         const std::optional<std::string>& weld);

/// blum::solid_of_axis() in the words of the command line. @param axis  its file.
[[nodiscard]] AxisSolid solid_of_axis(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                                      const std::filesystem::path& axis);

/// Writes into the metadata of an axis what of the input it is that of.
void record(const LabelSelection& selection, std::optional<double> weld, InputKind kind, MedialMetadata& metadata);

/// Which options may be missing where a certificate fails; empty where the axis's file tells of them, or none may be.
[[nodiscard]] std::string missing_options(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                                          bool topology_holds);

}  // namespace blum::cli
