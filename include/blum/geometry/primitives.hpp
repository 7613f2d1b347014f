// Blum: the vertices of primitives and of their features. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "blum/geometry/triangle_distance.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Returns the number of primitives of a mesh. Primitives are its triangles, then its segments, then its points.
[[nodiscard]] inline std::size_t primitive_count(const MeshView& mesh) {
  return mesh.triangles.size() + mesh.segments.size() + mesh.points.size();
}

/// Returns the vertices of a primitive of a mesh as corners of a triangle. A segment a, b becomes a, b, b. A point a
/// becomes a, a, a. @param primitive  below primitive_count(mesh).
[[nodiscard]] inline Triangle primitive_vertices(const MeshView& mesh, std::uint32_t primitive) {
  std::size_t k = primitive;
  if (k < mesh.triangles.size()) return mesh.triangles[k];
  k -= mesh.triangles.size();
  if (k < mesh.segments.size()) return {mesh.segments[k][0], mesh.segments[k][1], mesh.segments[k][1]};
  const std::uint32_t v = mesh.points[k - mesh.segments.size()];
  return {v, v, v};
}

/// Returns the indices of the one, two or three vertices of a feature of a triangle, padded with -1, as in files. The
/// smaller vertex of an edge is first. The vertices of a face are in the order of the triangle's corners. If the
/// triangle has the same vertex at two corners, this vertex is listed once.
[[nodiscard]] inline std::array<std::int32_t, 3> feature_vertices(const Triangle& triangle,
                                                                  const TriangleFeature& feature) {
  const std::size_t count = feature.kind == SiteKind::vertex ? 1 : feature.kind == SiteKind::edge ? 2 : 3;
  std::array<std::int32_t, 3> out{-1, -1, -1};
  std::size_t size = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto vertex = static_cast<std::int32_t>(triangle[(feature.index + k) % 3]);
    if (std::find(out.begin(), out.end(), vertex) == out.end()) out[size++] = vertex;
  }
  if (size == 2 && out[0] > out[1]) std::swap(out[0], out[1]);
  return out;
}

}  // namespace blum
