// Blum: which solid a file of a medial axis belongs to. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/io/medial_io.hpp"
#include "solid_input.hpp"

namespace blum::cli {

/// What of a mesh or an image is the solid.
struct SolidChoice {
  Selections selections;  ///< of images; at most one label
  std::optional<double> weld;
  std::vector<std::string> warnings;
};

/// Writes into the metadata of an axis what of the input it is that of.
void record(const LabelSelection& selection, std::optional<double> weld, InputKind kind, MedialMetadata& metadata);

/// The solid of an axis: as the options say where they are given, else as its file says. Where the two contradict each
/// other, one warning says so.
[[nodiscard]] SolidChoice solid_of_axis(const SolidChoice& given, InputKind kind, const MedialMetadata& metadata,
                                        const std::filesystem::path& axis);

/// Which options may be missing where a certificate fails; empty where the axis's file tells of them, or none may be.
[[nodiscard]] std::string missing_options(const SolidChoice& given, InputKind kind, const MedialMetadata& metadata,
                                          bool topology_holds);

}  // namespace blum::cli
