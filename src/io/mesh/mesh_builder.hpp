// Blum: shared functions of readers and writers of meshes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum {

/// Builder of a mesh for readers of files. Faces may use vertices that are added later. So indices are checked by
/// bad_index(), and polygons are cut by finish(), both after the last element.
class MeshBuilder {
 public:
  /// Vertex index that is too large, and the position of its face in the file.
  struct BadIndex {
    std::uint32_t index;
    std::size_t where;
  };

  /// @param where  any number by which the reader can find the face in the file again, for messages.
  void add_vertex(const Vec3d& vertex) { mesh_.vertices.push_back(vertex); }
  void add_triangle(const Triangle& corners, std::size_t where) {
    for (const std::uint32_t index : corners) note(index, where);
    mesh_.triangles.push_back(corners);
  }
  /// Adds a face of at least three corners.
  void add_face(std::span<const std::uint32_t> corners, std::size_t where);
  void add_segment(std::uint32_t a, std::uint32_t b, std::size_t where) {
    note(a, where);
    note(b, where);
    mesh_.segments.push_back({a, b});
  }
  void add_point(std::uint32_t index, std::size_t where) {
    note(index, where);
    mesh_.points.push_back(index);
  }

  void reserve_vertices(std::size_t count) { mesh_.vertices.reserve(count); }
  void reserve_triangles(std::size_t count) { mesh_.triangles.reserve(count); }
  [[nodiscard]] std::size_t vertex_count() const { return mesh_.vertices.size(); }
  [[nodiscard]] std::size_t face_count() const { return mesh_.triangles.size() - extra_triangles_; }

  /// If the largest index is out of range, returns it. Must be called before finish().
  [[nodiscard]] std::optional<BadIndex> bad_index() const;
  /// Cuts polygons into triangles, and applies the rule for point clouds. All indices must be in range.
  [[nodiscard]] MeshFile finish(bool binary);

 private:
  struct Polygon {
    std::size_t first_triangle;  ///< the polygon has (corners - 2) entries in mesh_.triangles; this is the first
    std::size_t first_corner;    ///< index of its first corner in corners_
    std::size_t corners;
  };

  void note(std::uint32_t index, std::size_t where) {
    if (index >= index_end_) {
      index_end_ = std::size_t{index} + 1;
      index_where_ = where;
    }
  }

  TriangleMesh mesh_;
  std::vector<Polygon> polygons_;
  std::vector<std::uint32_t> corners_;
  std::size_t extra_triangles_ = 0;  ///< sum over polygons of their triangles, not counting the first of each
  std::size_t index_end_ = 0;        ///< largest index + 1
  std::size_t index_where_ = 0;
};

/// Cuts a polygon with at least 4 corners into corners - 2 triangles with the polygon's orientation. read_mesh
/// documents the rule.
/// @param corners    vertex indices, all in range.
/// @param triangles  receives corners.size() - 2 triangles.
/// @param work_left  steps allowed in addition to polygon_work_per_corner for each corner; receives the number left.
/// @returns false if no proper cut was found; the triangles are then a fan.
bool cut_polygon(std::span<const Vec3d> vertices, std::span<const std::uint32_t> corners, std::span<Triangle> triangles,
                 std::int64_t& work_left);

/// Number of steps that each corner of a non-convex polygon adds to the limit for cutting polygons. A step examines one
/// corner or one group of corners. Usual polygons of any size need a few dozen steps per corner.
inline constexpr std::int64_t polygon_work_per_corner = 500;
/// Number of further steps that each file may take. These steps take about a second.
inline constexpr std::int64_t polygon_work = 200'000'000;

/// @throws FileError whose message states that files of this format cannot contain `what`.
[[noreturn]] void cannot_hold(const std::filesystem::path& path, std::string_view format, std::string_view what);

/// Throws if the mesh has points, unless it is a cloud of all its vertices. A file without faces represents such a
/// cloud.
void refuse_points(const std::filesystem::path& path, std::string_view format, const MeshView& mesh);

}  // namespace blum
