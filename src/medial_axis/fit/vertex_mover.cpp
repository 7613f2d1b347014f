#include "medial_axis/fit/vertex_mover.hpp"

#include <algorithm>
#include <array>

#include "blum/core/sort_unique.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/surface/void_points.hpp"

namespace blum {

double VertexMover::make(std::vector<VertexMove> moves) {
  std::vector<std::uint32_t> changed;
  for (std::uint32_t k = 0; k < moves.size(); ++k) {
    std::swap(lists_.vertices[moves[k].vertex], moves[k].other);
    move_of_[moves[k].vertex] = k + 1;
    changed.push_back(moves[k].vertex);
  }
  // What goes back may let edges beside it leave the solid.
  while (!changed.empty()) {
    const std::vector<std::uint32_t> edges = edges_of(changed);
    const std::vector<std::uint8_t> leaves = which_leave(edges, moves);
    changed.clear();
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (leaves[k] == 0) continue;
      for (const std::uint32_t v : incidence_.edges()[edges[k]]) {
        if (move_of_[v] == 0) continue;
        lists_.vertices[v] = moves[move_of_[v] - 1].other;
        move_of_[v] = 0;
        changed.push_back(v);
      }
    }
  }
  double furthest = 0;
  for (const VertexMove& move : moves) {
    if (move_of_[move.vertex] == 0) continue;
    furthest = std::max(furthest, length(lists_.vertices[move.vertex].position - move.other.position));
    move_of_[move.vertex] = 0;
  }
  return furthest;
}

/// The edges that which_leave() may answer otherwise for once some vertices are elsewhere.
std::vector<std::uint32_t> VertexMover::edges_of(const std::vector<std::uint32_t>& vertices) const {
  std::vector<std::uint32_t> edges;
  for (const std::uint32_t v : vertices) {
    const auto at = incidence_.edges_of_vertex()[v];
    edges.insert(edges.end(), at.begin(), at.end());
    if (surface_.voids().empty()) continue;
    for (const std::uint32_t t : incidence_.triangles_of_vertex()[v]) {
      const auto& sides = incidence_.sides()[t];
      edges.insert(edges.end(), sides.begin(), sides.end());
    }
  }
  detail::sort_unique(edges);
  return edges;
}

const AxisVertex& VertexMover::before(std::uint32_t v, const std::vector<VertexMove>& moves) const {
  return move_of_[v] == 0 ? lists_.vertices[v] : moves[move_of_[v] - 1].other;
}

std::vector<std::uint8_t> VertexMover::which_leave(const std::vector<std::uint32_t>& edges,
                                                   const std::vector<VertexMove>& moves) const {
  constexpr std::size_t edges_per_range = 256;
  std::vector<std::uint8_t> leaves(edges.size(), 0);
  parallel_for(context_, edges.size(), edges_per_range, "borders", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto& [a, b] = incidence_.edges()[edges[k]];
      if (move_of_[a] == 0 && move_of_[b] == 0) continue;
      const std::array<Stop, 2> now{stop_of(lists_.vertices[a]), stop_of(lists_.vertices[b])};
      const bool stays = paths_.is_straight(now[0], now[1]) &&
                         paths_.can_sweep({stop_of(before(a, moves)), stop_of(before(b, moves))}, now) &&
                         !moves_over_void(edges[k], moves);
      leaves[k] = stays ? 0 : 1;
    }
  });
  return leaves;
}

/// Whether a triangle at an edge moved over a void as a whole, which edges do not see.
bool VertexMover::moves_over_void(std::uint32_t e, const std::vector<VertexMove>& moves) const {
  const auto around = incidence_.triangles_of_edge()[e];
  return !surface_.voids().empty() && std::any_of(around.begin(), around.end(), [&](std::uint32_t t) {
    auto corners = lists_.triangles[t];
    std::sort(corners.begin(), corners.end());
    std::array<Vec3d, 3> from;
    std::array<Vec3d, 3> to;
    for (std::size_t k = 0; k < 3; ++k) {
      from[k] = before(corners[k], moves).position;
      to[k] = lists_.vertices[corners[k]].position;
    }
    return moves_over_any(surface_.voids(), from, to);
  });
}

}  // namespace blum
