// Blum: the page of the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "view/view_scene.hpp"

namespace blum::cli {

/// The page as it is built into the tool: apps/viewer/dist/viewer.html. It asks its server for the scene.
[[nodiscard]] std::string_view viewer_page();

/// The same, named by what the scene shows: "part.stl and 2 more - Blum".
[[nodiscard]] std::string titled_page(const Scene& scene);

/// Writes the page with the scene in it. @throws FileError.
void write_page(const std::filesystem::path& path, const Scene& scene);

}  // namespace blum::cli
