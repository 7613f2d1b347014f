// Blum: files of medial axes (VTP, PLY, OBJ, MA, NPZ). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/medial_axis/medial_complex.hpp"

namespace blum {

/// What a file of a medial axis says besides the complex; what it does not know stays unset.
struct MedialMetadata {
  std::string source = {};   ///< where the solid came from, for example a file name
  std::string version = {};  ///< Blum's
  SiteIds site_ids = SiteIds::features;
  std::optional<double> theta = {};    ///< degrees
  std::optional<double> lambda = {};   ///< mesh units
  std::optional<double> spacing = {};  ///< smallest side of a voxel, mesh units
  /// What the topology is against: "polyhedron", "winding" or "voxels" (SolidRule).
  std::string solid_rule = {};
  std::optional<GridSpec> grid = {};  ///< voxel centres, where the solid is only known as voxels (SolidRule::winding)
};

/// A medial axis as a file holds it.
struct MedialFile {
  MedialComplex complex;
  MedialMetadata metadata;
  bool has_radii = false;
  bool has_footprints = false;  ///< and their sites
  bool has_angles = false;      ///< of vertices, edges and triangles
  bool has_labels = false;      ///< sheets and roles
};

enum class MedialFormat : std::uint8_t { vtp, ply, obj, ma, npz };

/// Writes a medial axis; the format goes by the extension.
///
///   .vtp  VTK poly data, raw appended: isolated vertices as verts; curves, rims and seams as lines; triangles as
///   polys.
///         Point data `radius`, `separation_angle`, `role`, `footprint_0`, `footprint_1`, `site_0`, `site_1`; cell data
///         `separation_angle`, `role`, `sheet` (-1 for verts and lines); metadata (JSON) as field data.
///   .ply  binary, vertices with all attributes, edges (curves, rims, seams) and triangles with theirs.
///   .obj  v; f; l for curves; p for vertices of nothing else. No attributes, no vertex that nothing uses.
///   .ma   text: counts; v x y z radius; e for all edges, also those of triangles; f. As medial meshes are exchanged.
///   .npz  arrays of all that the complex holds, for NumPy.
///
/// Coordinates keep double precision. A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension; FileError; Cancelled.
void write_medial(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata = {},
                  const Context& context = {});

/// Reads a file that write_medial wrote, or one of the same form by another program.
/// @throws FileError; FormatError naming the file and the reason; InvalidOption for another extension.
[[nodiscard]] MedialFile read_medial(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] MedialFile read_medial(std::span<const std::byte> bytes, MedialFormat format,
                                     const std::string& name = "medial axis");

}  // namespace blum
