// Blum: triangle meshes and views of them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Vertex indices of a triangle. If the mesh bounds a solid, they are counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;
/// Vertex indices of a line segment.
using Segment = std::array<std::uint32_t, 2>;

/// View of any set of triangles, segments and points over shared vertices, through spans. It copies and owns nothing.
///
/// Nothing is assumed about the mesh: triangles may intersect, be repeated or degenerate, and leave holes. Vertices
/// that no triangle, segment or point uses are not part of the shape, and are ignored.
struct MeshView {
  std::span<const Vec3d> vertices = {};
  std::span<const Triangle> triangles = {};
  std::span<const Segment> segments = {};
  /// Indices of vertices that are part of the shape by themselves. For a point cloud, these are all vertices.
  std::span<const std::uint32_t> points = {};
};

/// Mesh that owns its data; see MeshView.
struct TriangleMesh {
  std::vector<Vec3d> vertices = {};
  std::vector<Triangle> triangles = {};
  std::vector<Segment> segments = {};
  std::vector<std::uint32_t> points = {};

  [[nodiscard]] MeshView view() const { return {vertices, triangles, segments, points}; }
  operator MeshView() const { return view(); }  // NOLINT(google-explicit-constructor): a mesh is its view
};

/// Returns a deep copy of a view.
[[nodiscard]] TriangleMesh copy_of(const MeshView& mesh);

/// Calls visit(vertex) for each corner of each triangle, then each end of each segment, then each point. A vertex is
/// visited once for each use.
template <class Visit>
void for_each_named_vertex(const MeshView& mesh, Visit visit) {
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) visit(v);
  }
  for (const Segment& segment : mesh.segments) {
    for (const std::uint32_t v : segment) visit(v);
  }
  for (const std::uint32_t v : mesh.points) visit(v);
}

/// Returns the positions of the corners of a triangle of a mesh.
[[nodiscard]] inline std::array<Vec3d, 3> triangle_corners(const MeshView& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

/// Returns the given triangles, each reversed so that it faces in the opposite direction.
[[nodiscard]] std::vector<Triangle> reversed_triangles(std::span<const Triangle> triangles);

/// Returns the box around all vertices that a triangle, segment or point uses. If there are no such vertices, the box
/// is empty.
[[nodiscard]] Box3 bounds(const MeshView& mesh);

/// Checks the conditions that every algorithm needs. At least one triangle, segment or point must exist. Indices must
/// be in range. The numbers of vertices, triangles and segments must be at most max_id_count. Coordinates of used
/// vertices must be finite, and of magnitude at most 1e150 so that their squares are finite.
/// @throws InvalidMesh with the index of the first element that breaks a condition.
void validate(const MeshView& mesh);

}  // namespace blum
