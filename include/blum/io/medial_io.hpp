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

/// A medial axis as a file holds it.
struct MedialFile {
  Complex complex;  ///< with those columns of MedialView that the file holds; CompleteAxis has all
  MedialMetadata metadata;
  std::optional<Complex> nested = {};  ///< the axes of all angles, where the file holds them (.npz)
  double least_theta = 0;              ///< of these, degrees
  bool has_radii = false;
  bool has_footprints = false;
  bool has_sites = false;
  bool has_angles = false;  ///< of vertices, edges and triangles
  bool has_labels = false;  ///< sheets and roles
};

/// What a file says of its axis.
[[nodiscard]] MedialClaims claims_of(const MedialFile& file);

/// Writes a medial axis as a complex (see write_complex), or as .ma; the format goes by the extension. Columns of
/// MedialView that it lacks are not written.
///
/// The columns are, of vertices: `radius`, `footprint_0`, `footprint_1` (3 components), `separation_angle` (float64),
/// `site_0`, `site_1` and `role` (int32); of edges: `separation_angle` (float32) and `role` (int32); of triangles:
/// `separation_angle` (float32) and `sheet` (int32). Roles are the numbers of MedialRole; sites are -1 where there is
/// none.
///
///   .vtp, .ply, .npz  hold all of it, and the metadata.
///   .obj  holds positions, triangles, and edges of no triangle.
///   .ma   text: counts; v x y z radius; e for all edges, also those of triangles, each once; f. As medial meshes are
///         exchanged (Q-MAT); such files have no metadata.
///
/// Coordinates keep double precision. A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension, a column of MedialView that is of another type, radii that are missing
/// where .ma files need them, or metadata that are not finite or not as said above; InvalidGrid; InvalidMesh when the
/// complex names vertices that it does not have, or one twice in an edge or triangle, or holds numbers that are not
/// finite, a negative radius, or a sheet beyond its count; FileError; Cancelled.
void write_medial(const std::filesystem::path& path, const Complex& complex, const MedialMetadata& metadata = {},
                  const Context& context = {});

/// The same with the axes of all angles, MedialAxis::nested(), for viewers. Only .npz files hold them, as the further
/// complex `nested`, which has more columns (float32): of vertices and triangles `until`, the theta at which they are
/// gone (inf: none); of edges `from` and `until`, between which an edge has its role. The least angle is in the
/// metadata, as `nested_theta`.
/// @throws InvalidOption for other formats.
/// @param least_theta  MedialAxis::least_theta(), degrees.
void write_medial(const std::filesystem::path& path, const Complex& complex, const Complex& nested, double least_theta,
                  const MedialMetadata& metadata = {}, const Context& context = {});

/// Those of the extensions which read_medial() reads whose files hold radii.
[[nodiscard]] std::vector<std::string> extensions_with_radii();

/// Reads a file that write_medial wrote, or one of the same form by another program (see read_complex), with any of the
/// columns; further ones follow them. .vtp, .ply and .npz give back exactly what was written. Where a file does not say
/// what its edges are, those that are sides of triangles are left out, as the triangles imply them, and the others are
/// curves.
/// @throws FileError; FormatError naming the file and the reason; InvalidOption for another extension.
[[nodiscard]] MedialFile read_medial(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] MedialFile read_medial(std::span<const std::byte> bytes, ComplexFormat format,
                                     const std::string& name = "medial axis");

}  // namespace blum
