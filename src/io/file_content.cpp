#include "blum/io/file_content.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

#include "blum/io/image_io.hpp"
#include "io/bytes/whole_file.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"

namespace blum {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t head_size = 8192;

std::string read_head(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw FileError("'" + path.string() + "' is a folder, not a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError("'" + path.string() + "' cannot be opened: " + std::strerror(errno));
  std::string head(head_size, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return head;
}

/// Whether a NRRD header says that the values are floating-point numbers.
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

std::optional<ImageFormat> image_format(const fs::path& path, std::string_view head) {
  const auto format = ImageFormat::by_name(path);
  return format ? format : ImageFormat::by_head(head);
}

/// Whether a file of this format, where there is one, holds its content: some formats hold others, too.
template <class Format>
bool holds(const std::optional<Format>& format, const fs::path& path, std::string_view head) {
  if (!format) return false;
  const auto holds_this = formats::tells_of(format->row()).holds_this;
  return holds_this == nullptr || holds_this(head, path);
}

}  // namespace

FileContent content_of(const fs::path& path) {
  const std::string head = read_head(path);
  if (MeshFormat::by_name(path)) return FileContent::mesh;
  if (holds(ComplexFormat::by_name(path), path, head)) return FileContent::complex;
  if (holds(FieldFormat::by_name(path), path, head)) return FileContent::field;
  if (ImageFormat::by_name(path)) return FileContent::image;
  if (holds(FieldFormat::by_head(head), path, head)) return FileContent::field;
  if (ImageFormat::by_head(head)) return FileContent::image;
  if (MeshFormat::by_head(head)) return FileContent::mesh;
  std::string known;
  for (const auto& [content, what] :
       {std::pair{FileContent::mesh, "meshes are "}, std::pair{FileContent::image, "images "},
        std::pair{FileContent::field, "fields "},
        std::pair{FileContent::complex, "medial axes and other complexes "}}) {
    known += (known.empty() ? "; " : ", ") + std::string(what) + extension_list(content, FileAccess::read);
  }
  throw FileError("'" + path.string() + "' is of no known kind" + known);
}

bool holds_complex(const fs::path& path) {
  return holds(ComplexFormat::by_name(path), path, read_head(path));
}

bool may_hold_field(const fs::path& path) {
  const FileContent content = content_of(path);
  if (content == FileContent::field) return true;
  return content == FileContent::image && file_extension(path) == ".nrrd" && holds_floats(read_head(path));
}

MeshFile read_mesh_of_any_name(const fs::path& path, const MeshReadOptions& options) {
  if (MeshFormat::by_name(path)) return read_mesh_file(path, options);
  const auto format = MeshFormat::by_head(read_head(path));
  if (!format) return read_mesh_file(path, options);  // for its message
  return read_mesh_file(read_whole_file(path).span(), *format, options, path.string());
}

VoxelImage read_image_of_any_name(const fs::path& path) {
  if (ImageFormat::by_name(path)) return read_image(path);
  const auto format = ImageFormat::by_head(read_head(path));
  if (!format) return read_image(path);
  return read_image(read_whole_file(path).span(), *format, path.string());
}

std::string_view image_format_name(const fs::path& path) {
  const std::optional<ImageFormat> format = image_format(path, read_head(path));
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
