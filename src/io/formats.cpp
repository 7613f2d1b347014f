#include "blum/io/formats.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>

#include "blum/core/error.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/image_io.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"
#include "io/mesh/mesh_stl.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

std::vector<std::string> words_of(std::string_view words) {
  std::istringstream stream{std::string(words)};
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Returns the first row with this content for which fits(row) is true.
template <class Fits>
std::optional<std::size_t> find(FileContent content, Fits fits) {
  const std::vector<FileFormat>& formats = file_formats();
  for (std::size_t row = 0; row < formats.size(); ++row) {
    if (formats[row].content == content && fits(row)) return row;
  }
  return std::nullopt;
}

bool has(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool allows(const FileFormat& format, const std::string& extension, FileAccess access) {
  return (access == FileAccess::write || has(format.extensions, extension)) &&
         (access == FileAccess::read || has(format.written, extension));
}

std::optional<std::size_t> find_extension(FileContent content, const std::string& extension, FileAccess access) {
  return find(content, [&](std::size_t row) { return allows(file_formats()[row], extension, access); });
}

std::size_t find_named(FileContent content, std::string_view name) {
  const std::string word = volume_io::lower_case(name);
  auto row = find(content, [&](std::size_t k) { return volume_io::lower_case(file_formats()[k].name) == word; });
  for (const FileAccess access : {FileAccess::read, FileAccess::write}) {
    if (!row) row = find_extension(content, word.starts_with('.') ? word : "." + word, access);
  }
  if (row) return *row;
  std::string known;
  for (const FileFormat& format : file_formats()) {
    if (format.content == content) known += (known.empty() ? "" : ", ") + format.name;
  }
  throw InvalidOption("there is no format '" + std::string(name) + "' for files with the content '" +
                      std::string(to_string(content)) + "'; the formats are " + known);
}

/// Returns advice for a pipe without an extension; an empty text for other files.
std::string advice_for_pipe(const std::filesystem::path& path) {
  if (path != "-" && !is_pipe(path)) return "";
  return "; for standard input, give a link to /dev/stdin whose name has such an extension (`ln -s /dev/stdin NAME`)";
}

std::optional<std::size_t> find_head(FileContent content, std::string_view head) {
  const auto fits = [&](std::size_t row) {
    const auto begins_as = formats::sniffer_of(row).begins;
    return begins_as != nullptr && begins_as(head);
  };
  // OBJ is tested last, because PLY and OFF files may contain lines that look like OBJ.
  const auto found = find(content, [&](std::size_t row) { return file_formats()[row].name != "OBJ" && fits(row); });
  return found ? found : find(content, fits);
}

}  // namespace

const std::vector<FileFormat>& file_formats() {
  static const std::vector<FileFormat> all = [] {
    std::vector<FileFormat> out;
    for (const formats::Row& row : formats::table) {
      out.push_back({row.content, std::string(row.name), words_of(row.extensions), words_of(row.written),
                     std::string(row.holds), std::string(row.opens_in)});
    }
    return out;
  }();
  return all;
}

template <FileContent content>
FormatOf<content>::FormatOf(std::string_view name) : row_(find_named(content, name)) {}

template <FileContent content>
std::optional<FormatOf<content>> FormatOf<content>::by_name(const std::filesystem::path& path) {
  const auto row = find_extension(content, file_extension(path), FileAccess::read);
  return row ? std::optional(FormatOf(*row)) : std::nullopt;
}

template <FileContent content>
std::optional<FormatOf<content>> FormatOf<content>::by_head(std::string_view head) {
  const auto row = find_head(content, head);
  return row ? std::optional(FormatOf(*row)) : std::nullopt;
}

template <FileContent content>
FormatOf<content> FormatOf<content>::of(const std::filesystem::path& path, FileAccess access, std::string_view what) {
  if (const auto row = find_extension(content, file_extension(path), access)) return FormatOf(*row);
  constexpr std::array<std::string_view, 12> plural{
      "meshes", "images",      "fields",        "complexes, medial axes among them,",
      "points", "close pairs", "collisions",    "surface maps",
      "graphs", "centrelines", "extended axes", "paths"};
  static_assert(plural.size() == Description<FileContent>::values.size());
  if (what.empty()) what = plural[static_cast<std::size_t>(content)];
  throw InvalidOption("'" + path.string() + "': " + std::string(what) + " are " +
                      (access == FileAccess::read    ? "read from "
                       : access == FileAccess::write ? "written to "
                                                     : "written to and read from ") +
                      extension_list(content, access, ", ") + " files; use one of these extensions" +
                      (access == FileAccess::read ? advice_for_pipe(path) : ""));
}

template class FormatOf<FileContent::mesh>;
template class FormatOf<FileContent::image>;
template class FormatOf<FileContent::field>;
template class FormatOf<FileContent::complex>;
template class FormatOf<FileContent::points>;
template class FormatOf<FileContent::pairs>;
template class FormatOf<FileContent::collisions>;
template class FormatOf<FileContent::surface_map>;
template class FormatOf<FileContent::graph>;
template class FormatOf<FileContent::centreline>;
template class FormatOf<FileContent::extended_axis>;
template class FormatOf<FileContent::path>;

std::string file_extension(const std::filesystem::path& path) {
  std::string last = volume_io::lower_case(path.extension().string());
  if (last != ".gz") return last;
  const std::string inner = volume_io::lower_case(path.stem().extension().string());
  return inner == ".nii" || inner == ".hdr" || inner == ".img" ? inner + last : last;
}

std::vector<std::string> file_extensions(FileContent content, FileAccess access) {
  std::vector<std::string> out;
  for (const FileFormat& format : file_formats()) {
    if (format.content != content) continue;
    for (const std::string& extension : access == FileAccess::read ? format.extensions : format.written) {
      if (allows(format, extension, access)) out.push_back(extension);
    }
  }
  return out;
}

std::string extension_list(FileContent content, FileAccess access, std::string_view between) {
  std::string out;
  for (const std::string& extension : file_extensions(content, access)) {
    if (!out.empty()) out += between;
    out += extension;
  }
  return out;
}

namespace {

namespace fs = std::filesystem;

/// Returns true if the extension of a file is that of a format. Its first bytes then need not identify it.
bool has_known_name(const fs::path& path) {
  return MeshFormat::by_name(path) || FieldFormat::by_name(path) || ImageFormat::by_name(path);
}

/// Returns true if a NRRD header declares floating-point values.
bool holds_floats(std::string_view head) {
  std::istringstream lines{std::string(head.substr(0, head.find("\n\n")))};
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("type:")) continue;
    std::istringstream rest(line.substr(5));
    std::string type;
    rest >> type;
    return type == "float" || type == "double";
  }
  return false;
}

std::optional<ComplexFormat> complex_format(const fs::path& path, std::string_view head) {
  const auto format = ComplexFormat::by_name(path);
  return format || has_known_name(path) ? format : ComplexFormat::by_head(head);
}

std::optional<ImageFormat> image_format(const fs::path& path, std::string_view head) {
  const auto format = ImageFormat::by_name(path);
  return format ? format : ImageFormat::by_head(head);
}

/// Returns true if there is a format and the file has its content. Some formats can have several kinds of content.
template <class Format>
bool holds(const std::optional<Format>& format, const fs::path& path, std::string_view head) {
  if (!format) return false;
  const auto holds_this = formats::sniffer_of(format->row()).holds_this;
  return holds_this == nullptr || holds_this(head, path);
}

}  // namespace

std::optional<MeshFormat> mesh_format_by_content(const fs::path& path, std::string_view head) {
  // The number of triangles in a binary STL file gives its size. A binary STL file has no other mark.
  if (volume_io::is_binary_stl(head, count_file_bytes(path))) return MeshFormat("STL");
  return MeshFormat::by_head(head);
}

FileContent content_of(const fs::path& path) {
  const std::string head = read_file_head(path);
  if (MeshFormat::by_name(path)) return FileContent::mesh;
  if (holds(ComplexFormat::by_name(path), path, head)) return FileContent::complex;
  if (holds(FieldFormat::by_name(path), path, head)) return FileContent::field;
  if (ImageFormat::by_name(path)) return FileContent::image;
  if (holds(ComplexFormat::by_head(head), path, head)) return FileContent::complex;
  if (holds(FieldFormat::by_head(head), path, head)) return FileContent::field;
  if (ImageFormat::by_head(head)) return FileContent::image;
  if (mesh_format_by_content(path, head)) return FileContent::mesh;
  std::string known;
  for (const auto& [content, what] :
       {std::pair{FileContent::mesh, "meshes are "}, std::pair{FileContent::image, "images "},
        std::pair{FileContent::field, "fields "},
        std::pair{FileContent::complex, "medial axes and other complexes "}}) {
    known += (known.empty() ? "; " : ", ") + std::string(what) + extension_list(content, FileAccess::read);
  }
  throw FileError("'" + path.string() + "' has no known format" + known);
}

bool holds_complex(const fs::path& path) {
  const std::string head = read_file_head(path);
  return holds(complex_format(path, head), path, head);
}

bool may_hold_field(const fs::path& path) {
  const FileContent content = content_of(path);
  if (content == FileContent::field) return true;
  return content == FileContent::image && file_extension(path) == ".nrrd" && holds_floats(read_file_head(path));
}

MeshFile read_mesh_of_any_name(const fs::path& path, const MeshReadOptions& options) {
  if (MeshFormat::by_name(path)) return read_mesh_file(path, options);
  const auto format = mesh_format_by_content(path, read_file_head(path));
  if (!format) return read_mesh_file(path, options);  // throws the appropriate error
  return read_mesh_file(read_whole_file(path).span(), *format, options, path.string());
}

ImageFile read_image_of_any_name(const fs::path& path) {
  if (ImageFormat::by_name(path)) return read_image_file(path);
  const auto format = ImageFormat::by_head(read_file_head(path));
  if (!format) return read_image_file(path);
  return read_image_file(read_whole_file(path).span(), *format, path.string());
}

std::string_view image_format_name(const fs::path& path) {
  const std::optional<ImageFormat> format = image_format(path, read_file_head(path));
  return format ? std::string_view(format->name()) : "unknown";
}

std::vector<fs::path> files_of_field(const fs::path& path, bool with_sites, int order) {
  using volume_io::BesideArray;
  std::vector<fs::path> files{path};
  if (file_extension(path) != ".nrrd") return files;
  for (const BesideArray array : volume_io::beside_arrays) {
    const bool is_there = (array != BesideArray::distance2 || order == 2) &&
                          (array != BesideArray::site || with_sites) &&
                          (array != BesideArray::site2 || (with_sites && order == 2));
    if (is_there) files.push_back(volume_io::beside_path(path, array));
  }
  return files;
}

std::optional<fs::path> sites_of_replaced_field(const fs::path& path) {
  using volume_io::BesideArray;
  if (file_extension(path) != ".nrrd" || !volume_io::has_own_beside(path, BesideArray::site)) return std::nullopt;
  return volume_io::beside_path(path, BesideArray::site);
}

std::vector<fs::path> second_of_replaced_field(const fs::path& path) {
  using volume_io::BesideArray;
  std::vector<fs::path> files;
  if (file_extension(path) != ".nrrd") return files;
  for (const BesideArray array : {BesideArray::distance2, BesideArray::site2}) {
    if (volume_io::has_own_beside(path, array)) files.push_back(volume_io::beside_path(path, array));
  }
  return files;
}

}  // namespace blum
