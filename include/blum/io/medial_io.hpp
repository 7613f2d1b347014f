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
#include "blum/medial_axis/nested_complex.hpp"

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
  // Of the solid's file: which voxels of an image, at most one of two (neither: all that are not 0), and how a mesh was
  // welded.
  std::optional<std::int64_t> label = {};  ///< those of this value
  std::optional<double> threshold = {};    ///< those of this value or more, in image values
  std::optional<double> weld = {};  ///< MeshReadOptions::weld, >= 0, mesh units; unset: the default of the format
};

/// A medial axis as a file holds it.
struct MedialFile {
  MedialComplex complex;
  MedialMetadata metadata;
  std::optional<NestedComplex> nested = {};  ///< the axes of all angles, where the file holds them (.npz)
  bool has_radii = false;
  bool has_footprints = false;
  bool has_sites = false;
  bool has_angles = false;  ///< of vertices, edges and triangles
  bool has_labels = false;  ///< sheets and roles
};

enum class MedialFormat : std::uint8_t { vtp, ply, obj, ma, npz };

/// Writes a medial axis; the format goes by the extension.
///
///   .vtp  VTK poly data, raw appended: isolated vertices as verts; curves, rims and seams as lines; triangles as
///         polys. Point data `radius`, `separation_angle`, `role`, `footprint_0`, `footprint_1`, `site_0`, `site_1`;
///         cell data `separation_angle`, `role` (255 for polys), `sheet` (-1 for verts and lines); metadata (JSON) as
///         the string `metadata` of the field data.
///   .ply  binary, vertices with all attributes, and the radius again as `quality` (float32); triangles with theirs;
///         edges (curves, rims, seams), whose attributes are an element of their own, `edge_attributes`, in the edges'
///         order; metadata as comments `blum {"key": "value"}`.
///   .obj  v; f; l for edges of no triangle; p for vertices of nothing else. No attributes, no unused vertex.
///   .ma   text: counts; v x y z radius; e for all edges, also those of triangles, each once; f. As medial meshes are
///         exchanged (Q-MAT); such files have no metadata.
///   .npz  `vertices`, `radius`, `separation_angle`, `role`, `footprints` [n, 2, 3], `sites` [n, 2]; `edges`,
///         `edge_angle`, `edge_role`; `triangles`, `triangle_angle`, `triangle_sheet`; `metadata` (JSON).
///
/// Roles are the numbers of MedialRole, sites are -1 where there is none, and indices count from 0 (in .obj from 1).
/// Coordinates keep double precision. A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension, or metadata that are not finite or not as said above; InvalidGrid;
/// InvalidMesh when the complex names vertices that it does not have, or one twice in an edge or triangle, or holds
/// numbers that are not finite, a negative radius, or a sheet beyond its count; FileError; Cancelled.
void write_medial(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata = {},
                  const Context& context = {});

/// The same with the axes of all angles, MedialAxis::nested(), for viewers. Only .npz files hold them, in arrays like
/// those above whose names begin with `nested_`, and: `nested_theta` [1], the least angle; `nested_vertex_until`,
/// `nested_triangle_until`, at which theta a vertex or triangle is gone (inf: at none); `nested_edge_from` and
/// `nested_edge_until`, between which an edge has its role.
/// @throws InvalidOption for other formats.
void write_medial(const std::filesystem::path& path, const MedialComplex& complex, const NestedComplex& nested,
                  const MedialMetadata& metadata = {}, const Context& context = {});

/// Reads a file that write_medial wrote, or one of the same form by another program: with only some of the attributes,
/// with polygons (.ply, .obj), with other numeric types and byte orders (.vtp, .ply, .npz). .vtp, .ply and .npz give
/// back exactly what was written. Where a file does not say what its edges are, those that are sides of triangles are
/// left out, as the triangles imply them, and the others are curves; without sheets all triangles are on sheet 0.
/// @throws FileError; FormatError naming the file and the reason; InvalidOption for another extension.
[[nodiscard]] MedialFile read_medial(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] MedialFile read_medial(std::span<const std::byte> bytes, MedialFormat format,
                                     const std::string& name = "medial axis");

}  // namespace blum
