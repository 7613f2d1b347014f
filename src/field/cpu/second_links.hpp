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

/// Closed edge in the normalised frame, or a point (no tangent, no length).
struct LinkSegment {
  Vec3f middle;
  Vec3f tangent;  ///< unit
  float half_length = 0;
  std::uint32_t id = 0;     ///< SiteId of the part between the ends.
  std::uint32_t start = 0;  ///< Vertex at middle - tangent * half_length; its id is below that of the other end.
  std::uint32_t end = 0;
};

/// Link of every vertex: the edges opposite to it in its triangles, and other ends of its edges. The latter are listed
/// only if those opposite edges may not stand for them.
///
/// The second order leaves out every site that touches a vertex of the first site. Sites along this hole then have
/// planes from sites that are left out, so they must be evaluated without these planes. They lie in the links of the
/// first site's vertices.
struct SecondLinks {
  /// Segments of the edges, in their order, then of the vertices, as points.
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

/// Builds the entries. They depend on connectivity alone, so that a deforming mesh keeps them.
void build_link_entries(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        const Context& context, SecondLinks& out);
/// Builds the segments.
/// @param positions  of all vertices, in the normalised frame.
void build_link_segments(const MeshView& mesh, const SiteTable& sites, std::span<const Vec3d> positions,
                         const Context& context, SecondLinks& out);

}  // namespace blum::cpu
