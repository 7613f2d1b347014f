// Blum: files of paths of rigid bodies. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/io/formats.hpp"
#include "blum/planning/certified_path.hpp"

namespace blum {

/// Mesh file that a path file names. Size and checksum show if another file has replaced it.
struct PathMesh {
  std::string file;         ///< path of the mesh file, relative to the folder of the path file if possible
  std::uint64_t bytes = 0;  ///< size of the mesh file
  std::string crc32;        ///< CRC-32 of its bytes, eight hexadecimal digits

  friend bool operator==(const PathMesh&, const PathMesh&) = default;
};

/// Content of a path file.
struct PathFile {
  std::vector<PathMesh> bodies;  ///< The bodies that move. Empty in a file of another program.
  std::vector<PathMesh> obstacles;
  std::vector<Vec3d> centres;                   ///< For each body: its centre, in its coordinates. Empty if not stated.
  std::vector<std::vector<PoseNumbers>> poses;  ///< For each waypoint: the pose of each body.
  std::optional<double> clearance = {};         ///< Stated clearance of the whole path, mesh units.
  std::vector<PathInterval> intervals = {};     ///< The stated proof. Empty in a file of another program.

  /// Returns the path.
  /// @param default_centres  centres of the bodies if the file states none. @throws InvalidOption for wrong poses.
  [[nodiscard]] MotionPath path(const std::vector<Vec3d>& default_centres) const;
};

/// Returns size and checksum of a mesh file. @throws FileError.
/// @param folder  of the path file: PathMesh::file is relative to it.
[[nodiscard]] PathMesh describe_path_mesh(const std::filesystem::path& mesh, const std::filesystem::path& folder);

/// Writes a path file as JSON. `docs/guide/files.md` describes its members.
/// A file appears under its name only when it is complete.
/// @throws InvalidOption unless the extension is `.json`; FileError.
void write_path(const std::filesystem::path& path, const PathFile& file, const Context& context = {});

/// Reads a path file. A `.json` file is as write_path() writes it. A `.csv` file has a row x, y, z, qw, qx, qy, qz for
/// each waypoint of one body. A first row without numbers is ignored.
/// @throws FormatError with the place of the error; InvalidOption for another extension; FileError.
[[nodiscard]] PathFile read_path(const std::filesystem::path& path);
/// Reads the bytes of a path file. @throws FormatError.
[[nodiscard]] PathFile read_path(std::span<const std::byte> bytes, PathFormat format);

}  // namespace blum
