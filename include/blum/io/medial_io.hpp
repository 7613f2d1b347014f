// Blum: files of medial axes (VTP, PLY, OBJ, MA, NPZ). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/certified/medial_metadata.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/io/formats.hpp"

namespace blum {

struct ComplexFile;

/// Content of a file of a medial axis.
struct MedialFile {
  Complex complex;  ///< with the columns of MedialView that the file holds; CompleteAxis adds the missing columns
  MedialMetadata metadata;
  std::optional<Complex> nested = {};  ///< Axes of all angles, if the file holds them (.npz).
  double least_theta = 0;              ///< Least theta of `nested`, degrees.
  bool has_radii = false;
  bool has_footprints = false;
  bool has_sites = false;
  bool has_angles = false;  ///< true if the file holds separation angles of vertices, edges and triangles
  bool has_labels = false;  ///< true if the file holds sheets and roles
};

/// Returns the claims that a file makes about its axis.
[[nodiscard]] MedialClaims claims_of(const MedialFile& file);

/// Writes a medial axis as a complex (see write_complex), or as .ma. The extension selects the format. Columns of
/// MedialView that the complex lacks are not written. In this case, the file does not contain Blum's version.
///
/// Columns of vertices are `radius`, `footprint_0`, `footprint_1` (3 components) and `separation_angle` (float64),
/// `site_0`, `site_1` and `role` (int32). Columns of edges are `separation_angle` (float32) and `role` (int32). Columns
/// of triangles are `separation_angle` (float32) and `sheet` (int32). Roles are stored as the integer values of
/// MedialRole. A site of -1 means no site.
///
///   `.vtp`, `.ply`, `.npz`  Everything, with the metadata.
///   `.obj`                  Positions, triangles, and edges of no triangle.
///   `.ma`                   Text: counts, then lines `v x y z radius`, `e` for each edge (also for sides of triangles,
///                           each once) and `f`. The .ma format is that of Q-MAT for medial meshes. It has no metadata.
///
/// Coordinates keep double precision. A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension, a column of MedialView with a wrong type, or a .ma file without radii.
/// @throws InvalidOption for metadata that are not finite or out of range.
/// @throws InvalidGrid if the grid in the metadata is not valid.
/// @throws InvalidMesh if the complex has an index of a missing vertex, or an edge or triangle with the same vertex
/// twice. InvalidMesh is also thrown if the complex has a number that is not finite, a negative radius, or a sheet
/// index out of range.
/// @throws FileError, Cancelled.
void write_medial(const std::filesystem::path& path, const Complex& complex, const MedialMetadata& metadata = {},
                  const Context& context = {});

/// Writes a medial axis with the axes of all angles, MedialAxis::nested(), for viewers. Only .npz files can hold the
/// axes of all angles. The file stores these axes as the further complex `nested`, with more columns (float32). For a
/// vertex or triangle, `until` is the theta at which the cell vanishes (inf: never). For an edge, `from` and `until`
/// are the values of theta between which the edge has its role. `nested_theta` in the metadata is the least theta.
/// @throws InvalidOption for other formats.
/// @param least_theta  MedialAxis::least_theta(), degrees.
void write_medial(const std::filesystem::path& path, const Complex& complex, const Complex& nested, double least_theta,
                  const MedialMetadata& metadata = {}, const Context& context = {});

/// Returns the extensions of files that read_medial() reads and that can hold radii.
[[nodiscard]] std::vector<std::string> extensions_with_radii();

/// Reads a file written by write_medial(), or a file of the same form written by another program (see read_complex()).
/// Any column of MedialView may be missing. Other columns in the file are kept, and follow the columns of MedialView.
/// If write_medial() wrote a .vtp, .ply or .npz file, the result equals the written axis exactly. If a file has no
/// roles of edges, edges that are sides of triangles are left out, because the triangles imply them. In this case, all
/// other edges are curves.
/// @throws FileError.
/// @throws FormatError with the file and the reason.
/// @throws InvalidOption for another extension.
[[nodiscard]] MedialFile read_medial(const std::filesystem::path& path);
/// Makes a medial axis from the content of a file that read_complex() has read. Messages call the file `name`.
/// @throws FormatError with the name and the reason.
[[nodiscard]] MedialFile read_medial(const ComplexFile& file, const std::string& name);
/// Reads a medial axis from memory. In messages, `name` is used as the name of the file.
[[nodiscard]] MedialFile read_medial(std::span<const std::byte> bytes, ComplexFormat format,
                                     const std::string& name = "medial axis");

}  // namespace blum
