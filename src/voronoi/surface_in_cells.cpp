#include "voronoi/surface_in_cells.hpp"

#include <algorithm>
#include <array>

#include "blum/core/union_find.hpp"
#include "blum/geometry/grid_predicates.hpp"

namespace blum::voronoi {

/// Each triangle connects two points of the surface in the square: events of the border, or edges of the mesh that
/// pierce the square.
std::optional<SurfaceChains> surface_chains(const CellTree& tree, const SurfaceInCells& surface,
                                            const GridSquare& square) {
  SurfaceChains out;
  if (square.triangles.empty()) return out;
  std::vector<std::array<std::uint32_t, 2>> nodes;  // (triangle, node)
  std::vector<std::uint32_t> events;                // events; the first nodes
  for (const CellId id : square.edges) {
    const GridEdge& edge = tree.edges[id];
    for (std::uint32_t k = edge.first_event; k < edge.last_event; ++k) {
      const std::optional<LabelIndex> triangle = tree.events[k].crossed();
      if (!triangle) continue;
      nodes.push_back({*triangle, static_cast<std::uint32_t>(events.size())});
      events.push_back(k);
    }
  }
  const auto count = static_cast<std::uint32_t>(events.size());
  for (const std::uint32_t t : square.triangles) {
    for (const EdgeId edge : surface.table().triangle_edges()[t]) {
      if (!surface.pierces(edge.value, square)) continue;
      nodes.push_back({t, count + edge.value});
      out.edges.push_back(edge.value);
    }
  }
  std::sort(out.edges.begin(), out.edges.end());
  out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
  // The nodes of edges are numbered by the edges' indices in out.edges.
  for (auto& [triangle, node] : nodes) {
    if (node < count) continue;
    const auto at = std::lower_bound(out.edges.begin(), out.edges.end(), node - count);
    node = count + static_cast<std::uint32_t>(at - out.edges.begin());
  }
  std::sort(nodes.begin(), nodes.end());
  detail::UnionFind joined(count + out.edges.size());
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    if (nodes[k][0] == nodes[k - 1][0]) joined.join(nodes[k][1], nodes[k - 1][1]);
  }
  std::vector<std::vector<std::uint32_t>> ends(count + out.edges.size());
  std::vector<std::uint32_t> chain_of(ends.size(), 0);
  for (std::uint32_t k = 0; k < count; ++k) ends[joined.find(k)].push_back(events[k]);
  for (std::uint32_t k = 0; k < ends.size(); ++k) {
    if (joined.find(k) != k) continue;
    if (ends[k].size() != 2) return std::nullopt;  // a curve without ends is closed
    chain_of[k] = static_cast<std::uint32_t>(out.ends.size());
    out.ends.push_back({ends[k][0], ends[k][1]});
  }
  for (const auto& [triangle, node] : nodes) out.triangles.push_back({chain_of[joined.find(node)], triangle});
  std::sort(out.triangles.begin(), out.triangles.end());
  out.triangles.erase(std::unique(out.triangles.begin(), out.triangles.end()), out.triangles.end());
  return out;
}

bool SurfaceInCells::pierces(std::uint32_t edge, const GridSquare& square) const {
  const Segment& ends = table_.edges()[edge];
  const detail::EdgeEnds p{mesh_.vertices[ends[0]], mesh_.vertices[ends[1]]};
  const std::size_t axis = square.axis;
  const double plane = lattice_.at(axis, square.low[axis]);
  const bool starts_above = detail::is_above(p[0][axis], plane);
  if (starts_above == detail::is_above(p[1][axis], plane)) return false;
  for (const std::size_t along : {next_axis(axis), next_axis(next_axis(axis))}) {
    // Projected along the third axis, the edge passes the square's plane above or below a coordinate.
    const std::size_t seen = 3 - axis - along;
    const auto is_beyond = [&](double coordinate) {
      if (detail::is_above(p[0][along], coordinate) == detail::is_above(p[1][along], coordinate)) {
        return detail::is_above(p[0][along], coordinate);
      }
      const bool axis_is_first = next_axis(seen) == axis;
      const int side = axis_is_first ? detail::side_of_line(p, seen, plane, coordinate)
                                     : detail::side_of_line(p, seen, coordinate, plane);
      // If `axis` is the first axis of the projection and the edge rises along it, a line left of the edge is above the
      // edge.
      const bool line_is_above = (side > 0) == (axis_is_first ? !starts_above : starts_above);
      return !line_is_above;
    };
    if (!is_beyond(lattice_.at(along, square.low[along]))) return false;
    if (is_beyond(lattice_.at(along, square.low[along] + square.length))) return false;
  }
  return true;
}

bool SurfaceInCells::is_in(std::uint32_t vertex, const GridCube& cube) const {
  const Vec3d& p = mesh_.vertices[vertex];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!detail::is_above(p[axis], lattice_.at(axis, cube.low[axis]))) return false;
    if (detail::is_above(p[axis], lattice_.at(axis, cube.low[axis] + cube.length))) return false;
  }
  return true;
}

std::vector<std::uint32_t> SurfaceInCells::edges_of(std::span<const std::uint32_t> triangles) const {
  std::vector<std::uint32_t> out;
  for (const std::uint32_t t : triangles) {
    for (const EdgeId edge : table_.triangle_edges()[t]) out.push_back(edge.value);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace blum::voronoi
