// Blum: the sites of a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

enum class SiteKind : std::uint8_t { vertex, edge, face };

/// A vertex, an open edge or an open face of a mesh. `index` is the index among the sites of the same kind.
struct Site {
  SiteKind kind = SiteKind::vertex;
  std::uint32_t index = 0;
  [[nodiscard]] friend constexpr bool operator==(const Site&, const Site&) = default;
};

/// Sites of a mesh and their numbering, which depends on the mesh's connectivity alone.
///
/// With V vertices, E distinct edges and F triangles, site ids are:
///
///   [0, V)          the vertices, in the mesh's order. Vertices that no triangle, segment or point uses are
///                   never reported.
///   [V, V+E)        the distinct edges of triangles and segments, in rising order of (smaller, larger vertex).
///   [V+E, V+E+F)    the triangles, in the mesh's order.
///
/// Edges whose two ends are the same vertex are left out. Edges are distinguished by vertex index, not by position. If
/// parts of a mesh should share edges, weld the mesh first (see weld()).
class SiteTable {
 public:
  SiteTable() = default;
  /// Builds the table. The mesh must pass validate().
  /// Cost: O(V + F) time. The table takes 8 bytes per edge and 12 bytes per triangle, and twice that during
  /// construction.
  /// @throws InvalidMesh if V + E + F exceeds max_id_count.
  explicit SiteTable(const MeshView& mesh, const Context& context = {});

  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }
  [[nodiscard]] std::size_t face_count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t size() const { return vertex_count_ + edges_.size() + triangles_.size(); }

  [[nodiscard]] SiteId id(Site site) const;
  /// Returns the site of an id. @param id  below size().
  [[nodiscard]] Site site(SiteId id) const;
  /// Returns the indices of the one, two or three vertices of a site, padded with -1.
  [[nodiscard]] std::array<std::int32_t, 3> vertices(SiteId id) const;

  /// Returns the two vertices of each edge, the smaller vertex first. Edges are in rising order.
  [[nodiscard]] std::span<const Segment> edges() const { return edges_; }
  /// Returns the edge indices of each triangle. Entry k of a triangle is the edge between its corners k and (k+1) % 3;
  /// none() if these corners are the same vertex.
  [[nodiscard]] std::span<const std::array<EdgeId, 3>> triangle_edges() const { return triangle_edges_; }
  /// Returns the smallest index of a triangle that contains a site; none() if no triangle contains it.
  [[nodiscard]] TriangleId triangle(SiteId id) const;

 private:
  std::size_t vertex_count_ = 0;
  std::vector<Segment> edges_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<EdgeId, 3>> triangle_edges_;
  std::vector<TriangleId> edge_triangle_;
  std::vector<TriangleId> vertex_triangle_;
};

}  // namespace blum
