#include "blum/geometry/mesh_problems.hpp"

#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/plural.hpp"
#include "blum/geometry/weld.hpp"

namespace blum {
namespace {

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string pairs_text(std::size_t pairs, bool is_complete) {
  return " (" + ((is_complete ? "" : "more than ") + counted(pairs, "pair", "pairs")) + " of triangles)";
}

}  // namespace

std::string problem_as_solid(const Topology& facts) {
  const auto count = [](std::size_t n, const char* one, const char* several) {
    return n == 1 ? std::string("one ") + one : std::to_string(n) + " " + several;
  };
  const std::string head = "the mesh bounds no solid: it ";
  if (facts.triangles == 0) return head + "has no triangles";
  if (facts.nonmanifold_edges > 0) {
    return head + "is not manifold: " + count(facts.nonmanifold_edges, "edge has", "edges have") +
           " more than two triangles";
  }
  if (facts.boundary_edges > 0) {
    return head + "is not closed: " + count(facts.boundary_edges, "edge has", "edges have") +
           " only one triangle; if vertices are duplicated, weld the mesh: merge equal vertices, or close ones within "
           "a tolerance";
  }
  if (!facts.oriented) {
    return head + "is not oriented: at " + count(facts.inconsistent_edges, "edge", "edges") +
           " both triangles run in the same direction (oriented_mesh() reorients them)";
  }
  if (!facts.manifold) {
    return head + "is not manifold: at " + count(facts.nonmanifold_vertices, "vertex", "vertices") +
           " parts of it touch";
  }
  if (!facts.closed) return head + "is not closed";
  if (!facts.faces_outwards) {
    return head +
           "does not face outwards: shells of it, or of its voids, face the solid (oriented_mesh() reorients them)";
  }
  return "";
}

std::string problem_of_places(const MeshView& mesh) {
  const std::vector<std::uint32_t> places = weld_clusters(mesh.vertices);
  std::vector<std::optional<std::uint32_t>> vertex_at(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      std::optional<std::uint32_t>& known = vertex_at[places[v]];
      if (!known) known = v;
      if (*known == v) continue;
      return "the mesh touches itself: vertices " + std::to_string(*known) + " and " + std::to_string(v) +
             " coincide; weld the mesh first: merge equal vertices";
    }
  }
  return {};
}

std::string problem_of_crossings(const MeshView& mesh, const Context& context) {
  return problem_of_crossings(find_self_intersections(mesh, 1, context));
}

std::string problem_of_crossings(const SelfIntersections& found) {
  if (found.pairs.empty()) return {};
  return "the mesh crosses or touches itself: triangles " + std::to_string(found.pairs[0].first.value) + " and " +
         std::to_string(found.pairs[0].second.value) + ", for example";
}

namespace mesh_problem {

std::string obstacles(const Topology& facts) {
  std::string text;
  const auto add = [&](std::size_t n, const std::string& what, const char* one, const char* many) {
    if (n > 0) text += (text.empty() ? "" : ", ") + what + " (" + counted(n, one, many) + ")";
  };
  add(facts.boundary_edges, "it is open", "boundary edge", "boundary edges");
  add(facts.nonmanifold_edges, "it is not manifold", "edge", "edges");
  add(facts.inconsistent_edges, "its triangles face different ways", "edge", "edges");
  add(facts.nonmanifold_vertices, "it is not manifold", "vertex", "vertices");
  return text.empty() && !facts.closed ? "its triangles enclose nothing" : text;
}

std::string crossing(std::size_t pairs, bool is_complete) {
  return "it crosses itself" + pairs_text(pairs, is_complete);
}

std::string touching(std::size_t pairs, bool is_complete) {
  return "it touches itself" + pairs_text(pairs, is_complete);
}

std::string crosses_and_is_resolved(const std::string& how) {
  return "the mesh crosses or touches itself (" + how +
         "): pass the Solid of the mesh; sites are then those of its surface";
}

std::string doubled_corner(std::size_t triangle) {
  return "triangle " + std::to_string(triangle) + " uses a vertex twice; weld the mesh, which removes such triangles";
}

std::string without_area(std::size_t triangle) {
  return "triangle " + std::to_string(triangle) + " has no area, and no edge flip removes it";
}

std::string of_edges(const Orientation& facts) {
  if (facts.boundary_edges + facts.nonmanifold_edges + facts.inconsistent_edges == 0) {
    return "no triangle with three different corners";
  }
  return std::to_string(facts.boundary_edges) + " boundary edges, " + std::to_string(facts.nonmanifold_edges) +
         " non-manifold edges and " + std::to_string(facts.inconsistent_edges) + " inconsistently oriented edges";
}

std::string no_triangles_in(const std::string& name) {
  return name + " has no triangles, so nothing can lie in it";
}

std::string faces_inwards(const std::string& name) {
  return name + " faces inwards: its volume is negative; reverse its triangles";
}

std::string not_closed(const std::string& name, std::size_t open, bool is_closed_by_welding) {
  const std::string edges = plural(open, "edge", "edges");
  if (is_closed_by_welding) {
    return name + " is not closed: at " + edges +
           " its triangles touch but share no vertices; weld it, which merges equal vertices";
  }
  return name + " is not closed, or its triangles do not all face the same way: at " + edges +
         " they do not meet in opposite directions; close its holes, orient it (oriented_mesh()), or weld its vertices "
         "within a tolerance";
}

std::string not_resolved(const std::string& name, const std::string& obstacle) {
  return name + " crosses or touches itself, and its interior cannot be determined: " + obstacle;
}

}  // namespace mesh_problem
}  // namespace blum
