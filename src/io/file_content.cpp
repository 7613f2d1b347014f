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
#include "io/field_files.hpp"
#include "io/whole_file.hpp"

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

/// The last bytes of a file: of a zip archive, where it tells what is in it.
std::string read_tail(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  std::string tail(std::min(head_size, static_cast<std::size_t>(std::max<std::streamoff>(size, 0))), '\0');
  file.seekg(size - static_cast<std::streamoff>(tail.size()));
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  return tail;
}

bool is_field_header(std::string_view head) {
  return head.substr(0, head.find("\n\n")).find("sign_rule:=") != std::string_view::npos;
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
  auto place = format_by_name(FileContent::image, path);
  if (!place) place = format_by_head(FileContent::image, head);
  return place ? std::optional(static_cast<ImageFormat>(*place)) : std::nullopt;
}

}  // namespace

FileContent content_of(const fs::path& path) {
  const std::string head = read_head(path);
  if (format_by_name(FileContent::mesh, path)) return FileContent::mesh;
  if (format_by_name(FileContent::complex, path) && holds_complex(path)) return FileContent::complex;
  const std::optional<ImageFormat> format = image_format(path, head);
  if (format == ImageFormat::nrrd) return is_field_header(head) ? FileContent::field : FileContent::image;
  if (format_by_name(FileContent::field, path)) return FileContent::field;
  if (format) return FileContent::image;
  if (format_by_head(FileContent::mesh, head)) return FileContent::mesh;
  throw FileError("'" + path.string() + "' is of no known kind; meshes are " +
                  extension_list(FileContent::mesh, FileAccess::read) + " files, images " +
                  extension_list(FileContent::image, FileAccess::read));
}

bool holds_complex(const fs::path& path) {
  const std::string head = read_head(path);
  const std::string end = file_extension(path);
  if (end == ".vtp" || end == ".ma") return true;
  if (end == ".npz") {
    const std::string tail = read_tail(path);
    return tail.find("vertices.npy") != std::string::npos && tail.find("distance.npy") == std::string::npos;
  }
  const std::string_view header = std::string_view(head).substr(0, head.find("end_header"));
  return end == ".ply" && header.find(R"(comment blum {"content": "medial axis"})") != std::string_view::npos;
}

bool may_hold_field(const fs::path& path) {
  const FileContent content = content_of(path);
  if (content == FileContent::field) return true;
  return content == FileContent::image && file_extension(path) == ".nrrd" && holds_floats(read_head(path));
}

MeshFile read_mesh_of_any_name(const fs::path& path, const MeshReadOptions& options) {
  if (format_by_name(FileContent::mesh, path)) return read_mesh_file(path, options);
  const auto place = format_by_head(FileContent::mesh, read_head(path));
  if (!place) return read_mesh_file(path, options);  // for its message
  return read_mesh_file(read_whole_file(path).span(), static_cast<MeshFormat>(*place), options, path.string());
}

VoxelImage read_image_of_any_name(const fs::path& path) {
  if (format_by_name(FileContent::image, path)) return read_image(path);
  const auto place = format_by_head(FileContent::image, read_head(path));
  if (!place) return read_image(path);
  return read_image(read_whole_file(path).span(), static_cast<ImageFormat>(*place), path.string());
}

std::string_view image_format_name(const fs::path& path) {
  const std::optional<ImageFormat> format = image_format(path, read_head(path));
  return format ? format_name(FileContent::image, static_cast<std::size_t>(*format)) : "unknown";
}

std::vector<fs::path> files_of_field(const fs::path& path) {
  if (file_extension(path) != ".nrrd") return {path};
  return {path, volume_io::site_path(path)};
}

}  // namespace blum
