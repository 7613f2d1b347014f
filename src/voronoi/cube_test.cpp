#include "voronoi/cube_test.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "blum/core/union_find.hpp"
#include "voronoi/part_cube_test.hpp"

namespace blum::voronoi {

/// One run of CubeTest on a cube.
class CubeAnalysis {
 public:
  CubeAnalysis(const CubeTest& test, const GridCube& cube) : t_(test), cube_(cube) {}

  CubeCells run() {
    CubeCells out;
    out.obstacle = find_obstacle();
    if (out.obstacle != VoronoiObstacle::none) return out;
    if (!t_.solid_.rule.is_all()) return part_of(count_components());
    CubeNumbers numbers;
    for (const SquareOfCube& square : squares_) {
      numbers.add(square, square.cells.component, square.first_wall, square.cells.component_count, walls_, out);
    }
    return out;
  }

 private:
  using Square = SquareOfCube;
  /// A connected part of a site's region on the boundary of the cube.
  struct Region {
    std::uint32_t site = outside;
    bool exits = false;    ///< true if a segment from it to a footprint leaves the cube at once
    bool touches = false;  ///< true if the site itself meets the boundary in this part
  };
  /// A connected part of a face in the cube, and the regions that contain its points on the boundary.
  struct FacePart {
    std::uint32_t face = 0;
    std::set<std::uint32_t> touched;
  };

  [[nodiscard]] std::uint32_t count_components() {
    std::set<std::uint32_t> sets;
    for (const SquareOfCube& square : squares_) {
      for (std::uint32_t k = 0; k < square.cells.component_count; ++k) sets.insert(walls_.find(square.first_wall + k));
    }
    return static_cast<std::uint32_t>(sets.size());
  }

  /// Returns the components of the requested part of the diagram in the cube.
  [[nodiscard]] CubeCells part_of(std::uint32_t component_count) const {
    CubeContents in{cube_, squares_, component_count, vertices_, edges_, piercings_, parts_.size(), false};
    in.has_inner_face =
        std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part.second.touched.empty(); });
    CubeCells out;
    out.obstacle = PartOfCube(t_.solid_, t_.tree_, in).find(out);
    return out;
  }

  VoronoiObstacle find_obstacle() {
    if (!collect()) return VoronoiObstacle::square;
    join_across_edges();
    find_regions();
    if (!find_surface()) return VoronoiObstacle::contradiction;
    VoronoiObstacle obstacle = check_vertices();
    if (obstacle == VoronoiObstacle::none) obstacle = check_edges();
    if (obstacle == VoronoiObstacle::none) obstacle = check_faces();
    if (obstacle == VoronoiObstacle::none) obstacle = check_solid();
    if (obstacle == VoronoiObstacle::none) obstacle = check_joins();
    return obstacle;
  }

  bool collect() {
    bool is_resolved = true;
    std::uint32_t pieces = 0;
    std::uint32_t walls = 0;
    std::uint32_t bodies = 0;
    for (std::uint32_t side = 0; side < 6; ++side) {
      t_.tree_.visit_leaf_squares(cube_.squares[side], [&](CellId id) {
        const GridSquare& square = t_.tree_.squares[id];
        if (square.state != SquareState::resolved) is_resolved = false;
        if (!is_resolved) return;
        Square made{id, side, square_cells(t_.tree_, t_.labels_, square), pieces, walls, bodies};
        pieces += static_cast<std::uint32_t>(made.cells.pieces.size());
        walls += made.cells.component_count;
        bodies += made.cells.body_count;
        squares_.push_back(std::move(made));
      });
    }
    pieces_.reset(pieces);
    walls_.reset(walls);
    bodies_.reset(bodies);
    return is_resolved;
  }

  /// Joins pieces, bodies and walls of two squares that share an arc or event of a grid edge.
  void join_across_edges() {
    struct AtArc {
      EdgeArc arc;
      std::uint32_t piece, body;
      LabelIndex label;
    };
    std::vector<AtArc> arcs;
    std::vector<std::array<std::uint32_t, 2>> events;
    for (const Square& square : squares_) {
      for (const auto& [arc, run] : square.cells.arcs) {
        const SquareCells::Run& of = square.cells.runs[run];
        arcs.push_back({arc, square.first_piece + of.piece, square.first_body + of.body, of.label});
      }
      for (std::size_t k = 0; k < square.cells.events.size(); ++k) {
        events.push_back({square.cells.events[k], square.first_wall + square.cells.component[k]});
      }
    }
    std::sort(arcs.begin(), arcs.end(), [](const AtArc& a, const AtArc& b) { return a.arc < b.arc; });
    std::sort(events.begin(), events.end());
    for (std::size_t k = 1; k < arcs.size(); ++k) {
      if (arcs[k].arc != arcs[k - 1].arc) continue;
      pieces_.join(arcs[k].piece, arcs[k - 1].piece);
      bodies_.join(arcs[k].body, arcs[k - 1].body);
      if (arcs[k].label != outside) inside_arcs_.emplace_back(arcs[k].arc, arcs[k].body);
    }
    for (std::size_t k = 1; k < events.size(); ++k) {
      if (events[k][0] != events[k - 1][0]) continue;
      walls_.join(events[k][1], events[k - 1][1]);
      wall_of_event_.push_back(events[k]);
    }
  }

  void find_regions() {
    std::uint32_t count = 0;
    for (const Square& square : squares_) count += static_cast<std::uint32_t>(square.cells.pieces.size());
    std::vector<std::uint32_t> number(count, outside);
    region_of_.assign(count, outside);
    for (const Square& square : squares_) {
      for (std::uint32_t k = 0; k < square.cells.pieces.size(); ++k) {
        const std::uint32_t site = square.cells.pieces[k].site;
        if (site == outside) continue;
        std::uint32_t& region = number[pieces_.find(square.first_piece + k)];
        if (region == outside) {
          region = static_cast<std::uint32_t>(regions_.size());
          regions_.push_back({site, false, false});
        }
        region_of_[square.first_piece + k] = region;
      }
      find_exits(square);
    }
    for (std::uint32_t r = 0; r < regions_.size(); ++r) regions_of_site_[regions_[r].site].push_back(r);
  }

  /// Marks regions with a segment to a footprint that leaves the cube at once. In one square, the segments to a face
  /// either all leave or all stay.
  void find_exits(const Square& square) {
    const std::size_t axis = square.side / 2;
    const double outwards = square.side % 2 == 1 ? 1 : -1;
    const double plane = t_.tree_.lattice.at(axis, t_.tree_.squares[square.id].low[axis]) - t_.labels_.centre()[axis];
    for (const auto& [arc, run] : square.cells.arcs) {
      const SquareCells::Run& of = square.cells.runs[run];
      if (of.label == outside) continue;
      Region& region = regions_[region_of_[square.first_piece + of.piece]];
      if (region.exits) continue;
      const PlacedLabel& label = t_.labels_[of.label];
      if (label.kind == SiteKind::face) {
        region.exits = is_lower_side(square.side, label.direction);
      } else {
        const auto [low, high] = ends(arc);
        for (const Vec3d& q : {low, (low + high) * 0.5, high}) {
          if ((label.foot(q)[axis] - plane) * outwards > 4 * t_.labels_.rounding()) region.exits = true;
        }
      }
    }
  }

  /// Returns the ends of an arc, each moved inwards by 1 % of its length. They are relative to the centre of the
  /// labels.
  [[nodiscard]] std::array<Vec3d, 2> ends(const EdgeArc& arc) const {
    const GridEdge& edge = t_.tree_.edges[arc.edge];
    const Vec3d at = t_.tree_.lattice.at(edge.low);
    double low = at[edge.axis];
    double high = t_.tree_.lattice.at(edge.high())[edge.axis];
    const std::uint32_t k = edge.first_event + arc.index;
    if (arc.index > 0) low = t_.tree_.events[k - 1].upper();
    if (k < edge.last_event) high = t_.tree_.events[k].at;
    Vec3d p = at;
    Vec3d q = at;
    p[edge.axis] = low + (high - low) * 0.01;
    q[edge.axis] = high - (high - low) * 0.01;
    return {p - t_.labels_.centre(), q - t_.labels_.centre()};
  }

  [[nodiscard]] std::optional<std::uint32_t> region_in(const Square& square, std::uint32_t site) const {
    for (std::uint32_t k = 0; k < square.cells.pieces.size(); ++k) {
      if (square.cells.pieces[k].site == site) return region_of_[square.first_piece + k];
    }
    return std::nullopt;
  }

  /// Finds the edges, vertices and triangles that meet the cube, and where the surface meets the cube's boundary.
  /// Returns false if a triangle is missing, or if a site crosses a square in which it has no region.
  bool find_surface() {
    if (cube_.triangles.empty()) return true;
    const SiteTable& table = t_.surface_.table();
    edges_ = t_.surface_.edges_of(cube_.triangles);
    for (const std::uint32_t edge : edges_) {
      for (const std::uint32_t v : table.edges()[edge]) vertices_.push_back(v);
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    std::erase_if(vertices_, [&](std::uint32_t v) { return !t_.surface_.is_in(v, cube_); });
    std::vector<std::uint32_t> met;
    for (const std::uint32_t edge : edges_) {
      const Segment& ends = table.edges()[edge];
      bool meets = is_inside(ends[0]) || is_inside(ends[1]);
      for (std::uint32_t s = 0; s < squares_.size(); ++s) {
        if (!t_.surface_.pierces(edge, t_.tree_.squares[squares_[s].id])) continue;
        meets = true;
        piercings_.push_back({edge, s});
      }
      if (meets) met.push_back(edge);
    }
    edges_ = std::move(met);
    return find_triangles() && mark_touches();
  }

  [[nodiscard]] bool is_inside(std::uint32_t vertex) const {
    return std::binary_search(vertices_.begin(), vertices_.end(), vertex);
  }
  [[nodiscard]] bool meets(std::uint32_t edge) const { return std::binary_search(edges_.begin(), edges_.end(), edge); }

  /// Finds the triangles that meet the cube: one of their edges does, or an edge of the cube crosses them. Returns
  /// false if a triangle at a found edge or crossing is not among them.
  bool find_triangles() {
    const SiteTable& table = t_.surface_.table();
    for (std::uint32_t s = 0; s < squares_.size(); ++s) {
      for (const std::uint32_t event : squares_[s].cells.events) {
        const std::optional<LabelIndex> triangle = t_.tree_.events[event].crossed();
        if (triangle) crossings_.push_back({*triangle, s, event});
      }
    }
    std::sort(crossings_.begin(), crossings_.end());
    for (const std::uint32_t t : cube_.triangles) {
      const auto& edges = table.triangle_edges()[t];
      const bool by_edge = std::any_of(edges.begin(), edges.end(), [&](EdgeId edge) { return meets(edge.value); });
      const auto at = std::lower_bound(crossings_.begin(), crossings_.end(), std::array<std::uint32_t, 3>{t, 0, 0});
      if (by_edge || (at != crossings_.end() && (*at)[0] == t)) triangles_.push_back(t);
    }
    std::sort(triangles_.begin(), triangles_.end());
    // Triangles that share an edge in the cube belong to the same part of the surface, and of a face if the edge is
    // flat.
    const auto count = static_cast<std::uint32_t>(triangles_.size());
    sheets_.reset(count);
    face_parts_.reset(count);
    for (const std::uint32_t edge : edges_) {
      const auto [first, second] = t_.sites_.triangles_of[edge];
      if (!is_listed(first) || !is_listed(second)) return false;
      sheets_.join(rank(first), rank(second));
      if (t_.sites_.turn[edge] == EdgeTurn::flat) face_parts_.join(rank(first), rank(second));
    }
    return std::all_of(crossings_.begin(), crossings_.end(),
                       [&](const auto& crossing) { return is_listed(crossing[0]); });
  }

  [[nodiscard]] bool is_listed(std::uint32_t triangle) const {
    return std::binary_search(triangles_.begin(), triangles_.end(), triangle);
  }
  [[nodiscard]] std::uint32_t rank(std::uint32_t triangle) const {
    return static_cast<std::uint32_t>(std::lower_bound(triangles_.begin(), triangles_.end(), triangle) -
                                      triangles_.begin());
  }

  bool mark_touches() {
    const auto touch_face = [&](std::uint32_t triangle, std::uint32_t s) {
      const std::optional<std::uint32_t> region = region_in(squares_[s], t_.sites_.face_of[triangle]);
      if (!region) return false;
      regions_[*region].touches = true;
      FacePart& part = parts_[face_parts_.find(rank(triangle))];
      part.touched.insert(*region);
      return true;
    };
    for (const std::uint32_t t : triangles_) parts_[face_parts_.find(rank(t))].face = t_.sites_.face_of[t];
    for (const auto& [triangle, s, event] : crossings_) {
      if (!touch_face(triangle, s)) return false;
    }
    for (const auto& [edge, s] : piercings_) {
      for (const std::uint32_t t : t_.sites_.triangles_of[edge]) {
        if (!touch_face(t, s)) return false;
      }
      const std::optional<std::uint32_t> site = t_.labels_.site_of_edge(edge);
      if (!site) continue;
      const std::optional<std::uint32_t> region = region_in(squares_[s], *site);
      if (!region) return false;
      regions_[*region].touches = true;
      touched_by_edge_[edge].insert(*region);
    }
    return true;
  }

  [[nodiscard]] bool is_edge_site(std::uint32_t site) const {
    return site >= t_.sites_.face_count && site < t_.sites_.face_count + t_.sites_.reflex_edges.size();
  }

  /// Tests the regions of vertices. The region of a vertex is convex; it passes if it has exactly one part on the
  /// boundary.
  VoronoiObstacle check_vertices() {
    const std::size_t first = t_.sites_.face_count + t_.sites_.reflex_edges.size();
    for (auto at = regions_of_site_.lower_bound(static_cast<std::uint32_t>(first)); at != regions_of_site_.end();
         ++at) {
      if (at->second.size() != 1) return VoronoiObstacle::tunnel;
    }
    for (const std::uint32_t v : vertices_) {
      const std::optional<std::uint32_t> site = t_.labels_.site_of_vertex(v);
      if (site && !regions_of_site_.contains(*site)) return VoronoiObstacle::enclosed;
    }
    return VoronoiObstacle::none;
  }

  /// Returns the number of a site's regions that neither exit nor touch the site.
  [[nodiscard]] std::size_t count_closed(const std::vector<std::uint32_t>& regions) const {
    return static_cast<std::size_t>(std::count_if(
        regions.begin(), regions.end(), [&](std::uint32_t r) { return !regions_[r].exits && !regions_[r].touches; }));
  }

  VoronoiObstacle check_edges() {
    std::set<std::uint32_t> inside;  // sites of edges that lie wholly inside the cube
    for (const std::uint32_t edge : edges_) {
      const std::optional<std::uint32_t> site = t_.labels_.site_of_edge(edge);
      if (!site) continue;
      const auto touched = touched_by_edge_.find(edge);
      if (touched == touched_by_edge_.end()) {
        inside.insert(*site);
      } else if (touched->second.size() != 1) {
        return VoronoiObstacle::tunnel;
      }
    }
    for (const auto& [site, regions] : regions_of_site_) {
      if (!is_edge_site(site)) continue;
      const bool is_in = inside.erase(site) > 0;
      if (count_closed(regions) != (is_in ? 1U : 0U)) return VoronoiObstacle::tunnel;
    }
    return inside.empty() ? VoronoiObstacle::none : VoronoiObstacle::enclosed;
  }

  VoronoiObstacle check_faces() {
    std::set<std::uint32_t> inside;  // faces with a part that does not reach the cube's boundary
    for (const auto& [root, part] : parts_) {
      if (has_hole_near(part.face)) return VoronoiObstacle::face_hole;
      if (part.touched.empty()) {
        inside.insert(part.face);
      } else if (part.touched.size() != 1) {
        return VoronoiObstacle::tunnel;
      }
    }
    for (const auto& [site, regions] : regions_of_site_) {
      if (site >= t_.sites_.face_count) break;
      const bool is_in = inside.erase(site) > 0;
      if (count_closed(regions) != (is_in ? 1U : 0U)) return VoronoiObstacle::tunnel;
    }
    return inside.empty() ? VoronoiObstacle::none : VoronoiObstacle::enclosed;
  }

  /// Returns true if the face has holes, and one of its loops, projected along the normal, may lie wholly in the
  /// projected cube.
  [[nodiscard]] bool has_hole_near(std::uint32_t face) const {
    const auto loops = t_.loops_.of(face);
    if (loops.size() < 2) return false;
    const double half = 0.5 * t_.tree_.lattice.unit * cube_.length;
    const Vec3d middle = t_.tree_.lattice.at(cube_.low) + Vec3d{half, half, half} - t_.labels_.centre();
    // The projection of the cube to the face's plane lies in a disc of this radius.
    const double reach = std::numbers::sqrt3 * half * (1 + 1e-12) + 4 * t_.labels_.rounding();
    const auto found = std::find_if(triangles_.begin(), triangles_.end(),
                                    [&](std::uint32_t t) { return t_.sites_.face_of[t] == face; });
    const Vec3d& normal = t_.labels_[*found].direction;
    return std::any_of(loops.begin(), loops.end(), [&](const std::vector<std::uint32_t>& loop) {
      return std::all_of(loop.begin(), loop.end(), [&](std::uint32_t v) {
        const Vec3d away = t_.mesh_.vertices[v] - t_.labels_.centre() - middle;
        return length(away - normal * dot(normal, away)) < reach;
      });
    });
  }

  /// Tests that all components of the solid in the cube are balls: each must have one boundary, of Euler number 2.
  VoronoiObstacle check_solid() {
    if (triangles_.empty()) return VoronoiObstacle::none;
    bodies_on_boundary_ = 0;
    std::uint32_t body_count = 0;
    for (const Square& square : squares_) body_count += square.cells.body_count;
    // The components on the cube's boundary come first, then the parts of the surface.
    detail::UnionFind joined(body_count + triangles_.size());
    const auto body = [&](std::uint32_t k) { return bodies_.find(k); };
    const auto sheet = [&](std::uint32_t triangle) { return body_count + sheets_.find(rank(triangle)); };
    std::vector<bool> is_solid(body_count, false);
    std::vector<std::pair<std::uint32_t, int>> sums;  // component, 1 or -1 for a cell
    for (const Square& square : squares_) {
      std::vector<bool> is_counted(square.cells.body_count, false);
      for (const SquareCells::Run& run : square.cells.runs) {
        if (run.label == outside || is_counted[run.body]) continue;
        is_counted[run.body] = true;
        is_solid[body(square.first_body + run.body)] = true;
        sums.emplace_back(body(square.first_body + run.body), 1);
      }
    }
    for (std::uint32_t k = 0; k < body_count; ++k) bodies_on_boundary_ += is_solid[k] ? 1U : 0U;
    add_intervals(sums, body);
    std::set<std::uint32_t> bounded;  // parts of the surface that reach the cube's boundary
    for (const auto& [arc, of] : inside_arcs_) {
      const GridEdge& edge = t_.tree_.edges[arc.edge];
      const std::uint32_t k = edge.first_event + arc.index;
      const auto meet = [&, body_of_arc = of](std::uint32_t triangle) {
        joined.join(body(body_of_arc), sheet(triangle));
        bounded.insert(sheets_.find(rank(triangle)));
      };
      if (k < edge.last_event && t_.tree_.events[k].after == outside) meet(t_.tree_.events[k].before);
      if (arc.index > 0 && t_.tree_.events[k - 1].before == outside) meet(t_.tree_.events[k - 1].after);
    }
    for (const std::uint32_t t : triangles_) {
      if (!bounded.contains(sheets_.find(rank(t)))) return VoronoiObstacle::handle;
      sums.emplace_back(sheet(t), 1);
    }
    for (const std::uint32_t edge : edges_) sums.emplace_back(sheet(t_.sites_.triangles_of[edge][0]), -1);
    for (const std::uint32_t v : vertices_) {
      const auto at = std::find_if(triangles_.begin(), triangles_.end(), [&](std::uint32_t t) {
        const Triangle& corners = t_.mesh_.triangles[t];
        return corners[0] == v || corners[1] == v || corners[2] == v;
      });
      sums.emplace_back(sheet(*at), 1);
    }
    std::map<std::uint32_t, int> euler;
    for (const auto& [component, sign] : sums) euler[joined.find(component)] += sign;
    bodies_inside_ = static_cast<std::uint32_t>(euler.size());
    for (const auto& [component, sum] : euler) {
      if (sum != 2) return VoronoiObstacle::handle;
    }
    return VoronoiObstacle::none;
  }

  /// Adds to `sums` -1 for each interval of a grid edge inside the solid, and 1 for each node inside.
  template <class Body>
  void add_intervals(std::vector<std::pair<std::uint32_t, int>>& sums, const Body& body) const {
    std::set<std::array<std::uint32_t, 3>> nodes;
    for (const auto& [arc, of] : inside_arcs_) {
      const GridEdge& edge = t_.tree_.edges[arc.edge];
      const std::uint32_t k = edge.first_event + arc.index;
      const bool begins = arc.index == 0 || t_.tree_.events[k - 1].before == outside;
      if (begins) sums.emplace_back(body(of), -1);
      if (arc.index == 0 && nodes.insert(edge.low).second) sums.emplace_back(body(of), 1);
      const Node end = edge.high();
      if (k == edge.last_event && nodes.insert(end).second) sums.emplace_back(body(of), 1);
    }
  }

  /// Joins components of walls and surface on the boundary that a part of the surface connects inside the cube. Then a
  /// count decides whether other components are connected inside.
  VoronoiObstacle check_joins() {
    std::set<std::uint32_t> before;
    for (const auto& [event, wall] : wall_of_event_) before.insert(walls_.find(wall));
    if (before.size() < 2) return VoronoiObstacle::none;
    std::map<std::uint32_t, std::uint32_t> first;
    for (const auto& [triangle, s, event] : crossings_) {
      const std::uint32_t wall = wall_of(event);
      const auto [at, is_new] = first.try_emplace(sheets_.find(rank(triangle)), wall);
      if (!is_new) walls_.join(wall, at->second);
    }
    std::set<std::uint32_t> now;
    for (const std::uint32_t wall : before) now.insert(walls_.find(wall));
    if (now.size() < 2) return VoronoiObstacle::none;
    // The number of joins equals the number of tunnels of all regions and of the outside.
    std::int64_t joins = bodies_on_boundary_ - bodies_inside_;
    for (const auto& [site, regions] : regions_of_site_) {
      if (site < t_.sites_.face_count) joins += tunnels(site, regions.size());
    }
    const auto left = static_cast<std::int64_t>(before.size()) - joins;
    if (left == static_cast<std::int64_t>(now.size())) return VoronoiObstacle::none;
    if (left != 1) return VoronoiObstacle::joins;
    for (const std::uint32_t wall : now) walls_.join(wall, *now.begin());
    return VoronoiObstacle::none;
  }

  /// The part of the cube's lower sides (those that look away from a face's normal) that the face's region covers.
  struct LowerPart {
    std::int64_t pieces = 0;
    std::map<EdgeArc, int> arcs;          ///< by arc: number of lower squares at it
    std::map<std::uint32_t, int> events;  ///< by crossing of the face with a grid edge: number of lower squares at it
    std::int64_t ends = 0;                ///< number of ends of segments in which the face meets lower squares
  };

  void add_square(const SquareCells& cells, std::uint32_t face, LowerPart& out) const {
    for (const SquareCells::Piece& piece : cells.pieces) out.pieces += piece.site == face ? 1 : 0;
    for (const auto& [arc, run] : cells.arcs) {
      if (cells.pieces[cells.runs[run].piece].site == face) ++out.arcs[arc];
    }
    for (const std::uint32_t event : cells.events) {
      const std::optional<LabelIndex> triangle = t_.tree_.events[event].crossed();
      if (!triangle || t_.labels_[*triangle].site != face) continue;
      ++out.events[event];
      ++out.ends;
    }
  }

  [[nodiscard]] LowerPart lower_part(std::uint32_t face) const {
    const Vec3d& normal = normal_of(face);
    LowerPart out;
    for (const Square& square : squares_) {
      if (is_lower_side(square.side, normal)) add_square(square.cells, face, out);
    }
    for (const auto& [edge, s] : piercings_) {
      if (!is_lower_side(squares_[s].side, normal) || t_.sites_.turn[edge] == EdgeTurn::flat) continue;
      for (const std::uint32_t t : t_.sites_.triangles_of[edge]) out.ends += t_.sites_.face_of[t] == face ? 1 : 0;
    }
    return out;
  }

  /// Returns the number of grid nodes that the region covers completely: each arc of the region at the node has lower
  /// squares on both sides.
  [[nodiscard]] std::int64_t nodes_amid(const std::map<EdgeArc, int>& arcs) const {
    std::map<Node, bool> is_on_rim;
    for (const auto& [arc, count] : arcs) {
      const GridEdge& edge = t_.tree_.edges[arc.edge];
      const Node end = edge.high();
      if (arc.index == 0) is_on_rim[edge.low] = is_on_rim[edge.low] || count < 2;
      if (edge.first_event + arc.index == edge.last_event) is_on_rim[end] = is_on_rim[end] || count < 2;
    }
    return std::count_if(is_on_rim.begin(), is_on_rim.end(), [](const auto& node) { return !node.second; });
  }

  /// Returns the number of tunnels of a face's region in the cube. Along the normal, the region extends from the face,
  /// or from the cube's lower sides, up to walls. So the region retracts to the part that it covers on the face and on
  /// the lower sides. The Euler number of this covered part is a sum over cells.
  /// @param components  number of components of the region in the cube.
  [[nodiscard]] std::int64_t tunnels(std::uint32_t face, std::size_t components) const {
    const LowerPart lower = lower_part(face);
    const auto is_shared = [](const auto& counted) { return counted.second == 2; };
    std::int64_t euler = lower.pieces + nodes_amid(lower.arcs) - lower.ends / 2;
    euler -= std::count_if(lower.arcs.begin(), lower.arcs.end(), is_shared);
    euler += std::count_if(lower.events.begin(), lower.events.end(), is_shared);
    for (const auto& [root, part] : parts_) euler += part.face == face ? 1 : 0;
    return static_cast<std::int64_t>(components) - euler;
  }

  [[nodiscard]] const Vec3d& normal_of(std::uint32_t face) const {
    for (const Square& square : squares_) {
      for (const SquareCells::Run& run : square.cells.runs) {
        if (run.label != outside && t_.labels_[run.label].site == face) return t_.labels_[run.label].direction;
      }
    }
    return t_.labels_[0].direction;  // not reached, because the face has a region on the boundary
  }

  [[nodiscard]] std::uint32_t wall_of(std::uint32_t event) const {
    return std::lower_bound(wall_of_event_.begin(), wall_of_event_.end(), std::array<std::uint32_t, 2>{event, 0})
        ->at(1);
  }

  const CubeTest& t_;
  const GridCube& cube_;
  std::vector<Square> squares_;
  detail::UnionFind pieces_, walls_, bodies_;
  std::vector<std::pair<EdgeArc, std::uint32_t>> inside_arcs_;  ///< arcs in the solid, and the bodies that contain them
  std::vector<std::array<std::uint32_t, 2>> wall_of_event_;     ///< (event, wall), sorted
  std::vector<std::uint32_t> region_of_;                        ///< for each piece
  std::vector<Region> regions_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> regions_of_site_;
  std::vector<std::uint32_t> vertices_, edges_, triangles_;  ///< of the mesh, in the cube; ascending
  std::vector<std::array<std::uint32_t, 2>> piercings_;      ///< (edge of the mesh, square)
  std::vector<std::array<std::uint32_t, 3>> crossings_;      ///< (triangle, square, event)
  detail::UnionFind sheets_, face_parts_;                    ///< over triangles_
  std::map<std::uint32_t, FacePart> parts_;
  std::map<std::uint32_t, std::set<std::uint32_t>> touched_by_edge_;
  std::uint32_t bodies_on_boundary_ = 0;
  std::uint32_t bodies_inside_ = 0;
};

void CubeNumbers::add(const SquareOfCube& square, std::vector<std::uint32_t> component_of_event, std::uint32_t first,
                      std::uint32_t count, detail::UnionFind& joined, CubeCells& out) {
  CubeCells::Square& made = out.squares.emplace_back();
  made.square = square.id;
  made.events = square.cells.events;
  made.component_of_event = std::move(component_of_event);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto [at, is_new] = number_.try_emplace(joined.find(first + k), out.component_count);
    if (is_new) ++out.component_count;
    made.component.push_back(at->second);
  }
}

CubeCells CubeTest::run(const GridCube& cube) const {
  return CubeAnalysis(*this, cube).run();
}

}  // namespace blum::voronoi
