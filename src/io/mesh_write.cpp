#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/mesh_io.hpp"
#include "io/row_writer.hpp"

namespace blum {
namespace {

[[noreturn]] void cannot_hold(const std::filesystem::path& path, MeshFormat format, std::string_view what) {
  throw FileError("cannot write '" + path.string() + "': " + std::string(to_string(format)) + " holds no " +
                  std::string(what) + "; write OBJ instead");
}

/// Refuses points, unless the mesh is a cloud of all its vertices, which a file without faces stands for.
void refuse_points(const std::filesystem::path& path, MeshFormat format, const MeshView& mesh) {
  if (mesh.points.empty()) return;
  if (!mesh.triangles.empty() || !mesh.segments.empty()) cannot_hold(path, format, "points beside other parts");
  std::vector<bool> named(mesh.vertices.size(), false);
  for (const std::uint32_t point : mesh.points) named[point] = true;
  if (std::find(named.begin(), named.end(), false) != named.end()) {
    cannot_hold(path, format, "vertices that are not part of a point cloud");
  }
}

void write_obj(const std::filesystem::path& path, const MeshView& mesh) {
  RowWriter out(path);
  for (const Vec3d& v : mesh.vertices) {
    out.text("v");
    out.vector(v);
    out.text("\n");
  }
  const auto write_all = [&](std::string_view keyword, const auto& items) {
    for (const auto& item : items) {
      out.text(keyword);
      for (const std::uint32_t index : item) out.number(std::uint64_t{index} + 1);
      out.text("\n");
    }
  };
  write_all("f", mesh.triangles);
  write_all("l", mesh.segments);
  for (const std::uint32_t index : mesh.points) {
    out.text("p");
    out.number(std::uint64_t{index} + 1);
    out.text("\n");
  }
  out.finish();
}

void write_off(const std::filesystem::path& path, const MeshView& mesh) {
  if (!mesh.segments.empty()) cannot_hold(path, MeshFormat::off, "segments");
  refuse_points(path, MeshFormat::off, mesh);
  RowWriter out(path);
  out.text("OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n");
  for (const Vec3d& v : mesh.vertices) {
    out.vector(v);
    out.text("\n");
  }
  for (const Triangle& t : mesh.triangles) {
    out.text("3");
    for (const std::uint32_t index : t) out.number(index);
    out.text("\n");
  }
  out.finish();
}

void write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  refuse_points(path, MeshFormat::ply, mesh);
  RowWriter out(path);
  out.text("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\n");
  if (!mesh.triangles.empty()) {
    out.text("element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n");
  }
  if (!mesh.segments.empty()) {
    out.text("element edge " + std::to_string(mesh.segments.size()) + "\nproperty int vertex1\nproperty int vertex2\n");
  }
  out.text("end_header\n");
  for (const Vec3d& v : mesh.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) out.bytes(v[axis]);
  }
  for (const Triangle& t : mesh.triangles) {
    out.bytes(std::uint8_t{3});
    for (const std::uint32_t index : t) out.bytes(index);
  }
  for (const Segment& s : mesh.segments) {
    for (const std::uint32_t index : s) out.bytes(index);
  }
  out.finish();
}

/// The unit normal of a triangle; zero when it has none.
Vec3d normal_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d u = b - a;
  const Vec3d v = c - a;
  const double size =
      std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z), std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(size > 0) || !std::isfinite(size)) return {};
  const Vec3d normal = cross(u / size, v / size);
  const double norm = length(normal);
  return norm > 0 ? normal / norm : Vec3d{};
}

void write_stl(const std::filesystem::path& path, const MeshView& mesh) {
  if (!mesh.segments.empty()) cannot_hold(path, MeshFormat::stl, "segments");
  if (!mesh.points.empty()) cannot_hold(path, MeshFormat::stl, "points");
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t index : t) {
      const Vec3d& v = mesh.vertices[index];
      if (std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= double{std::numeric_limits<float>::max()})
        continue;
      throw FileError("cannot write '" + path.string() + "': vertex " + std::to_string(index) +
                      " is too far from the origin for the single precision of STL; write PLY instead");
    }
  }
  RowWriter out(path);
  std::string header = "binary STL, single precision";  // must not begin with "solid", as text STL does
  header.resize(80, ' ');
  out.text(header);
  out.bytes(static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto write_vector = [&](const Vec3d& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) out.bytes(static_cast<float>(v[axis]));
  };
  for (const Triangle& t : mesh.triangles) {
    write_vector(normal_of(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
    for (const std::uint32_t index : t) write_vector(mesh.vertices[index]);
    out.bytes(std::uint16_t{0});
  }
  out.finish();
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const MeshView& mesh) {
  const auto format = mesh_format(path);
  if (!format) {
    throw FileError("cannot tell the mesh format of '" + path.string() +
                    "': its name must end in .obj, .off, .stl or .ply");
  }
  validate(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!is_finite(mesh.vertices[i])) throw InvalidMesh("vertex " + std::to_string(i) + " is not finite");
  }
  switch (*format) {
    case MeshFormat::obj:
      return write_obj(path, mesh);
    case MeshFormat::off:
      return write_off(path, mesh);
    case MeshFormat::stl:
      return write_stl(path, mesh);
    case MeshFormat::ply:
      return write_ply(path, mesh);
  }
}

}  // namespace blum
