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

/// Medial axis in a file.
struct MedialFile {
  Complex complex;  ///< with the columns of MedialView that the file holds; CompleteAxis has all
  MedialMetadata metadata;
  std::optional<Complex> nested = {};  ///< Axes of all angles, if the file holds them (.npz).
  double least_theta = 0;              ///< Least theta of these axes, degrees.
  bool has_radii = false;
  bool has_footprints = false;
  bool has_sites = false;
  bool has_angles = false;  ///< of vertices, edges and triangles
  bool has_labels = false;  ///< sheets and roles
};

/// Returns the claims of a file about its axis.
[[nodiscard]] MedialClaims claims_of(const MedialFile& file);

/// Writes a medial axis as a complex (see write_complex), or as .ma. The extension selects the format. Columns of
/// MedialView that the complex lacks are not written; such a file does not name Blum's version.
///
/// Columns of vertices are `radius`, `footprint_0`, `footprint_1` (3 components) and `separation_angle` (float64),
/// `site_0`, `site_1` and `role` (int32). Columns of edges are `separation_angle` (float32) and `role` (int32). Columns
/// of triangles are `separation_angle` (float32) and `sheet` (int32). Roles are the numbers of MedialRole. Sites are -1
/// if none.
///
///   `.vtp`, `.ply`, `.npz`  Everything, with the metadata.
///   `.obj`                  Positions, triangles, and edges of no triangle.
///   `.ma`                   Text: counts; v x y z radius; e for all edges, also those of triangles, each once; f.
///                           Medial meshes are exchanged in this form (Q-MAT). Such files have no metadata.
///
/// Coordinates keep double precision. A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension, a column of MedialView of another type, or missing radii in .ma.
/// @throws InvalidOption for metadata that are not finite or out of range.
/// @throws InvalidGrid for the grid of the metadata.
/// @throws InvalidMesh if the complex names missing vertices, or one twice in an edge or triangle. Also if it holds
/// numbers that are not finite, a negative radius, or a sheet beyond its count.
/// @throws FileError, Cancelled.
void write_medial(const std::filesystem::path& path, const Complex& complex, const MedialMetadata& metadata = {},
                  const Context& context = {});

/// Writes a medial axis with the axes of all angles, MedialAxis::nested(), for viewers. Only .npz files hold them, as
/// the further complex `nested` with more columns (float32). For vertices and triangles, `until` is the theta at which
/// they vanish (inf: never). For edges, `from` and `until` are the limits between which an edge has its role. The
/// metadata hold the least angle as `nested_theta`.
/// @throws InvalidOption for other formats.
/// @param least_theta  MedialAxis::least_theta(), degrees.
void write_medial(const std::filesystem::path& path, const Complex& complex, const Complex& nested, double least_theta,
                  const MedialMetadata& metadata = {}, const Context& context = {});

/// Returns the extensions that read_medial() reads and whose files hold radii.
[[nodiscard]] std::vector<std::string> extensions_with_radii();

/// Reads a file written by write_medial(), or one of the same form by another program (see read_complex), with any of
/// the columns. Further columns follow them. Files of .vtp, .ply and .npz give back exactly what was written. If a file
/// does not state roles of edges, the sides of triangles are left out, because triangles imply them. All other edges
/// are curves.
/// @throws FileError.
/// @throws FormatError that names the file and the reason.
/// @throws InvalidOption for another extension.
[[nodiscard]] MedialFile read_medial(const std::filesystem::path& path);
/// Reads a medial axis from memory. In messages, `name` stands for the file.
[[nodiscard]] MedialFile read_medial(std::span<const std::byte> bytes, ComplexFormat format,
                                     const std::string& name = "medial axis");

}  // namespace blum
