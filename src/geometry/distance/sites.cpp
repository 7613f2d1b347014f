#include "blum/geometry/sites.hpp"

#include <algorithm>
#include <string>

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// One use of an edge: its larger vertex, and its source. The source is 3 * triangle + corner for triangles, and 3 * F
/// + segment for segments, where F is the number of triangles.
struct EdgeUse {
  std::uint32_t larger = 0;
  std::uint32_t source = 0;
};

}  // namespace

SiteTable::SiteTable(const MeshView& mesh, const Context& context)
    : vertex_count_(mesh.vertices.size()), triangles_(mesh.triangles.begin(), mesh.triangles.end()) {
  const std::size_t face_count = mesh.triangles.size();
  if (3 * face_count + mesh.segments.size() > std::size_t{0xffffffff}) {
    throw InvalidMesh("the mesh has " + std::to_string(face_count) +
                      " triangles, so it may have more than 2^32 - 1 edges, the limit for ids");
  }
  // Sorts the uses into buckets by smaller vertex, then sorts each short bucket. This takes linear time if vertices
  // have a bounded number of edges.
  std::vector<std::uint32_t> start(vertex_count_ + 1, 0);
  const auto for_each_use = [&](auto visit) {
    for (std::size_t t = 0; t < face_count; ++t) {
      const Triangle& triangle = mesh.triangles[t];
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangle[k];
        const std::uint32_t b = triangle[k == 2 ? 0 : k + 1];
        if (a != b) visit(std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(3 * t + k));
      }
    }
    for (std::size_t s = 0; s < mesh.segments.size(); ++s) {
      const auto [a, b] = mesh.segments[s];
      if (a != b) visit(std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(3 * face_count + s));
    }
  };
  for_each_use([&](std::uint32_t smaller, std::uint32_t, std::uint32_t) { ++start[smaller + 1]; });
  for (std::size_t v = 0; v < vertex_count_; ++v) start[v + 1] += start[v];
  std::vector<EdgeUse> uses(start[vertex_count_]);
  {
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for_each_use([&](std::uint32_t smaller, std::uint32_t larger, std::uint32_t source) {
      uses[next[smaller]++] = {larger, source};
    });
  }
  throw_if_cancelled(context);

  triangle_edges_.assign(face_count, {});
  edges_.reserve(uses.size() / 2 + 16);
  for (std::size_t v = 0; v < vertex_count_; ++v) {
    const auto begin = uses.begin() + start[v];
    const auto end = uses.begin() + start[v + 1];
    std::sort(begin, end, [](const EdgeUse& a, const EdgeUse& b) {
      return a.larger != b.larger ? a.larger < b.larger : a.source < b.source;
    });
    for (auto use = begin; use != end; ++use) {
      const bool is_first = use == begin || use->larger != (use - 1)->larger;
      if (is_first) {
        edges_.push_back({static_cast<std::uint32_t>(v), use->larger});
        edge_triangle_.push_back(use->source < 3 * face_count ? TriangleId(use->source / 3) : TriangleId::none());
      }
      if (use->source < 3 * face_count) {
        triangle_edges_[use->source / 3][use->source % 3] = EdgeId(static_cast<std::uint32_t>(edges_.size() - 1));
      }
    }
  }
  if (size() > max_id_count) {
    throw InvalidMesh("the mesh has " + std::to_string(size()) + " sites, but the limit for ids is 2^31 - 1");
  }
  vertex_triangle_.assign(vertex_count_, TriangleId::none());
  for (std::size_t t = face_count; t-- > 0;) {
    for (const std::uint32_t v : mesh.triangles[t]) vertex_triangle_[v] = TriangleId(static_cast<std::uint32_t>(t));
  }
}

SiteId SiteTable::id(Site site) const {
  const std::size_t base = site.kind == SiteKind::vertex ? 0
                           : site.kind == SiteKind::edge ? vertex_count_
                                                         : vertex_count_ + edges_.size();
  return SiteId(static_cast<std::uint32_t>(base + site.index));
}

Site SiteTable::site(SiteId id) const {
  if (id.value < vertex_count_) return {SiteKind::vertex, id.value};
  const std::size_t rest = id.value - vertex_count_;
  if (rest < edges_.size()) return {SiteKind::edge, static_cast<std::uint32_t>(rest)};
  return {SiteKind::face, static_cast<std::uint32_t>(rest - edges_.size())};
}

std::array<std::int32_t, 3> SiteTable::vertices(SiteId id) const {
  const Site s = site(id);
  const auto as_signed = [](std::uint32_t v) { return static_cast<std::int32_t>(v); };
  if (s.kind == SiteKind::vertex) return {as_signed(s.index), -1, -1};
  if (s.kind == SiteKind::edge) return {as_signed(edges_[s.index][0]), as_signed(edges_[s.index][1]), -1};
  const Triangle& t = triangles_[s.index];
  return {as_signed(t[0]), as_signed(t[1]), as_signed(t[2])};
}

TriangleId SiteTable::triangle(SiteId id) const {
  const Site s = site(id);
  if (s.kind == SiteKind::vertex) return vertex_triangle_[s.index];
  if (s.kind == SiteKind::edge) return edge_triangle_[s.index];
  return TriangleId(s.index);
}

}  // namespace blum
