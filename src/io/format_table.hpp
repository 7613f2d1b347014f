// Blum: the rows of the table of formats, with their readers and writers. SPDX-License-Identifier: Apache-2.0
//
// To add a format, write a file that defines the functions listed here, add a row to the table, and add a test. No
// other code refers to single formats.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <variant>
#include <vector>

#include "blum/io/centreline_io.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "io/bytes/byte_source.hpp"

namespace blum {

struct AxisGraph;
struct PathFile;
struct VoronoiGraph;
struct VoronoiSite;
namespace surface_map_files {
struct Request;
}
namespace tables {
struct RowFile;
}

/// Returns the format of a mesh whose extension is not known, by its first bytes and its size. A pipe is kept, as by
/// read_file_head(). @throws as read_whole_file().
[[nodiscard]] std::optional<MeshFormat> mesh_format_by_content(const std::filesystem::path& path,
                                                               std::string_view head);

}  // namespace blum

namespace blum::formats {

namespace fs = std::filesystem;
using volume_io::ByteSource;

/// Returns the format of a file by its name, or by its first bytes if the name has no known extension.
template <class Format>
[[nodiscard]] std::optional<Format> format_of_file(const fs::path& path) {
  std::optional<Format> format = Format::by_name(path);
  std::error_code ignored;
  if (!format && fs::exists(path, ignored)) format = Format::by_head(read_file_head(path));
  return format;
}

/// Tests of the first bytes of a file.
struct Sniffer {
  /// Returns true if the first bytes of a file show that it has this format. Null if bytes cannot identify the format.
  bool (*begins)(std::string_view head) = nullptr;
  /// Returns true if a file with this format's extension and these first bytes has this kind of content. Null if every
  /// file of the format has this kind of content.
  bool (*holds_this)(std::string_view head, const fs::path& path) = nullptr;
};

struct MeshCode {
  /// Reads a mesh. All indices of the result are in range. @throws FormatError. Null if Blum does not read the format.
  MeshFile (*read)(std::string_view bytes, std::string_view name);
  /// Writes a mesh, which must be valid and have finite vertices.
  void (*write)(const fs::path& path, const MeshView& mesh);
  Sniffer sniffer = {};
};

struct ImageCode {
  /// @param path  path of the source; empty if the bytes come from memory.
  ImageFile (*read)(const ByteSource& source, const fs::path& path);
  /// Null if Blum does not write the format.
  void (*write)(const fs::path& path, const VoxelImageView& image) = nullptr;
  Sniffer sniffer = {};
  /// Reads an image that consists of several files. Returns nullopt if the path is not one of these files. May be null.
  std::optional<ImageFile> (*read_several)(const fs::path& path) = nullptr;
};

struct FieldCode {
  /// @param path  path of the source. The files of the other arrays are next to it. If empty, they are not read.
  Field (*read)(const ByteSource& source, const fs::path& path);
  void (*write)(const fs::path& path, const Field& field, const FieldFileInfo& info, const Context& context);
  Sniffer sniffer = {};
};

/// Readers check only what makes them safe; callers must call problem_of() afterwards. Writers require complexes
/// without problems, and names and metadata that files can store. They throw if content would be lost, unless the
/// options allow it.
struct ComplexCode {
  /// Reads from a source, one part at a time. Null if read_text is used instead. Both are null if Blum does not read
  /// the format.
  ComplexFile (*read)(const ByteSource& source);
  ComplexFile (*read_text)(std::string_view bytes, std::string_view name);
  void (*write)(const fs::path& path, const Complex& complex, const FileMetadata& metadata,
                const ComplexWriteOptions& options, const Context& context);
  Sniffer sniffer = {};
  bool holds_further = false;  ///< true if a file can contain several complexes
  bool holds_columns = true;   ///< true if files can contain columns
  bool holds_radii = true;     ///< true if files can contain the radii of medial axes
};

struct PointCode {
  std::vector<Vec3d> (*read)(const fs::path& path);  ///< may return numbers that are not finite
  /// Writes vertices, and metadata that describe the content. Null if Blum does not write the format.
  void (*write)(const fs::path& path, const Complex& points, const FileMetadata& metadata, const Context& context);
  bool is_cloud = false;  ///< true if files contain points, not meshes
};

/// Rows of named columns, for pairs and collisions.
struct RowCode {
  void (*write)(const fs::path& path, const tables::RowFile& file, const Context& context);
};

struct SurfaceMapCode {
  void (*write)(const surface_map_files::Request& request);
};

/// Both functions return the content of a file.
struct GraphCode {
  std::string (*text_of_axis)(const AxisGraph& graph, const MedialMetadata& metadata);
  std::string (*text_of_diagram)(const VoronoiGraph& graph, std::span<const VoronoiSite> sites,
                                 const FileMetadata& metadata);
};

struct CentrelineCode {
  void (*write)(const fs::path& path, const Centrelines& lines, const CentrelineFileInfo& info, const Context& context);
};

struct ExtendedAxisCode {
  void (*write)(const fs::path& path, const Complex& surface, const FileMetadata& metadata, const Context& context);
};

struct PathCode {
  /// @param name  of the file in messages. @throws FormatError.
  PathFile (*read)(std::string_view bytes, const std::string& name);
  /// Returns the content of a file. Null if Blum does not write the format.
  std::string (*text_of)(const PathFile& file);
};

extern const MeshCode mesh_obj, mesh_off, mesh_stl, mesh_ply, mesh_glb;
extern const ImageCode image_nrrd, image_nifti, image_npy, image_vol;
extern const FieldCode field_nrrd, field_npz, field_vti;
extern const ComplexCode complex_vtp, complex_ply, complex_obj, complex_ma, complex_npz, complex_glb;
extern const PointCode points_npy, points_npz, points_text, points_as_complex, points_of_mesh;
extern const RowCode rows_npz, rows_csv, rows_json, rows_as_complex;
extern const SurfaceMapCode surface_map_npz, surface_map_png, surface_map_glb, surface_map_as_complex;
extern const GraphCode graph_json, graph_graphml;
extern const CentrelineCode centreline_json, centreline_csv, centreline_swc, centreline_as_complex;
extern const ExtendedAxisCode extended_as_complex, extended_stl;
extern const PathCode path_json, path_csv;

/// Type that has the functions for formats of a kind of content.
template <FileContent content>
using CodeOf = std::tuple_element_t<static_cast<std::size_t>(content),
                                    std::tuple<MeshCode, ImageCode, FieldCode, ComplexCode, PointCode, RowCode, RowCode,
                                               SurfaceMapCode, GraphCode, CentrelineCode, ExtendedAxisCode, PathCode>>;

struct Row {
  FileContent content = FileContent::mesh;
  std::string_view name;  ///< these members are as in FileFormat; lists are words separated by blanks
  std::string_view extensions;
  std::string_view written;
  std::string_view holds;
  std::string_view opens_in;
  std::variant<const MeshCode*, const ImageCode*, const FieldCode*, const ComplexCode*, const PointCode*,
               const RowCode*, const SurfaceMapCode*, const GraphCode*, const CentrelineCode*, const ExtendedAxisCode*,
               const PathCode*>
      code;
};

inline constexpr auto table = [] {
  using enum FileContent;
  return std::array{
      Row{mesh, "OBJ", ".obj", ".obj", "triangles, polygons, segments, points; double precision", "Blender, MeshLab",
          &mesh_obj},
      Row{mesh, "OFF", ".off", ".off", "triangles, polygons; double precision", "MeshLab, CGAL", &mesh_off},
      Row{mesh, "STL", ".stl", ".stl", "triangles without shared vertices; single precision", "CAD, slicers",
          &mesh_stl},
      Row{mesh, "PLY", ".ply", ".ply", "triangles, polygons, segments; double precision", "MeshLab, Blender, ParaView",
          &mesh_ply},
      Row{mesh, "GLB", "", ".glb", "triangles, segments, points; single precision", "Blender, three.js, most viewers",
          &mesh_glb},

      Row{image, "NRRD", ".nrrd .nhdr", ".nrrd", "scalars of any type, spacing, axes, space", "3D Slicer, ITK",
          &image_nrrd},
      Row{image, "NIfTI", ".nii .nii.gz .hdr .hdr.gz .img .img.gz", "", "scalars of any type, spacing, axes",
          "3D Slicer, ITK, FSL", &image_nifti},
      Row{image, "NPY", ".npy", ".npy", "scalars of any type, [z, y, x]; no spacing", "NumPy", &image_npy},
      Row{image, "Vol", ".vol", "", "bytes; no spacing", "DGtal", &image_vol},

      Row{field, "NRRD", ".nrrd", ".nrrd",
          "distances; sites and values of order 2 in separate files (NAME.site.nrrd, ...)", "3D Slicer, ITK",
          &field_nrrd},
      Row{field, "NPZ", ".npz", ".npz", "distances, sites, vertices of sites", "NumPy", &field_npz},
      Row{field, "VTI", ".vti", ".vti", "distances, sites", "ParaView, VTK", &field_vti},

      Row{complex, "VTP", ".vtp", ".vtp", "all columns, metadata", "ParaView, VTK, 3D Slicer", &complex_vtp},
      Row{complex, "PLY", ".ply", ".ply", "all columns, metadata", "MeshLab, trimesh", &complex_ply},
      Row{complex, "OBJ", ".obj", ".obj", "positions, edges, triangles; no columns", "Blender, MeshLab", &complex_obj},
      Row{complex, "MA", ".ma", ".ma", "positions, radii, edges, triangles of medial axes", "Q-MAT", &complex_ma},
      Row{complex, "NPZ", ".npz", ".npz", "all columns, metadata, further complexes", "NumPy", &complex_npz},
      Row{complex, "GLB", "", ".glb", "positions, edges, triangles, columns of vertices, metadata; single precision",
          "Blender, three.js, trimesh", &complex_glb},

      Row{points, "NPY", ".npy", "", "an array [n, 3]", "NumPy", &points_npy},
      Row{points, "NPZ", ".npz", ".npz", "positions, all columns, metadata", "NumPy", &points_npz},
      Row{points, "PLY", ".ply", ".ply", "positions, all columns, metadata", "MeshLab, trimesh", &points_as_complex},
      Row{points, "VTP", ".vtp", ".vtp", "positions, all columns, metadata", "ParaView, VTK", &points_as_complex},
      Row{points, "CSV", ".csv .xyz .txt", ".csv", "a row of numbers for each point", "spreadsheets, pandas",
          &points_text},
      Row{points, "OBJ", ".obj", "", "the vertices of a mesh", "Blender, MeshLab", &points_of_mesh},
      Row{points, "OFF", ".off", "", "the vertices of a mesh", "MeshLab, CGAL", &points_of_mesh},
      Row{points, "STL", ".stl", "", "the vertices of a mesh", "CAD, slicers", &points_of_mesh},

      Row{pairs, "NPZ", "", ".npz", "all columns, metadata", "NumPy", &rows_npz},
      Row{pairs, "CSV", "", ".csv", "a row for each pair", "spreadsheets, pandas", &rows_csv},
      Row{pairs, "JSON", "", ".json", "all columns, metadata", "any program", &rows_json},
      Row{pairs, "VTP", "", ".vtp", "lines between closest points, all columns, metadata", "ParaView, VTK",
          &rows_as_complex},

      Row{collisions, "NPZ", "", ".npz", "all columns, metadata", "NumPy", &rows_npz},
      Row{collisions, "CSV", "", ".csv", "a row for each collision", "spreadsheets, pandas", &rows_csv},
      Row{collisions, "JSON", "", ".json", "all columns, metadata", "any program", &rows_json},
      Row{collisions, "VTP", "", ".vtp", "the features at the time of impact, metadata", "ParaView, VTK",
          &rows_as_complex},

      Row{surface_map, "NPZ", ".npz", ".npz", "mesh, texture of distances, vectors, sites, metadata", "NumPy",
          &surface_map_npz},
      Row{surface_map, "PNG", "", ".png", "the texture in colours, with a colour bar", "any program", &surface_map_png},
      Row{surface_map, "GLB", "", ".glb", "the mesh with the texture in colours", "Blender, three.js, most viewers",
          &surface_map_glb},
      Row{surface_map, "PLY", "", ".ply", "the mesh with columns, metadata", "MeshLab, trimesh",
          &surface_map_as_complex},
      Row{surface_map, "VTP", "", ".vtp", "the mesh with columns, metadata", "ParaView, VTK", &surface_map_as_complex},

      Row{graph, "JSON", "", ".json", "the whole graph, metadata", "any program", &graph_json},
      Row{graph, "GraphML", "", ".graphml", "nodes and edges with attributes, metadata", "networkx, Gephi, igraph, yEd",
          &graph_graphml},

      Row{centreline, "JSON", "", ".json", "nodes and branches with their points", "any program", &centreline_json},
      Row{centreline, "CSV", "", ".csv", "a row for each branch", "spreadsheets, pandas", &centreline_csv},
      Row{centreline, "SWC", "", ".swc", "trees of points with radii; loops are cut", "Vaa3D, neuTube",
          &centreline_swc},
      Row{centreline, "VTP", "", ".vtp", "polylines with radii", "ParaView, VTK, 3D Slicer", &centreline_as_complex},
      Row{centreline, "PLY", "", ".ply", "polylines with radii", "MeshLab, trimesh", &centreline_as_complex},
      Row{centreline, "NPZ", "", ".npz", "polylines with radii", "NumPy", &centreline_as_complex},

      Row{extended_axis, "VTP", "", ".vtp", "all columns, metadata", "ParaView, VTK, 3D Slicer", &extended_as_complex},
      Row{extended_axis, "PLY", "", ".ply", "all columns, metadata", "MeshLab, trimesh", &extended_as_complex},
      Row{extended_axis, "OBJ", "", ".obj", "positions, edges, triangles", "Blender, MeshLab", &extended_as_complex},
      Row{extended_axis, "NPZ", "", ".npz", "all columns, metadata", "NumPy", &extended_as_complex},
      Row{extended_axis, "STL", "", ".stl", "triangles; single precision", "CAD, slicers", &extended_stl},

      Row{path, "JSON", ".json", ".json", "poses, meshes and the proof", "any program", &path_json},
      Row{path, "CSV", ".csv", "", "poses of one body", "spreadsheets, planners", &path_csv},
  };
}();

/// Returns the tests of a row of the table. Both are null if the row's type has none.
[[nodiscard]] inline Sniffer sniffer_of(std::size_t row) {
  return std::visit(
      []<class Code>(const Code* code) {
        if constexpr (requires { code->sniffer; }) {
          return code->sniffer;
        } else {
          return Sniffer{};
        }
      },
      table[row].code);
}

/// Returns the functions of a format.
template <FileContent content>
[[nodiscard]] const auto& code_of(FormatOf<content> format) {
  return *std::get<const CodeOf<content>*>(table[format.row()].code);
}

}  // namespace blum::formats
