// Blum: what the mesh writers share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// @throws FileError saying that files of this format hold no such thing.
[[noreturn]] void cannot_hold(const std::filesystem::path& path, std::string_view format, std::string_view what);

/// Refuses points, unless the mesh is a cloud of all its vertices, which a file without faces stands for.
void refuse_points(const std::filesystem::path& path, std::string_view format, const MeshView& mesh);

}  // namespace blum
