// Blum: what borders on the surroundings of each vertex. SPDX-License-Identifier: Apache-2.0
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

/// A closed edge in the normalised frame, or a point (no tangent, no length).
struct LinkSegment {
  Vec3f middle;
  Vec3f tangent;  ///< unit
  float half_length = 0;
  std::uint32_t id = 0;     ///< SiteId of what lies between the ends
  std::uint32_t start = 0;  ///< vertex at middle - tangent * half_length; its id is below that of the other end
  std::uint32_t end = 0;
};

/// The link of every vertex: the edges opposite to it in its triangles, and the other ends of its edges where these
/// edges may not stand for them. With a site, all that touches its vertices is left out of the second order; then the
/// planes that bound the domains of what remains along the hole come from sites that are gone, and what remains there
/// is looked at without them. It lies in the links of the site's vertices.
struct SecondLinks {
  /// Of the edges, in their order, then of the vertices, as points.
  Buffer<LinkSegment> segments;
  /// A segment and its ends.
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

/// Depends on connectivity alone, so that a deforming mesh keeps it.
void build_link_entries(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        const Context& context, SecondLinks& out);
/// @param positions  of all vertices, in the normalised frame.
void build_link_segments(const MeshView& mesh, const SiteTable& sites, std::span<const Vec3d> positions,
                         const Context& context, SecondLinks& out);

}  // namespace blum::cpu
