#include "solid/polyhedron.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "blum/core/sort_unique.hpp"
#include "blum/geometry/facing.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"

namespace blum {
namespace detail {
namespace {

constexpr std::uint32_t nobody = 0xffffffffU;

/// Returns the body of each shell. Each outer shell (of even depth) gets the next body number; each void gets the body
/// of the shell around it. Returns nullopt if the shell around a void is not an outer shell, which may happen if shells
/// cross or coincide.
std::optional<std::vector<std::uint32_t>> body_of_shells(const std::vector<Shell>& shells) {
  std::vector<std::uint32_t> body(shells.size(), nobody);
  std::uint32_t count = 0;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (shells[s].depth % 2 == 0) body[s] = count++;
  }
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (shells[s].depth % 2 == 0) continue;
    const std::int64_t parent = shells[s].parent;
    if (parent < 0 || shells[static_cast<std::size_t>(parent)].depth % 2 == 1) return std::nullopt;
    body[s] = body[static_cast<std::size_t>(parent)];
  }
  return body;
}

/// Copies the given triangles and the vertices that they use.
SolidBody copy_of(const MeshView& mesh, const std::vector<std::uint32_t>& triangles,
                  const std::vector<bool>& is_reversed) {
  SolidBody body;
  body.triangle_of = triangles;
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t v : mesh.triangles[t]) body.vertex_of.push_back(v);
  }
  std::sort(body.vertex_of.begin(), body.vertex_of.end());
  body.vertex_of.erase(std::unique(body.vertex_of.begin(), body.vertex_of.end()), body.vertex_of.end());
  for (const std::uint32_t v : body.vertex_of) body.mesh.vertices.push_back(mesh.vertices[v]);
  for (const std::uint32_t t : triangles) {
    Triangle own{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = std::lower_bound(body.vertex_of.begin(), body.vertex_of.end(), mesh.triangles[t][k]);
      own[k] = static_cast<std::uint32_t>(at - body.vertex_of.begin());
    }
    if (is_reversed[t]) std::swap(own[1], own[2]);
    body.mesh.triangles.push_back(own);
  }
  return body;
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Result of checking how triangles meet.
struct Meeting {
  std::string why;      ///< the reason why the mesh bounds no polyhedron; empty if it bounds one
  std::string problem;  ///< the reason as a full sentence; also set if bodies touch each other
  std::vector<std::array<std::uint32_t, 2>> touching;  ///< pairs of bodies that touch
};

Meeting meeting(const MeshView& mesh, const std::vector<std::uint32_t>& body_of_triangle, const Context& context) {
  const SelfIntersections found = find_self_intersections(mesh, 100000, context);
  Meeting out;
  out.problem = problem_of_crossings(found);
  if (found.crossing > 0) out.why = mesh_problem::crossing(found.crossing, found.complete);
  if (out.why.empty() && !found.complete) out.why = mesh_problem::touching(found.touching, false);
  if (!out.why.empty()) return out;
  std::size_t own = 0;
  for (const TrianglePair& pair : found.pairs) {
    const std::uint32_t one = body_of_triangle[pair.first.value];
    const std::uint32_t other = body_of_triangle[pair.second.value];
    own += one == other ? 1 : 0;
    out.touching.push_back({std::min(one, other), std::max(one, other)});
  }
  if (own > 0) out.why = mesh_problem::touching(own, true);
  sort_unique(out.touching);
  return out;
}

/// Returns the whole mesh as one body, to which the rule of winding numbers applies.
/// @param why  the reason why the mesh bounds no polyhedron, as in Obstacle; `problem` likewise.
MeshSolid whole(const MeshView& mesh, const Topology& topology, const std::string& why, std::string problem) {
  MeshSolid out;
  out.problem = std::move(problem);
  out.surface.mesh = blum::copy_of(mesh);
  out.is_closed = topology.closed && topology.oriented;
  out.rule = SolidRule::winding;
  out.reason = "the mesh bounds no polyhedron: " + why + "; the solid is where the winding number is above 1/2";
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  out.bodies.push_back(copy_of(mesh, all, std::vector<bool>(all.size(), false)));
  return out;
}

/// Adds the shells of a polyhedron to `solid`, and sets the Betti numbers of its bodies.
void add_shells(const std::vector<Shell>& shells, const std::vector<std::uint32_t>& body, MeshSolid& solid) {
  for (std::uint32_t s = 0; s < shells.size(); ++s) {
    const Shell& one = shells[s];
    solid.shells.push_back({body[s], one.depth,
                            one.parent < 0 ? std::nullopt : std::optional(static_cast<std::uint32_t>(one.parent)),
                            one.genus, std::abs(one.signed_volume), !one.faces_outwards});
    SolidBody& own = solid.bodies[body[s]];
    ++own.betti[one.depth % 2 == 0 ? 0 : 2];
    own.betti[1] += one.genus;
    own.shells.insert(one.depth % 2 == 0 ? own.shells.begin() : own.shells.end(), s);
  }
}

/// The reason why a mesh bounds no polyhedron.
struct Obstacle {
  std::string why;      ///< continues the text "the mesh bounds no polyhedron: " in Solid::reason()
  std::string problem;  ///< text for an error, with advice
};

/// Returns the polyhedron that a mesh bounds without changes; nullopt if it bounds none.
/// @param obstacle  is set to the reason if nullopt is returned.
std::optional<MeshSolid> polyhedron(const MeshView& mesh, const SiteTable& sites, const Topology& topology,
                                    Obstacle& obstacle, const Context& context) {
  obstacle = {mesh_problem::obstacles(topology), problem_as_solid(topology)};
  if (!obstacle.why.empty()) return std::nullopt;
  const std::vector<std::uint32_t> shell = shell_of_triangles(mesh, sites);
  const std::optional<std::vector<std::uint32_t>> body = body_of_shells(topology.shells);
  if (!body) {
    obstacle = {std::string(mesh_problem::shells_cross), std::string(mesh_problem::not_nested)};
    return std::nullopt;
  }
  std::vector<std::vector<std::uint32_t>> triangles;
  std::vector<std::uint32_t> body_of_triangle(mesh.triangles.size(), nobody);
  std::vector<bool> is_reversed(mesh.triangles.size(), false);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (shell[t] == no_shell) continue;
    const std::uint32_t b = body_of_triangle[t] = (*body)[shell[t]];
    if (b >= triangles.size()) triangles.resize(b + 1);
    triangles[b].push_back(t);
    is_reversed[t] = !topology.shells[shell[t]].faces_outwards;
  }
  Meeting met = meeting(mesh, body_of_triangle, context);
  obstacle = {met.why, met.problem};
  if (!met.why.empty()) return std::nullopt;
  MeshSolid out;
  out.problem = std::move(met.problem);
  out.touching = std::move(met.touching);
  out.is_closed = true;
  out.surface.mesh = blum::copy_of(mesh);
  for (std::size_t t = 0; t < is_reversed.size(); ++t) {
    if (is_reversed[t]) std::swap(out.surface.mesh.triangles[t][1], out.surface.mesh.triangles[t][2]);
  }
  for (const auto& own : triangles) out.bodies.push_back(copy_of(mesh, own, is_reversed));
  add_shells(topology.shells, *body, out);
  out.reason = "the mesh is closed, manifold and does not cross itself";
  const auto reversed =
      std::count_if(out.shells.begin(), out.shells.end(), [](const SolidShell& own) { return own.is_reversed; });
  if (reversed > 0)
    out.reason += "; " + counted(static_cast<std::size_t>(reversed), "shell faced the wrong way and was reversed",
                                 "shells faced the wrong way and were reversed");
  if (!out.touching.empty()) out.reason += "; some of its bodies touch";
  return out;
}

std::string resolved_text(const CrossingCounts& counts) {
  std::string text;
  const auto add = [&](std::size_t n, const char* one, const char* many) {
    if (n > 0) text += (text.empty() ? "" : ", ") + counted(n, one, many);
  };
  add(counts.crossing, "pair of triangles crossed", "pairs of triangles crossed");
  add(counts.touching, "pair of triangles touched", "pairs of triangles touched");
  add(counts.flat, "triangle had no area", "triangles had no area");
  add(counts.crowded_edges, "edge had more than two triangles", "edges had more than two triangles");
  return text + ": resolved exactly, the solid is where the winding number is 1 or more";
}

/// Resolves the crossings of a closed mesh. Returns the polyhedron of the points at which the mesh's winding number is
/// 1 or more; nullopt if that fails.
/// @param obstacle  the reason why the mesh bounds no polyhedron without changes. If nullopt is returned, the reason
///                  why its crossings are not resolved is appended.
std::optional<MeshSolid> resolved_polyhedron(const MeshView& mesh, Obstacle& obstacle, const Context& context) {
  ResolvedMesh resolved = resolve_crossings(mesh, {}, context);
  Obstacle left{resolved.obstacle, {}};
  if (resolved.is_resolved()) {
    const SiteTable sites(resolved.mesh, context);
    std::optional<MeshSolid> out =
        polyhedron(resolved.mesh, sites, topology(resolved.mesh, sites, context), left, context);
    if (out) {
      for (SolidBody& body : out->bodies) {
        for (std::uint32_t& v : body.vertex_of) v = resolved.vertex_of[v];
        for (std::uint32_t& t : body.triangle_of) t = resolved.triangle_of[t];
      }
      out->surface.vertex_of = std::move(resolved.vertex_of);
      out->surface.triangle_of = std::move(resolved.triangle_of);
      out->resolved = resolved.counts;
      out->reason = resolved_text(resolved.counts);
      return out;
    }
  }
  obstacle.why += ", and the crossings cannot be resolved: " + left.why;
  obstacle.problem += ", and the crossings cannot be resolved: " + left.why;
  return std::nullopt;
}

}  // namespace

bool are_nested(std::span<const Shell> shells) {
  return std::all_of(shells.begin(), shells.end(), [&](const Shell& shell) {
    return shell.depth % 2 == 0 || (shell.parent >= 0 && shells[static_cast<std::size_t>(shell.parent)].depth % 2 == 0);
  });
}

Facing face_one_way(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  Facing out;
  out.given = topology(mesh, sites, context);
  out.facts = out.given;
  if (!out.given.closed || out.given.inconsistent_edges == 0) return out;
  out.triangles = agreeing_triangles(mesh, sites, out.reversed_triangles);
  out.is_one_sided = !out.triangles;
  if (!out.triangles) return out;
  const MeshView agreeing{mesh.vertices, *out.triangles, mesh.segments, mesh.points};
  out.facts = topology(agreeing, SiteTable(agreeing, context), context);
  return out;
}

MeshSolid split_into_bodies(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  if (mesh.triangles.empty()) throw InvalidMesh(std::string(mesh_problem::no_interior));
  Facing facing = face_one_way(mesh, sites, context);
  MeshView own = mesh;
  if (facing.triangles) own.triangles = *facing.triangles;
  const SiteTable own_sites = facing.triangles ? SiteTable(own, context) : SiteTable();
  const SiteTable& table = facing.triangles ? own_sites : sites;
  Obstacle obstacle;
  std::optional<MeshSolid> out = polyhedron(own, table, facing.facts, obstacle, context);
  if (!out && facing.facts.boundary_edges == 0 && facing.facts.inconsistent_edges == 0) {
    out = resolved_polyhedron(own, obstacle, context);
  }
  if (!out) {
    if (facing.is_one_sided) obstacle.problem = mesh_problem::one_sided;
    out = whole(own, facing.facts, obstacle.why, std::move(obstacle.problem));
  }
  out->topology = std::move(facing.given);
  out->reversed_triangles = facing.reversed_triangles;
  if (facing.triangles) out->reason += "; neighbouring triangles faced different ways and were reversed";
  return std::move(*out);
}

std::vector<std::uint32_t> groups_apart(std::size_t bodies, std::span<const std::array<std::uint32_t, 2>> touching) {
  std::vector<std::vector<std::uint32_t>> before(bodies);  // for each body: touching bodies with smaller numbers
  for (const auto& [one, other] : touching) before[other].push_back(one);
  std::vector<std::uint32_t> group(bodies, 0);
  for (std::size_t body = 0; body < bodies; ++body) {
    std::vector<std::uint32_t> taken;
    for (const std::uint32_t other : before[body]) taken.push_back(group[other]);
    std::sort(taken.begin(), taken.end());
    for (const std::uint32_t used : taken) group[body] += used == group[body] ? 1U : 0U;
  }
  return group;
}

}  // namespace detail

SiteId SolidBody::input_site(SiteId own, const SiteTable& own_sites, const SiteTable& input_sites) const {
  const Site site = own_sites.site(own);
  if (site.kind == SiteKind::vertex && vertex_of[site.index] != no_vertex) {
    return input_sites.id({SiteKind::vertex, vertex_of[site.index]});
  }
  if (site.kind == SiteKind::edge) {
    const Segment& edge = own_sites.edges()[site.index];
    const auto [low, high] = std::minmax(vertex_of[edge[0]], vertex_of[edge[1]]);
    const auto edges = input_sites.edges();
    const auto at = std::lower_bound(edges.begin(), edges.end(), Segment{low, high});
    if (at != edges.end() && *at == Segment{low, high}) {
      return input_sites.id({SiteKind::edge, static_cast<std::uint32_t>(at - edges.begin())});
    }
  }
  return input_sites.id({SiteKind::face, triangle_of[own_sites.triangle(own).value]});
}

}  // namespace blum
