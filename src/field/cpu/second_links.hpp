// Blum: the link of each vertex: the edges and points opposite to it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/cpu/adjacency.hpp"

namespace blum::cpu {

/// Edge with its ends in the normalised frame, or a point (tangent and length are zero).
struct LinkSegment {
  Vec3f middle;
  Vec3f tangent;  ///< unit vector; zero for a point
  float half_length = 0;
  std::uint32_t id = 0;     ///< SiteId of the open edge, without its ends.
  std::uint32_t start = 0;  ///< Vertex at middle - tangent * half_length. Its id is below that of the other end.
  std::uint32_t end = 0;
};

/// Links of all vertices. A vertex's link consists of the edges opposite to it in its triangles, and of the other ends
/// of its edges. An end is listed only if the opposite edges may not represent it.
///
/// The second order excludes every site that touches a vertex of the first site, which leaves a hole in the surface.
/// Planes from excluded sites bound the domains of the sites along this hole. So the sites along the hole must be
/// evaluated without such planes. The sites along the hole lie in the links of the first site's vertices.
struct SecondLinks {
  /// First the segments of all edges, in their order, then all vertices, as points.
  Buffer<LinkSegment> segments;
  /// Segment and its ends.
  struct Entry {
    std::uint32_t segment = 0;
    std::uint32_t start = 0;
    std::uint32_t end = 0;
  };
  /// Segments of vertex v: entries[first[v] .. first[v + 1]).
  std::vector<std::uint32_t> first;
  std::vector<Entry> entries;

  [[nodiscard]] std::span<const Entry> of(std::uint32_t vertex) const {
    return std::span(entries).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
};

/// Builds the entries. Entries depend only on connectivity, so they stay valid while the mesh deforms.
void build_link_entries(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        const Context& context, SecondLinks& out);
/// Builds the segments.
/// @param positions  of all vertices, in the normalised frame.
void build_link_segments(const MeshView& mesh, const SiteTable& sites, std::span<const Vec3d> positions,
                         const Context& context, SecondLinks& out);

}  // namespace blum::cpu
