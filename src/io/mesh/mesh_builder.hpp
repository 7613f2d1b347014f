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

/// Builder of a mesh while a file is read. Vertices may follow the faces that name them. Indices are therefore checked
/// by bad_index(), and polygons cut by finish(), after the last element.
class MeshBuilder {
 public:
  /// Vertex index that is too large, and its place in the file.
  struct BadIndex {
    std::uint32_t index;
    std::size_t where;
  };

  /// @param where  any number from which the reader finds the place in the file again, for messages.
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

  /// Returns the largest index if it is out of range. Call it before finish().
  [[nodiscard]] std::optional<BadIndex> bad_index() const;
  /// Cuts the polygons and applies the rule for point clouds. All indices must be in range.
  [[nodiscard]] MeshFile finish(bool binary);

 private:
  struct Polygon {
    std::size_t first_triangle;  ///< the first of its (corners - 2) entries in mesh_.triangles
    std::size_t first_corner;    ///< in corners_
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
  std::size_t extra_triangles_ = 0;  ///< triangles beyond the first of each polygon
  std::size_t index_end_ = 0;        ///< one more than the largest index
  std::size_t index_where_ = 0;
};

/// Cuts a polygon of at least 4 corners into corners - 2 triangles with the same orientation. read_mesh documents the
/// rule.
/// @param corners    vertex indices, in range.
/// @param triangles  receives the triangles: corners.size() - 2 entries.
/// @param work_left  steps allowed beyond polygon_work_per_corner for each corner; receives the number left.
/// @returns false if the triangles are a fan because no proper cut was found.
bool cut_polygon(std::span<const Vec3d> vertices, std::span<const std::uint32_t> corners, std::span<Triangle> triangles,
                 std::int64_t& work_left);

/// Largest number of steps of cutting: for each corner, and beyond that for a file. The latter takes about a second. A
/// step looks at a corner or a group of corners. Usual polygons need a few dozen steps a corner, whatever their size.
inline constexpr std::int64_t polygon_work_per_corner = 500;
inline constexpr std::int64_t polygon_work = 200'000'000;

/// @throws FileError saying that files of this format hold no `what`.
[[noreturn]] void cannot_hold(const std::filesystem::path& path, std::string_view format, std::string_view what);

/// Refuses points, unless the mesh is a cloud of all its vertices. A file without faces represents such a cloud.
void refuse_points(const std::filesystem::path& path, std::string_view format, const MeshView& mesh);

}  // namespace blum
