// Blum: the rows of the table of formats, with their readers and writers. SPDX-License-Identifier: Apache-2.0
//
// A new format is a file of its own that defines the functions named here, a row, and a test: nothing else names
// formats.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <variant>

#include "blum/io/complex_io.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "io/byte_source.hpp"

namespace blum::formats {

namespace fs = std::filesystem;
using volume_io::ByteSource;

/// What every content's code may say of a file's bytes.
struct Tells {
  /// Whether the first bytes of a file are those of this format; null where they do not tell.
  bool (*begins)(std::string_view head) = nullptr;
  /// Whether a file of this format's extension, with these first bytes, holds this content; null: always.
  bool (*holds_this)(std::string_view head, const fs::path& path) = nullptr;
};

struct MeshCode {
  /// All indices of the mesh are in range. @throws FormatError. Null: not read.
  MeshFile (*read)(std::string_view bytes, std::string_view name);
  /// Gets valid meshes of finite vertices.
  void (*write)(const fs::path& path, const MeshView& mesh);
  Tells tells = {};
};

struct ImageCode {
  /// @param path  where the source came from, empty for memory.
  VoxelImage (*read)(const ByteSource& source, const fs::path& path);
  void (*write)(const fs::path& path, const VoxelImageView& image) = nullptr;  ///< null: not written
  Tells tells = {};
  /// Reads an image that is spread over several files; nullopt where this path is not of that kind. May be null.
  std::optional<VoxelImage> (*read_several)(const fs::path& path) = nullptr;
};

struct FieldCode {
  /// @param path  where the source came from, to find the sites; empty: they are not looked for.
  Field (*read)(const ByteSource& source, const fs::path& path);
  void (*write)(const fs::path& path, const Field& field, const FieldFileInfo& info, const Context& context);
  Tells tells = {};
};

/// Readers check whatever they need to be safe; problem_of() is asked afterwards. Writers get complexes without
/// problems, and names and metadata that files can hold; they refuse what they would lose unless the options allow it.
struct ComplexCode {
  /// Reads part by part, from where the parts are; null where read_text reads all. Both null: not read.
  ComplexFile (*read)(const ByteSource& source);
  ComplexFile (*read_text)(std::string_view bytes, std::string_view name);
  void (*write)(const fs::path& path, const Complex& complex, const FileMetadata& metadata,
                const ComplexWriteOptions& options, const Context& context);
  Tells tells = {};
  bool holds_further = false;  ///< whether a file holds several complexes
  bool holds_columns = true;   ///< any of them
};

extern const MeshCode mesh_obj, mesh_off, mesh_stl, mesh_ply, mesh_glb;
extern const ImageCode image_nrrd, image_nifti, image_npy, image_vol;
extern const FieldCode field_nrrd, field_npz, field_vti;
extern const ComplexCode complex_vtp, complex_ply, complex_obj, complex_ma, complex_npz, complex_glb;

struct Row {
  std::string_view name;  ///< these as in FileFormat, lists as words between blanks
  std::string_view extensions;
  std::string_view written;
  std::string_view holds;
  std::string_view opens_in;
  std::variant<const MeshCode*, const ImageCode*, const FieldCode*, const ComplexCode*> code;  ///< as FileContent
};

inline constexpr std::array table{
    Row{"OBJ", ".obj", ".obj", "triangles, polygons, segments, points; double precision", "Blender, MeshLab",
        &mesh_obj},
    Row{"OFF", ".off", ".off", "triangles, polygons; double precision", "MeshLab, CGAL", &mesh_off},
    Row{"STL", ".stl", ".stl", "triangles without shared vertices; single precision", "CAD, slicers", &mesh_stl},
    Row{"PLY", ".ply", ".ply", "triangles, polygons, segments; double precision", "MeshLab, Blender, ParaView",
        &mesh_ply},
    Row{"GLB", "", ".glb", "triangles, segments, points; single precision", "Blender, three.js, most viewers",
        &mesh_glb},

    Row{"NRRD", ".nrrd .nhdr", ".nrrd", "scalars of any type, spacing, axes, space", "3D Slicer, ITK", &image_nrrd},
    Row{"NIfTI", ".nii .nii.gz .hdr .hdr.gz .img .img.gz", "", "scalars of any type, spacing, axes",
        "3D Slicer, ITK, FSL", &image_nifti},
    Row{"NPY", ".npy", ".npy", "scalars of any type, [z, y, x]; no spacing", "NumPy", &image_npy},
    Row{"Vol", ".vol", "", "bytes; no spacing", "DGtal", &image_vol},

    Row{"NRRD", ".nrrd", ".nrrd", "distances; sites (and what is of order 2) in files beside it, NAME.site.nrrd",
        "3D Slicer, ITK", &field_nrrd},
    Row{"NPZ", ".npz", ".npz", "distances, sites, vertices of sites", "NumPy", &field_npz},
    Row{"VTI", ".vti", ".vti", "distances, sites", "ParaView, VTK", &field_vti},

    Row{"VTP", ".vtp", ".vtp", "all columns, metadata", "ParaView, VTK, 3D Slicer", &complex_vtp},
    Row{"PLY", ".ply", ".ply", "all columns, metadata", "MeshLab, trimesh", &complex_ply},
    Row{"OBJ", ".obj", ".obj", "positions, edges, triangles; no columns", "Blender, MeshLab", &complex_obj},
    Row{"MA", ".ma", ".ma", "positions, radii, edges, triangles of medial axes", "Q-MAT", &complex_ma},
    Row{"NPZ", ".npz", ".npz", "all columns, metadata, further complexes", "NumPy", &complex_npz},
    Row{"GLB", "", ".glb", "positions, edges, triangles, columns of vertices, metadata; single precision",
        "Blender, three.js, trimesh", &complex_glb},
};

/// What the bytes of a row's files tell.
[[nodiscard]] inline const Tells& tells_of(std::size_t row) {
  return std::visit([](const auto* code) -> const Tells& { return code->tells; }, table[row].code);
}

/// The functions of a format.
[[nodiscard]] inline const MeshCode& code_of(MeshFormat format) {
  return *std::get<const MeshCode*>(table[format.row()].code);
}
[[nodiscard]] inline const ImageCode& code_of(ImageFormat format) {
  return *std::get<const ImageCode*>(table[format.row()].code);
}
[[nodiscard]] inline const FieldCode& code_of(FieldFormat format) {
  return *std::get<const FieldCode*>(table[format.row()].code);
}
[[nodiscard]] inline const ComplexCode& code_of(ComplexFormat format) {
  return *std::get<const ComplexCode*>(table[format.row()].code);
}

}  // namespace blum::formats
