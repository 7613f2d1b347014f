// Blum: the table of file formats. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/describe.hpp"

namespace blum {

/// Kind of content of a file. Medial axes are complexes.
enum class FileContent : std::uint8_t {
  mesh,
  image,
  field,
  complex,
  points,         ///< points with columns
  pairs,          ///< pairs of close primitives
  collisions,     ///< collisions of moving features
  surface_map,    ///< distances on a surface, as a texture
  graph,          ///< graph of a medial axis or a Voronoi diagram
  centreline,     ///< graph of curves with radii
  extended_axis,  ///< medial axis continued to the surface
  path,           ///< path of rigid bodies, with its proof
};

template <>
struct Description<FileContent> {
  static constexpr std::string_view name = "FileContent";
  static constexpr std::array values{NamedValue{FileContent::mesh, "mesh"},
                                     NamedValue{FileContent::image, "image"},
                                     NamedValue{FileContent::field, "field"},
                                     NamedValue{FileContent::complex, "complex"},
                                     NamedValue{FileContent::points, "points"},
                                     NamedValue{FileContent::pairs, "pairs"},
                                     NamedValue{FileContent::collisions, "collisions"},
                                     NamedValue{FileContent::surface_map, "surface map"},
                                     NamedValue{FileContent::graph, "graph"},
                                     NamedValue{FileContent::centreline, "centreline"},
                                     NamedValue{FileContent::extended_axis, "extended axis"},
                                     NamedValue{FileContent::path, "path"}};
};

enum class FileAccess : std::uint8_t {
  read,
  write,
  both  ///< a format that is written and read
};

/// File format of one kind of content. If several kinds of content use the same format name (PLY), there is a
/// FileFormat for each kind of content.
struct FileFormat {
  FileContent content = FileContent::mesh;
  std::string name;                     ///< for example "PLY"
  std::vector<std::string> extensions;  ///< extensions that are read, in lower case, with their dots; the usual one
                                        ///< first
  std::vector<std::string> written;     ///< extensions that are written: some of those that are read, or others if the
                                        ///< format is not read
  std::string holds;                    ///< description of the content that a file may have, for people
  std::string opens_in;                 ///< other programs that open the files, for people
};

template <>
struct Description<FileFormat> {
  static constexpr std::string_view name = "FileFormat";
  static constexpr std::string_view doc =
      "File format for one kind of content; a format for several kinds, such as PLY, is listed once for each";
  static constexpr std::tuple members{
      Member{"content", &FileFormat::content, "", "content of the files; medial axes are complexes"},
      Member{"name", &FileFormat::name, "", "name of the format"},
      Member{"extensions", &FileFormat::extensions, "", "extensions that are read, in lower case, with the dot"},
      Member{"written", &FileFormat::written, "",
             "extensions that are written: some or all of those that are read, or others if the format is not read"},
      Member{"holds", &FileFormat::holds, "", "description of the possible content"},
      Member{"opens_in", &FileFormat::opens_in, "", "names of other programs that open such files"},
  };
};

/// Returns all formats, ordered by their kind of content.
[[nodiscard]] const std::vector<FileFormat>& file_formats();

/// A file format of one kind of content: an entry of file_formats().
template <FileContent content>
class FormatOf {
 public:
  /// Finds a format by its name in file_formats() or by one of its extensions, in lower or upper case, with or without
  /// the dot. Example: MeshFormat("stl").
  /// @throws InvalidOption that lists the known formats.
  explicit FormatOf(std::string_view name);

  /// Returns the name in file_formats(), for example "STL".
  [[nodiscard]] const std::string& name() const { return file_formats()[row_].name; }
  /// Returns the index in file_formats().
  [[nodiscard]] std::size_t row() const { return row_; }
  friend bool operator==(FormatOf, FormatOf) = default;

  /// Returns the format in which files with the extension of a path are read; nullopt if such files are not read.
  [[nodiscard]] static std::optional<FormatOf> by_name(const std::filesystem::path& path);
  /// Returns the format that the first bytes of a file identify; nullopt if they identify none.
  /// @param head  the first 8 KiB of the file, or all bytes of a smaller file.
  [[nodiscard]] static std::optional<FormatOf> by_head(std::string_view head);
  /// Returns the format in which files with the extension of a path are read or written.
  /// @param what  name of the content in messages, in the plural; if empty, a default such as "meshes".
  /// @throws InvalidOption with the path and the extensions that can be read or written.
  [[nodiscard]] static FormatOf of(const std::filesystem::path& path, FileAccess access = FileAccess::read,
                                   std::string_view what = {});

 private:
  explicit FormatOf(std::size_t row) : row_(row) {}
  std::size_t row_;
};

using MeshFormat = FormatOf<FileContent::mesh>;
using ImageFormat = FormatOf<FileContent::image>;
using FieldFormat = FormatOf<FileContent::field>;
using ComplexFormat = FormatOf<FileContent::complex>;
using PointFormat = FormatOf<FileContent::points>;
using PairFormat = FormatOf<FileContent::pairs>;
using CollisionFormat = FormatOf<FileContent::collisions>;
using SurfaceMapFormat = FormatOf<FileContent::surface_map>;
using GraphFormat = FormatOf<FileContent::graph>;
using CentrelineFormat = FormatOf<FileContent::centreline>;
using ExtendedAxisFormat = FormatOf<FileContent::extended_axis>;
using PathFormat = FormatOf<FileContent::path>;

extern template class FormatOf<FileContent::mesh>;
extern template class FormatOf<FileContent::image>;
extern template class FormatOf<FileContent::field>;
extern template class FormatOf<FileContent::complex>;
extern template class FormatOf<FileContent::points>;
extern template class FormatOf<FileContent::pairs>;
extern template class FormatOf<FileContent::collisions>;
extern template class FormatOf<FileContent::surface_map>;
extern template class FormatOf<FileContent::graph>;
extern template class FormatOf<FileContent::centreline>;
extern template class FormatOf<FileContent::extended_axis>;
extern template class FormatOf<FileContent::path>;

/// Returns the last extension of a file name in lower case, with its dot. The extensions ".nii.gz", ".hdr.gz" and
/// ".img.gz" are treated as single extensions.
[[nodiscard]] std::string file_extension(const std::filesystem::path& path);

/// Returns the extensions of the formats of one kind of content, in the order of file_formats().
[[nodiscard]] std::vector<std::string> file_extensions(FileContent content, FileAccess access);
/// Returns the extensions of the formats of one kind of content as one text, for example ".obj .off .stl .ply".
[[nodiscard]] std::string extension_list(FileContent content, FileAccess access, std::string_view between = " ");

}  // namespace blum
