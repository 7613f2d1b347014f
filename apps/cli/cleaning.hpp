// Blum: cleaning of meshes that were read. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/core/context.hpp"
#include "blum/solid/clean_mesh.hpp"
#include "files.hpp"
#include "summary.hpp"

namespace blum::cli {

/// @param path  for messages.
/// @throws as clean_mesh().
[[nodiscard]] CleanedMesh clean_input(const std::filesystem::path& path, const MeshView& mesh, double tolerance,
                                      const Context& context);

/// Adds what was done to a table.
void add_cleaning(const CleanReport& done, double tolerance, TextTable& table);

/// The same as JSON.
[[nodiscard]] Json cleaning_json(const CleanReport& done, double tolerance);

}  // namespace blum::cli
