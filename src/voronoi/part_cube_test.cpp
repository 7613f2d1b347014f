#include "voronoi/part_cube_test.hpp"

#include <algorithm>
#include <utility>

namespace blum::voronoi {

VoronoiObstacle PartOfCube::find(CubeCells& out) {
  collect();
  if (!join_events()) return VoronoiObstacle::contradiction;
  VoronoiObstacle obstacle = add_dropped_walls();
  if (obstacle == VoronoiObstacle::none) obstacle = add_thin_regions();
  if (obstacle != VoronoiObstacle::none) return obstacle;
  add_lines_and_points();
  const std::int64_t components = static_cast<std::int64_t>(in_.component_count) - euler_;
  out.component_count = 0;
  number_components(out);
  const std::int64_t on_boundary = out.component_count;
  if (components != on_boundary) {
    // Some components on the boundary are connected inside the cube. It is known which components are connected only if
    // all of them are.
    if (components != 1 || on_boundary == 0) return VoronoiObstacle::joins;
    for (CubeCells::Square& square : out.squares) square.component.assign(square.component.size(), 0);
    out.component_count = 1;
  }
  return VoronoiObstacle::none;
}

void PartOfCube::collect() {
  std::uint32_t count = 0;
  for (const SquareOfCube& square : in_.squares) {
    parts_.push_back(part_square(square.cells, tree_.squares[square.id], solid_.rule));
    first_.push_back(count);
    count += parts_.back().component_count;
    const auto s = static_cast<std::uint32_t>(parts_.size() - 1);
    for (const auto& [a, b] : parts_.back().arcs) {
      const Pair sites{square.cells.pieces[a].site, square.cells.pieces[b].site};
      walls_[{std::min(sites[0], sites[1]), std::max(sites[0], sites[1])}].push_back(s);
    }
    // In a square, each dropped arc contributes -1, and each dropped point contributes 1.
    corners_.insert(parts_.back().corners.begin(), parts_.back().corners.end());
    euler_ += static_cast<std::int64_t>(parts_.back().corners.size());
    euler_ -= static_cast<std::int64_t>(parts_.back().arcs.size());
    for (const ThinRegion& region : parts_.back().thin) {
      euler_ += 1 - static_cast<std::int64_t>(region.events.size());
      thin_.insert(region.vertex);
    }
  }
  joined_.reset(count);
}

/// Joins components of squares that share an event on an edge of the grid, and counts dropped events. Returns false if
/// two squares disagree about an event. Squares disagree near nodes with contradictory sites.
bool PartOfCube::join_events() {
  struct AtEvent {
    std::uint32_t event, square, component;
    Pair sites;
  };
  std::vector<AtEvent> all;
  for (std::uint32_t s = 0; s < in_.squares.size(); ++s) {
    const SquareCells& cells = in_.squares[s].cells;
    for (std::size_t k = 0; k < cells.events.size(); ++k) {
      const std::uint32_t before = cells.site_before(k);
      const std::uint32_t behind = cells.site_behind(k);
      const std::uint32_t of = parts_[s].component[k];
      all.push_back({cells.events[k],
                     s,
                     of == outside ? outside : first_[s] + of,
                     {std::min(before, behind), std::max(before, behind)}});
    }
  }
  std::sort(all.begin(), all.end(), [](const AtEvent& a, const AtEvent& b) {
    return std::pair(a.event, a.square) < std::pair(b.event, b.square);
  });
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (all[k].event != all[k - 1].event) continue;
    if ((all[k].component == outside) != (all[k - 1].component == outside)) return false;
    if (all[k].component != outside) {
      joined_.join(all[k].component, all[k - 1].component);
    } else {
      ++euler_;
      events_of_walls_[all[k].sites].push_back({all[k - 1].square, all[k].square});
    }
  }
  return true;
}

VoronoiObstacle PartOfCube::add_dropped_walls() {
  // Each part of a face counts as 1, because its boundary was counted before.
  if (in_.has_inner_face) return VoronoiObstacle::enclosed;
  euler_ += static_cast<std::int64_t>(in_.face_parts);
  if (!solid_.rule.is_medial()) return VoronoiObstacle::none;
  if (is_any_wall_inside()) return VoronoiObstacle::enclosed;
  for (const auto& [sites, squares] : walls_) {
    if (sites[1] == outside) continue;
    if (!solid_.rule.is_face(sites[0])) {
      ++euler_;  // a vertex's region is convex, and so is its wall to an edge
      continue;
    }
    const VoronoiObstacle obstacle = add_edge_walls(sites, squares);
    if (obstacle != VoronoiObstacle::none) return obstacle;
  }
  return VoronoiObstacle::none;
}

/// Returns true if a dropped wall that starts at an edge or vertex in the cube does not reach the cube's boundary. Also
/// returns true if a dropped line at a vertex does not reach the boundary.
bool PartOfCube::is_any_wall_inside() const {
  const auto has_wall = [&](std::uint32_t a, std::uint32_t b) {
    return walls_.contains({std::min(a, b), std::max(a, b)});
  };
  for (const std::uint32_t edge : in_.edges) {
    const std::optional<std::uint32_t> site = solid_.labels.site_of_edge(edge);
    if (!site) continue;
    for (const std::uint32_t t : solid_.sites.triangles_of[edge]) {
      if (!has_wall(solid_.sites.face_of[t], *site)) return true;
    }
  }
  for (const std::uint32_t v : in_.vertices) {
    const ReflexCorner& corner = solid_.corners[v];
    if (corner.is_thin) {
      if (!corners_.contains({outside, v}) && !thin_.contains(v)) return true;
      continue;
    }
    for (const std::uint32_t edge : corner.edges) {
      const std::uint32_t beyond = corner.is_passing ? corner.edges[1] : *solid_.labels.site_of_vertex(v);
      if (!has_wall(corner.is_passing ? corner.edges[0] : edge, beyond)) return true;
    }
    for (const std::uint32_t face : corner.faces) {
      if (!corners_.contains({face, v})) return true;
    }
  }
  return false;
}

/// Adds the components of the wall between a face and a reflex edge in the cube. The wall lies in a plane. Let a point
/// of the wall move against the face's normal, towards the edge. It stays in the wall until it reaches the edge or
/// leaves the cube. So the components of the wall correspond to the connected parts of the edge and of the points where
/// it leaves.
VoronoiObstacle PartOfCube::add_edge_walls(const Pair& sites, const std::vector<std::uint32_t>& squares) {
  const auto [face, site] = sites;
  // All triangles of a face have the same normal. The label of a triangle has the triangle's index.
  const Vec3d& normal = solid_.labels[solid_.triangle_of_face[face]].direction;
  const auto is_low = [&](std::uint32_t s) { return is_lower_side(in_.squares[s].side, normal); };
  const std::uint32_t edge = solid_.sites.reflex_edges[site - solid_.sites.face_count];
  const auto count = static_cast<std::uint32_t>(squares.size());
  const auto rank = [&](std::uint32_t s) {
    return static_cast<std::uint32_t>(std::lower_bound(squares.begin(), squares.end(), s) - squares.begin());
  };
  // The last entry represents the part of the edge in the cube.
  detail::UnionFind parts(count + 1);
  for (const auto& [s, t] : events_of_walls_[sites]) {
    if (is_low(s) && is_low(t)) parts.join(rank(s), rank(t));
  }
  for (const auto& [pierced_by, s] : in_.piercings) {
    if (pierced_by == edge && is_low(s)) parts.join(rank(s), count);
  }
  const bool has_edge = std::binary_search(in_.edges.begin(), in_.edges.end(), edge);
  std::set<std::uint32_t> found;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (is_low(squares[k])) found.insert(parts.find(k));
  }
  if (has_edge) found.insert(parts.find(count));
  if (found.empty()) return VoronoiObstacle::contradiction;
  euler_ += static_cast<std::int64_t>(found.size());
  return VoronoiObstacle::none;
}

/// Adds thin regions that count as lines and meet edges of the grid. If such a region has no end in the cube except its
/// vertex, it is convex there. Its parts on the cube's boundary must be discs. Its Euler number, without the boundary,
/// is 1 minus that of these parts. If its vertex is in the cube, it is 0 minus that of the parts, because the vertex is
/// counted separately.
VoronoiObstacle PartOfCube::add_thin_regions() {
  for (const std::uint32_t v : thin_) {
    const ThinOnBoundary met = thin_on_boundary(v);
    if (met.euler != met.parts || may_end_inside(v)) return VoronoiObstacle::joins;
    const bool has_vertex = std::binary_search(in_.vertices.begin(), in_.vertices.end(), v);
    euler_ += (has_vertex ? 0 : 1) - met.euler;
    corners_.erase({outside, v});  // no longer counted as a separate line
  }
  return VoronoiObstacle::none;
}

PartOfCube::ThinOnBoundary PartOfCube::thin_on_boundary(std::uint32_t v) const {
  ThinOnBoundary out;
  std::vector<Pair> events;  // (event of the tree, square)
  for (std::uint32_t s = 0; s < in_.squares.size(); ++s) {
    const std::int64_t points = std::count(parts_[s].corners.begin(), parts_[s].corners.end(), Pair{outside, v});
    out.euler += points;
    out.parts += points;
    for (const ThinRegion& region : parts_[s].thin) {
      if (region.vertex != v) continue;
      ++out.parts;
      out.euler += 1 - static_cast<std::int64_t>(region.events.size());
      for (const std::size_t k : region.events) events.push_back({in_.squares[s].cells.events[k], s});
    }
  }
  std::sort(events.begin(), events.end());
  detail::UnionFind squares(static_cast<std::uint32_t>(in_.squares.size()));
  for (std::size_t k = 0; k < events.size(); ++k) {
    const bool is_known = k > 0 && events[k][0] == events[k - 1][0];
    if (!is_known) ++out.euler;
    if (is_known && squares.join(events[k][1], events[k - 1][1])) --out.parts;
  }
  return out;
}

/// Returns true if the far end of a thin region may lie in the cube. It may if another label can be closest to a point
/// on the region's axis, or within the region's width of it. Labels with the region's vertex as corner are ignored.
bool PartOfCube::may_end_inside(std::uint32_t v) const {
  const Vec3d at = solid_.mesh.vertices[v] - solid_.labels.centre();
  const Vec3d way = solid_.corners[v].rays[0][0];
  const Vec3d low = tree_.lattice.at(in_.cube.low) - solid_.labels.centre();
  const Vec3d high = tree_.lattice.at(in_.cube.high()) - solid_.labels.centre();
  double first = 0;
  double last = length(low - at) + length(high - low);
  const double width = LabelGeometry::thin * last + 4 * solid_.labels.rounding();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double enters = (low[axis] - width - at[axis]) / way[axis];
    double leaves = (high[axis] + width - at[axis]) / way[axis];
    if (enters > leaves) std::swap(enters, leaves);
    if (way[axis] == 0) continue;
    first = std::max(first, enters);
    last = std::min(last, leaves);
  }
  constexpr int samples = 16;
  const double step = (last - first) / samples;
  for (int k = 0; k < samples; ++k) {
    const double reach = first + (k + 0.5) * step;
    const Vec3d q = at + way * reach;
    const double enough = reach + step + 2 * width;
    const bool is_free = std::all_of(in_.cube.governors.begin(), in_.cube.governors.end(), [&](LabelIndex other) {
      return solid_.labels.has_corner(other, at) || length(solid_.labels.closest_point(other, q) - q) > enough;
    });
    if (!is_free) return true;
  }
  return false;
}

/// Adds the lines around which all walls are dropped: reflex edges, and normals of faces at reflex vertices. Each line
/// has one segment in the cube, whose Euler number is its number of ends on the boundary minus 1. Then adds points:
/// reflex vertices. Components of the axis that meet only at such a point are counted separately.
void PartOfCube::add_lines_and_points() {
  if (!solid_.rule.is_medial()) return;
  euler_ -= static_cast<std::int64_t>(corners_.size());
  for (const std::uint32_t edge : in_.edges) euler_ -= solid_.labels.site_of_edge(edge) ? 1 : 0;
  for (const auto& [edge, s] : in_.piercings) euler_ += solid_.labels.site_of_edge(edge) ? 1 : 0;
  for (const std::uint32_t v : in_.vertices) {
    if (!solid_.corners[v].edges.empty()) euler_ += 1 - solid_.corners[v].axis_parts();
  }
}

/// Numbers the components on the cube's boundary.
void PartOfCube::number_components(CubeCells& out) {
  out.vertices.assign(in_.vertices.begin(), in_.vertices.end());
  CubeNumbers numbers;
  for (std::uint32_t s = 0; s < in_.squares.size(); ++s) {
    numbers.add(in_.squares[s], std::move(parts_[s].component), first_[s], parts_[s].component_count, joined_, out);
  }
  for (const auto& [edge, s] : in_.piercings) {
    if (solid_.sites.turn[edge] == EdgeTurn::convex) out.squares[s].convex_edges.push_back(edge);
  }
}

}  // namespace blum::voronoi
