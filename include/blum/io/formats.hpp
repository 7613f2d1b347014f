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

/// Content of a file. Medial axes are complexes.
enum class FileContent : std::uint8_t {
  mesh,
  image,
  field,
  complex,
  points,         ///< with attributes
  pairs,          ///< primitives that are close
  collisions,     ///< collisions of moving features
  surface_map,    ///< distances as a texture
  graph,          ///< graph of a medial axis or a Voronoi diagram
  centreline,     ///< graphs of curves with radii
  extended_axis,  ///< medial axis continued to the surface
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
                                     NamedValue{FileContent::extended_axis, "extended axis"}};
};

enum class FileAccess : std::uint8_t {
  read,
  write,
  both  ///< written files can be read again
};

/// Format of files of one content. A name that several contents use (PLY) has a row for each.
struct FileFormat {
  FileContent content = FileContent::mesh;
  std::string name;                     ///< for example "PLY"
  std::vector<std::string> extensions;  ///< read: lower case, with their dots; the usual one first
  std::vector<std::string> written;     ///< written: some of those that are read, or others if the format is not read
  std::string holds;                    ///< possible content, for people
  std::string opens_in;                 ///< other programs, for people
};

template <>
struct Description<FileFormat> {
  static constexpr std::string_view name = "FileFormat";
  static constexpr std::string_view doc =
      "File format of one content; a name that several contents use (PLY) is listed once for each";
  static constexpr std::tuple members{
      Member{"content", &FileFormat::content, "", "content of the files; medial axes are complexes"},
      Member{"name", &FileFormat::name, "", "name of the format"},
      Member{"extensions", &FileFormat::extensions, "", "extensions that are read, in lower case, with their dots"},
      Member{"written", &FileFormat::written, "",
             "extensions that are written: some of those that are read, or others if the format is not read"},
      Member{"holds", &FileFormat::holds, "", "possible content, for people"},
      Member{"opens_in", &FileFormat::opens_in, "", "other programs, for people"},
  };
};

/// Returns all formats, content by content.
[[nodiscard]] const std::vector<FileFormat>& file_formats();

/// A format of files of one content.
template <FileContent content>
class FormatOf {
 public:
  /// Finds a format by its name in file_formats() or one of its extensions, in any case, with or without the dot:
  /// MeshFormat("stl").
  /// @throws InvalidOption that lists the known formats.
  explicit FormatOf(std::string_view name);

  /// Returns the name in file_formats(), for example "STL".
  [[nodiscard]] const std::string& name() const { return file_formats()[row_].name; }
  /// Returns the index in file_formats().
  [[nodiscard]] std::size_t row() const { return row_; }
  friend bool operator==(FormatOf, FormatOf) = default;

  /// Returns the format that is read from files with the extension of a path; nullopt if none is.
  [[nodiscard]] static std::optional<FormatOf> by_name(const std::filesystem::path& path);
  /// Returns the format of a file by its first bytes (8 KiB, or all); nullopt if they do not show one.
  [[nodiscard]] static std::optional<FormatOf> by_head(std::string_view head);
  /// Returns the format that files with the extension of a path are read or written in.
  /// @param what  name of the files' content in messages, in the plural; empty: its own name.
  /// @throws InvalidOption that names the path and the extensions that can be read or written.
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

/// Returns the last extension of a name in lower case, with its dot. ".nii.gz", ".hdr.gz" and ".img.gz" count as one.
[[nodiscard]] std::string file_extension(const std::filesystem::path& path);

/// Returns the extensions of a content's formats, in the order of the table.
[[nodiscard]] std::vector<std::string> file_extensions(FileContent content, FileAccess access);
/// Returns the same extensions as a text, for example ".obj .off .stl .ply".
[[nodiscard]] std::string extension_list(FileContent content, FileAccess access, std::string_view between = " ");

}  // namespace blum
