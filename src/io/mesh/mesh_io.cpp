#include "blum/io/mesh_io.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <new>
#include <numeric>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/io/formats.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/format_table.hpp"
#include "io/mesh/mesh_builder.hpp"

namespace blum {
namespace {

/// Returns the format for a path's extension. @throws FileError for an unknown extension.
MeshFormat format_named(const std::filesystem::path& path, FileAccess access) {
  const std::vector<std::string> known = file_extensions(FileContent::mesh, access);
  if (std::find(known.begin(), known.end(), file_extension(path)) != known.end()) return MeshFormat::of(path, access);
  throw FileError("unknown mesh format of '" + path.string() + "': its name must end in " +
                  extension_list(FileContent::mesh, access, ", "));
}

void apply_weld(MeshFile& file, const MeshReadOptions& options) {
  const bool wanted = options.weld.has_value() || file.info.format == MeshFormat("STL");
  if (!wanted) return;
  const std::size_t before = file.mesh.vertices.size();
  if (options.keeps_exact && options.weld.value_or(0) > 0) file.exact = weld(file.mesh, 0);
  file.mesh = weld(file.mesh, options.weld.value_or(0.0));
  file.info.welded = true;
  file.info.merged_vertices = before - file.mesh.vertices.size();
}

}  // namespace

MeshFile read_mesh_file(std::span<const std::byte> data, MeshFormat format, const MeshReadOptions& options,
                        std::string_view name) {
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data.data()), data.size());
    const auto read = formats::code_of(format).read;
    if (read == nullptr) throw InvalidOption(format.name() + " files are written, but not read");
    MeshFile file = read(bytes, name);
    file.info.format = format;
    apply_weld(file, options);
    return file;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to read '" + std::string(name) + "' of " + std::to_string(data.size()) +
                      " bytes");
  }
}

MeshFile read_mesh_file(const std::filesystem::path& path, const MeshReadOptions& options) {
  const MeshFormat format = format_named(path, FileAccess::read);
  const FileBytes content = read_whole_file(path);
  return read_mesh_file(content.span(), format, options, path.string());
}

TriangleMesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
  return read_mesh_file(path, options).mesh;
}

TriangleMesh read_mesh(std::span<const std::byte> data, MeshFormat format, const MeshReadOptions& options,
                       std::string_view name) {
  return read_mesh_file(data, format, options, name).mesh;
}

void write_mesh(const std::filesystem::path& path, const MeshView& mesh) {
  const MeshFormat format = format_named(path, FileAccess::write);
  validate(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!is_finite(mesh.vertices[i])) throw InvalidMesh("vertex " + std::to_string(i) + " is not finite");
  }
  formats::code_of(format).write(path, mesh);
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners, std::size_t where) {
  const std::size_t count = corners.size();
  if (count == 3) return add_triangle({corners[0], corners[1], corners[2]}, where);
  for (const std::uint32_t index : corners) note(index, where);
  polygons_.push_back({mesh_.triangles.size(), corners_.size(), count});
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  mesh_.triangles.resize(mesh_.triangles.size() + count - 2);
  extra_triangles_ += count - 3;
}

std::optional<MeshBuilder::BadIndex> MeshBuilder::bad_index() const {
  if (index_end_ <= mesh_.vertices.size()) return std::nullopt;
  return BadIndex{static_cast<std::uint32_t>(index_end_ - 1), index_where_};
}

MeshFile MeshBuilder::finish(bool binary) {
  MeshFile file;
  file.info.binary = binary;
  file.info.vertices = mesh_.vertices.size();
  file.info.faces = face_count();
  file.info.polygons = polygons_.size();
  const std::span<Triangle> triangles = mesh_.triangles;
  std::int64_t work_left = polygon_work;
  for (const Polygon& polygon : polygons_) {
    const bool proper = cut_polygon(
        mesh_.vertices, std::span<const std::uint32_t>(corners_).subspan(polygon.first_corner, polygon.corners),
        triangles.subspan(polygon.first_triangle, polygon.corners - 2), work_left);
    file.info.fan_polygons += proper ? 0 : 1;
  }
  if (mesh_.triangles.empty() && mesh_.segments.empty() && mesh_.points.empty()) {
    mesh_.points.resize(mesh_.vertices.size());
    std::iota(mesh_.points.begin(), mesh_.points.end(), 0U);
  }
  file.mesh = std::move(mesh_);
  return file;
}

}  // namespace blum
