// Blum: triangle meshes and views of them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Vertex indices of a triangle, counter-clockwise seen from outside where the mesh bounds a solid.
using Triangle = std::array<std::uint32_t, 3>;
/// Vertex indices of a line segment.
using Segment = std::array<std::uint32_t, 2>;

/// Any set of triangles, segments and points over shared vertices, seen through spans: nothing is copied or owned.
///
/// Nothing is assumed of it: triangles may intersect, repeat, degenerate, leave holes. Vertices that no triangle,
/// segment or point names are not part of the shape and are ignored everywhere.
struct MeshView {
  std::span<const Vec3d> vertices = {};
  std::span<const Triangle> triangles = {};
  std::span<const Segment> segments = {};
  /// Vertices that are part of the shape by themselves (all of them, for a point cloud).
  std::span<const std::uint32_t> points = {};
};

/// Owns what a MeshView shows.
struct TriangleMesh {
  std::vector<Vec3d> vertices = {};
  std::vector<Triangle> triangles = {};
  std::vector<Segment> segments = {};
  std::vector<std::uint32_t> points = {};

  [[nodiscard]] MeshView view() const { return {vertices, triangles, segments, points}; }
  operator MeshView() const { return view(); }  // NOLINT(google-explicit-constructor): a mesh is its view
};

/// A mesh of its own with what a view shows.
[[nodiscard]] TriangleMesh copy_of(const MeshView& mesh);

/// Calls visit(vertex) for each corner of each triangle, each end of each segment and each point, in this order: a
/// vertex as often as it is named.
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

/// Where the corners of a triangle of a mesh are.
[[nodiscard]] inline std::array<Vec3d, 3> triangle_corners(const MeshView& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

/// The triangles of a mesh, each turned to face the other way.
[[nodiscard]] std::vector<Triangle> reversed_triangles(std::span<const Triangle> triangles);

/// The box around all vertices that a triangle, segment or point names; empty where there are none.
[[nodiscard]] Box3 bounds(const MeshView& mesh);

/// Checks what every algorithm needs: at least one triangle, segment or point; indices in range; counts that fit ids;
/// finite coordinates (of named vertices), of magnitude at most 1e150 so that squares stay finite.
/// @throws InvalidMesh naming the first offender.
void validate(const MeshView& mesh);

}  // namespace blum
