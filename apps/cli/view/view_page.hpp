// Blum: the page of the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "view/view_scene.hpp"

namespace blum::cli {

/// Returns the page that is built into the tool (apps/viewer/dist/viewer.html). It requests the scene from the server
/// that sent it.
[[nodiscard]] std::string_view viewer_page();

/// Returns the page with the scene's title, for example "part.stl and 2 more - Blum".
[[nodiscard]] std::string titled_page(const Scene& scene);

/// Writes the page with the scene embedded. @throws FileError.
void write_page(const std::filesystem::path& path, const Scene& scene);

}  // namespace blum::cli
