#include "blum/geometry/topology.hpp"

#include <algorithm>
#include <cmath>

#include "blum/core/union_find.hpp"
#include "blum/geometry/orient2d.hpp"
#include "geometry/topology/shells.hpp"

namespace blum {
namespace {

using detail::EdgeTally;
using detail::names_vertex_twice;
using detail::no_component;
using detail::ShellSet;
using detail::SurfaceComponents;
using detail::UnionFind;

struct EdgeCounts {
  std::size_t boundary = 0;
  std::size_t nonmanifold = 0;
  std::size_t inconsistent = 0;
  std::size_t used = 0;

  explicit EdgeCounts(const std::vector<EdgeTally>& edges) {
    for (const EdgeTally& edge : edges) {
      used += edge.count > 0 ? 1 : 0;
      boundary += edge.count == 1 ? 1 : 0;
      nonmanifold += edge.count > 2 ? 1 : 0;
      inconsistent += edge.count == 2 && edge.balance != 0 ? 1 : 0;
    }
  }
  [[nodiscard]] bool is_closed() const { return used > 0 && boundary == 0 && nonmanifold == 0; }
};

bool all_face_outwards(const ShellSet& set) {
  return std::all_of(set.shells.begin(), set.shells.end(), [](const Shell& s) { return s.faces_outwards; });
}

/// Returns true if the corners are exactly collinear.
bool is_flat(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  if (squared_length(cross(ab, ac)) > 1e-24 * squared_length(ab) * squared_length(ac)) return false;
  return detail::orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
         detail::orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         detail::orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

/// For each edge, the triangle sides that use it, as 3 * triangle + corner.
struct EdgeUses {
  std::vector<std::uint32_t> start;
  std::vector<std::uint32_t> uses;

  EdgeUses(const MeshView& mesh, const SiteTable& sites, const std::vector<EdgeTally>& edges)
      : start(edges.size() + 1, 0) {
    for (std::size_t e = 0; e < edges.size(); ++e) start[e + 1] = start[e] + edges[e].count;
    uses.resize(start.back());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (names_vertex_twice(mesh.triangles[t])) continue;
      for (std::uint32_t k = 0; k < 3; ++k) uses[next[sites.triangle_edges()[t][k].value]++] = 3 * t + k;
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t edge) const {
    return {uses.data() + start[edge], uses.data() + start[edge + 1]};
  }
};

std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// Fans: sets of triangle corners at one vertex that are connected through edges with two triangles.
class Fans {
 public:
  Fans(const MeshView& mesh, const EdgeUses& edges) : mesh_(mesh), sets_(3 * mesh.triangles.size()) {
    for (std::size_t e = 0; e + 1 < edges.start.size(); ++e) {
      const auto uses = edges.of(e);
      if (uses.size() == 2) join_across(uses[0], uses[1]);
    }
  }
  [[nodiscard]] bool is_first(std::uint32_t corner) { return sets_.find(corner) == corner; }

  /// Returns the number of closed chains of boundary edges. Chains are followed around fans. Destroys the fans.
  [[nodiscard]] std::size_t count_boundary_loops(const EdgeUses& edges) {
    std::vector<std::uint32_t> ends;
    for (std::size_t e = 0; e + 1 < edges.start.size(); ++e) {
      const auto uses = edges.of(e);
      if (uses.size() != 1) continue;
      sets_.join(uses[0], next_corner(uses[0]));
      ends.push_back(uses[0]);
    }
    for (std::uint32_t& corner : ends) corner = sets_.find(corner);
    std::sort(ends.begin(), ends.end());
    return static_cast<std::size_t>(std::unique(ends.begin(), ends.end()) - ends.begin());
  }

 private:
  void join_across(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t a_next = next_corner(a);
    const std::uint32_t b_next = next_corner(b);
    if (vertex(a) == vertex(b)) {  // both traverse the edge in the same direction
      sets_.join(a, b);
      sets_.join(a_next, b_next);
    } else {
      sets_.join(a, b_next);
      sets_.join(a_next, b);
    }
  }
  [[nodiscard]] std::uint32_t vertex(std::uint32_t corner) const { return mesh_.triangles[corner / 3][corner % 3]; }

  const MeshView& mesh_;
  UnionFind sets_;
};

/// Counts triangles that have the same vertices as an earlier triangle. Such triangles share all three edges. So, for
/// each edge, copies are only searched among the triangles that have this edge as their smallest edge.
std::size_t count_duplicates(const MeshView& mesh, const SiteTable& sites, const EdgeUses& edges) {
  std::size_t duplicates = 0;
  std::vector<std::uint32_t> opposite;
  for (std::uint32_t e = 0; e + 1 < edges.start.size(); ++e) {
    const auto uses = edges.of(e);
    if (uses.size() < 2) continue;
    opposite.clear();
    for (const std::uint32_t use : uses) {
      const auto& triangle = sites.triangle_edges()[use / 3];
      const bool is_smallest = e <= triangle[0].value && e <= triangle[1].value && e <= triangle[2].value;
      if (is_smallest) opposite.push_back(mesh.triangles[use / 3][(use % 3 + 2) % 3]);
    }
    if (opposite.size() < 2) continue;
    std::sort(opposite.begin(), opposite.end());
    const auto distinct = std::unique(opposite.begin(), opposite.end()) - opposite.begin();
    duplicates += opposite.size() - static_cast<std::size_t>(distinct);
  }
  return duplicates;
}

void count_pieces(const MeshView& mesh, Topology& result) {
  UnionFind sets(mesh.vertices.size());
  std::vector<bool> is_named(mesh.vertices.size(), false);
  for_each_named_vertex(mesh, [&](std::uint32_t v) { is_named[v] = true; });
  for (const Triangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[1], t[2]);
  }
  for (const Segment& s : mesh.segments) sets.join(s[0], s[1]);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_named[v]) continue;
    ++result.named_vertices;
    if (sets.find(v) == v) ++result.pieces;
  }
}

/// Counts degenerate triangles, and sums the areas of all triangles.
void measure_triangles(const MeshView& mesh, Topology& result) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.vertices[t[0]];
    const Vec3d& b = mesh.vertices[t[1]];
    const Vec3d& c = mesh.vertices[t[2]];
    if (names_vertex_twice(t) || is_flat(a, b, c)) ++result.degenerate_triangles;
    result.area += 0.5 * length(cross(b - a, c - a));
  }
}

/// Counts vertices with more than one fan. Computes the Euler characteristics of the mesh and of its shells.
void count_fans(const MeshView& mesh, const EdgeCounts& edges, Fans& fans, const ShellSet& set, Topology& result) {
  std::vector<std::uint32_t> fans_of(mesh.vertices.size(), 0);
  std::vector<std::int64_t> fans_in(set.shells.size(), 0);
  std::int64_t triangles = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (names_vertex_twice(mesh.triangles[t])) continue;
    ++triangles;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (!fans.is_first(3 * t + k)) continue;
      ++fans_of[mesh.triangles[t][k]];
      if (set.of_triangle[t] != no_component) ++fans_in[set.of_triangle[t]];
    }
  }
  std::int64_t vertices = 0;
  for (const std::uint32_t count : fans_of) {
    vertices += count > 0 ? 1 : 0;
    result.nonmanifold_vertices += count > 1 ? 1 : 0;
  }
  result.euler_characteristic = vertices - static_cast<std::int64_t>(edges.used) + triangles;
  for (std::size_t s = 0; s < result.shells.size(); ++s) {
    Shell& shell = result.shells[s];
    shell.euler_characteristic = fans_in[s] - static_cast<std::int64_t>(shell.triangles / 2);  // 3 F / 2 edges
    shell.genus = 1 - shell.euler_characteristic / 2;
  }
}

std::array<std::int64_t, 3> betti_of(const std::vector<Shell>& shells) {
  std::array<std::int64_t, 3> betti{0, 0, 0};
  for (const Shell& shell : shells) {
    ++betti[shell.depth % 2 == 0 ? 0 : 2];
    betti[1] += shell.genus;
  }
  return betti;
}

}  // namespace

Orientation orientation(const MeshView& mesh, const SiteTable& sites) {
  const std::vector<EdgeTally> edges = detail::tally_edges(mesh, sites);
  const EdgeCounts counts(edges);
  Orientation result;
  result.closed = counts.is_closed();
  result.oriented = counts.inconsistent == 0;
  result.boundary_edges = counts.boundary;
  result.nonmanifold_edges = counts.nonmanifold;
  result.inconsistent_edges = counts.inconsistent;
  const SurfaceComponents components = detail::find_components(mesh, sites, edges);
  result.components = components.count;
  if (!result.closed || !result.oriented) return result;
  const ShellSet set = detail::find_shells(mesh, components, {});
  result.outward = all_face_outwards(set);
  for (const Shell& shell : set.shells) result.signed_volume += shell.signed_volume;
  return result;
}

Topology topology(const MeshView& mesh, const Context& context) {
  validate(mesh);
  return topology(mesh, SiteTable(mesh, context), context);
}

Topology topology(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  validate(mesh);
  Topology result;
  result.vertices = mesh.vertices.size();
  result.edges = sites.edge_count();
  result.triangles = mesh.triangles.size();
  result.segments = mesh.segments.size();
  result.points = mesh.points.size();
  result.bounds = bounds(mesh);
  count_pieces(mesh, result);
  measure_triangles(mesh, result);
  throw_if_cancelled(context);

  const std::vector<EdgeTally> tallies = detail::tally_edges(mesh, sites);
  const EdgeCounts counts(tallies);
  result.boundary_edges = counts.boundary;
  result.nonmanifold_edges = counts.nonmanifold;
  result.inconsistent_edges = counts.inconsistent;
  const SurfaceComponents components = detail::find_components(mesh, sites, tallies);
  result.components = components.count;
  result.closed_components =
      static_cast<std::size_t>(std::count(components.is_closed.begin(), components.is_closed.end(), 1));
  throw_if_cancelled(context);

  ShellSet set = detail::find_shells(mesh, components, context);
  result.shells = std::move(set.shells);
  set.shells.resize(result.shells.size());
  const EdgeUses uses(mesh, sites, tallies);
  result.duplicate_triangles = count_duplicates(mesh, sites, uses);
  throw_if_cancelled(context);
  Fans fans(mesh, uses);
  count_fans(mesh, counts, fans, set, result);
  if (counts.boundary > 0) result.boundary_loops = fans.count_boundary_loops(uses);

  result.closed = counts.is_closed();
  result.oriented = counts.inconsistent == 0;
  result.manifold = counts.nonmanifold == 0 && result.nonmanifold_vertices == 0;
  for (const Shell& shell : result.shells) result.signed_volume += shell.signed_volume;
  result.faces_outwards =
      result.closed && result.oriented &&
      std::all_of(result.shells.begin(), result.shells.end(), [](const Shell& s) { return s.faces_outwards; });
  if (result.faces_outwards && result.manifold) result.betti = betti_of(result.shells);
  return result;
}

}  // namespace blum
