#include "blum/geometry/resolve_crossings.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/geometry/weld.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/crossings/sheets.hpp"
#include "geometry/crossings/windings.hpp"

namespace blum {
namespace {

using detail::Unresolved;

std::string number(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// Without progress, which would begin anew with each part of the work.
Context quiet(const Context& context) {
  Context out = context;
  out.progress = nullptr;
  return out;
}

/// A mesh with one vertex at each place, of size 1.
struct Welded {
  double scale = 1;
  std::vector<Vec3d> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> is_flat;  ///< 1: corners on one line, 2: in two places at most

  explicit Welded(const MeshView& mesh) : scale(coordinate_scale(bounds(mesh))) {
    const std::vector<std::uint32_t> cluster = weld_clusters(mesh.vertices);
    for (const Vec3d& v : mesh.vertices) vertices.push_back(v * scale);
    for (Triangle t : mesh.triangles) {
      for (std::uint32_t& v : t) v = cluster[v];
      triangles.push_back(t);
      const bool is_collapsed = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      const bool is_line = !is_collapsed && detail::has_no_area({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
      is_flat.push_back(is_collapsed ? 2 : is_line ? 1 : 0);
    }
  }
};

/// Counts edges with more than two triangles. @throws Unresolved where triangles do not cancel at an edge.
std::size_t crowded_edges(const MeshView& mesh) {
  struct Side {
    std::uint32_t low, high;
    int way;
  };
  std::vector<Side> sides;
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::size_t open = 0;
  std::size_t crowded = 0;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin;
    int sum = 0;
    for (; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high; ++end) {
      sum += sides[end].way;
    }
    open += sum != 0 ? 1 : 0;
    crowded += end - begin > 2 ? 1 : 0;
    begin = end;
  }
  if (open > 0) throw Unresolved("triangles do not meet in opposite directions at " + number(open, "edge"));
  return crowded;
}

/// The genera of a closed surface's shells, rising.
std::vector<std::int64_t> genera(const Topology& topology) {
  std::vector<std::int64_t> out;
  for (const Shell& shell : topology.shells) out.push_back(shell.genus);
  std::sort(out.begin(), out.end());
  return out;
}

/// The body that each triangle of a closed manifold belongs to.
std::vector<std::uint32_t> body_of_triangles(const TriangleMesh& mesh, const Topology& topology) {
  detail::UnionFind joined(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    joined.join(t[0], t[1]);
    joined.join(t[0], t[2]);
  }
  constexpr std::uint32_t nobody = 0xffffffffU;
  std::vector<std::uint32_t> shell(mesh.vertices.size(), nobody);
  std::uint32_t count = 0;
  std::vector<std::uint32_t> body;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& own = shell[joined.find(t[0])];
    if (own == nobody) own = count++;
    const Shell& facts = topology.shells[own];
    body.push_back(facts.depth % 2 == 0 ? own : static_cast<std::uint32_t>(facts.parent));
  }
  return body;
}

/// How often a body meets itself in a vertex: the same place under two numbers.
std::size_t pinches(const TriangleMesh& mesh, const Topology& topology) {
  const std::vector<std::uint32_t> body_of = body_of_triangles(mesh, topology);
  const std::vector<std::uint32_t> cluster = weld_clusters(mesh.vertices);
  std::vector<std::array<std::uint32_t, 3>> corners;  // place, body, vertex
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) corners.push_back({cluster[v], body_of[t], v});
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::size_t count = 0;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    count += corners[k][0] == corners[k - 1][0] && corners[k][1] == corners[k - 1][1] ? 1 : 0;
  }
  return count;
}

/// What keeps a mesh from being the boundary of a solid; empty where it is one.
std::string obstacle_of(const TriangleMesh& mesh, const Topology& topology, const Context& context) {
  if (topology.nonmanifold_edges > 0) {
    return "the solid touches itself along " + number(topology.nonmanifold_edges, "edge");
  }
  if (!topology.closed || !topology.oriented || !topology.manifold) return "the result is not closed and manifold";
  if (topology.degenerate_triangles > 0) {
    return number(topology.degenerate_triangles, "triangle") + " lost their area by rounding";
  }
  if (!topology.faces_outwards) return "shells of the result do not face away from the solid";
  const std::vector<std::uint32_t> body_of = body_of_triangles(mesh, topology);
  const SelfIntersections found = find_self_intersections(mesh, 100000, context);
  std::size_t touching = 0;
  for (const TrianglePair& pair : found.pairs) {
    touching += !pair.crosses && body_of[pair.first.value] == body_of[pair.second.value] ? 1 : 0;
  }
  if (found.crossing + touching == 0 && found.complete) return "";
  return number(found.crossing, "pair") + " of triangles cross, and " + number(touching, "pair") +
         " touch, after rounding";
}

/// A mesh resolved once, not yet checked.
ResolvedMesh resolved_once(const MeshView& mesh, const ResolveOptions& options, const Context& context) {
  ResolvedMesh out;
  out.counts.crowded_edges = crowded_edges(mesh);
  const SelfIntersections found = find_self_intersections(mesh, options.most_pairs, context);
  out.counts.crossing = found.crossing;
  out.counts.touching = found.touching;
  const Welded welded(mesh);
  out.counts.flat = static_cast<std::size_t>(
      std::count_if(welded.is_flat.begin(), welded.is_flat.end(), [](std::uint8_t flat) { return flat != 0; }));
  if (!found.complete) {
    out.obstacle = "more than " + number(options.most_pairs, "pair") + " of triangles cross or touch";
    return out;
  }
  const detail::CrossedMesh crossed{welded.vertices, welded.triangles, welded.is_flat, found.pairs};
  const detail::CutMesh cut = detail::cut_triangles(crossed, context);
  const detail::Boundary boundary = detail::boundary_of_inside(crossed, cut, options.least_winding, context);
  if (boundary.triangles.empty()) {
    out.has_inside = false;
    out.obstacle = "no point has a winding number above " + std::to_string(options.least_winding - 1) +
                   (options.least_winding == 1 ? ": it faces inwards" : "");
    return out;
  }
  out.counts.cut = cut.cut;
  out.counts.touching_edges = boundary.touching_edges;
  out.mesh.triangles = boundary.triangles;
  out.triangle_of = boundary.source_of;
  for (const auto& [p, other] : boundary.points) {
    const bool is_old = p == other && cut.space.is_vertex(p);
    const Vec3d middle = (cut.space.rounded(p) + cut.space.rounded(other)) * 0.5;
    out.mesh.vertices.push_back(is_old ? mesh.vertices[p] : middle / welded.scale);
    out.vertex_of.push_back(is_old ? p : ResolvedMesh::no_vertex);
    out.counts.new_vertices += is_old ? 0 : 1;
  }
  return out;
}

/// What a second round made of the result of a first one, in terms of the first one's input.
ResolvedMesh chained(const ResolvedMesh& first, ResolvedMesh second) {
  for (std::uint32_t& v : second.vertex_of) v = v == ResolvedMesh::no_vertex ? v : first.vertex_of[v];
  for (std::uint32_t& t : second.triangle_of) t = first.triangle_of[t];
  const std::size_t touching_edges = second.counts.touching_edges;
  second.counts = first.counts;
  second.counts.touching_edges = touching_edges;
  second.counts.new_vertices =
      static_cast<std::size_t>(std::count(second.vertex_of.begin(), second.vertex_of.end(), ResolvedMesh::no_vertex));
  return second;
}

}  // namespace

ResolvedMesh resolve_crossings(const MeshView& mesh, const ResolveOptions& options, const Context& context) {
  validate(mesh);
  if (mesh.triangles.empty()) throw InvalidMesh("the mesh has no triangles, so it has no interior");
  const Context own = quiet(context);
  ResolvedMesh out;
  try {
    out = resolved_once(mesh, options, own);
    if (!out.is_resolved()) return out;
    Topology facts = topology(out.mesh, own);
    if (options.most_rounds == 0) {
      out.body_of = body_of_triangles(out.mesh, facts);
      return out;
    }
    const std::vector<std::int64_t> exact = genera(facts);
    ResolveOptions rest = options;
    rest.least_winding = 1;  // what was found is wound around once
    for (out.counts.rounds = 1;; ++out.counts.rounds) {
      out.obstacle = obstacle_of(out.mesh, facts, own);
      if (out.obstacle.empty() && genera(facts) != exact) out.obstacle = "rounding changed how its parts hang together";
      if (out.obstacle.empty()) {
        out.counts.pinches = pinches(out.mesh, facts);
        out.body_of = body_of_triangles(out.mesh, facts);
      }
      if (out.obstacle.empty() || out.counts.rounds >= static_cast<std::size_t>(options.most_rounds)) return out;
      out = chained(out, resolved_once(out.mesh, rest, own));
      if (!out.is_resolved()) return out;
      facts = topology(out.mesh, own);
    }
  } catch (const Unresolved& error) {
    out.obstacle = error.what();
  }
  return out;
}

}  // namespace blum
