#include "voronoi/subdivision.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {
namespace {

constexpr std::size_t splitter_grain = 16;

/// Returns true if a triangle may meet a closed box. Tests the triangle's bounding box and its plane.
bool may_meet(const MeshView& mesh, const LabelGeometry& labels, std::uint32_t t, const Box3& box) {
  const std::array<Vec3d, 3> p = triangle_corners(mesh, t);
  const Vec3d low = min(p[0], min(p[1], p[2]));
  const Vec3d high = max(p[0], max(p[1], p[2]));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (high[axis] < box.lower[axis] || low[axis] > box.upper[axis]) return false;
  }
  const Vec3d half = box.size() * 0.5;
  const Vec3d& n = labels[t].direction;
  const double reach = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
  return !(std::abs(labels[t].height(box.center() - labels.centre())) > reach + 2 * labels.rounding());
}

constexpr std::size_t grain = 8;

class Subdivider {
 public:
  Subdivider(const VoronoiSolid& solid, const SubdivisionOptions& options, Subdivision& out, const Context& context)
      : solid_(solid),
        options_(options),
        out_(out),
        context_(context),
        splitter_(solid.mesh, solid.exact, solid.labels, out.tree),
        surface_(solid.mesh, solid.table, out.tree.lattice),
        square_test_(solid.labels, surface_, out.tree),
        part_test_(solid, square_test_, surface_, out.tree),
        cube_test_(solid, surface_, out.tree) {}

  void run(const Refine& refine) {
    splitter_.add_root(options_.grid);
    waiting_[0] = {0};
    divide_all();
    out_.passed_at_first = out_.failing.empty();
    constexpr int most_rounds = 6;
    std::vector<CellId> seen;  // all leaves of earlier rounds, ascending
    for (int round = 0; round < most_rounds && out_.failing.empty() && !is_full(); ++round) {
      std::vector<CellId> all = out_.leaves;
      std::sort(all.begin(), all.end());
      std::vector<CellId> fresh;
      std::set_difference(all.begin(), all.end(), seen.begin(), seen.end(), std::back_inserter(fresh));
      seen = std::move(all);
      const std::vector<CellId> cubes = refine(out_.tree, fresh);
      if (cubes.empty() || out_.tree.cubes.size() + 8 * cubes.size() > options_.most_cubes) break;
      split_leaves(cubes);
      divide_all();
    }
    out_.lines = splitter_.counts();
    out_.contradictions = splitter_.contradictions();
    for (const CellId leaf : out_.leaves) out_.governors += out_.tree.cubes[leaf].governors.size();
  }

 private:
  [[nodiscard]] std::uint32_t count_squares(const GridCube& cube) const {
    std::uint32_t count = 0;
    for (const CellId square : cube.squares) out_.tree.visit_leaf_squares(square, [&](CellId) { ++count; });
    return count;
  }

  /// Divides the waiting cubes. After a cube passes, its neighbour may split their common squares. Then more of the
  /// cube's boundary is known, so the cube is tested again.
  void divide_all() {
    divide();
    for (;;) {
      std::vector<CellId> changed;
      for (const CellId leaf : out_.leaves) {
        const GridCube& cube = out_.tree.cubes[leaf];
        if (cube.state == CubeState::passed && count_squares(cube) != cube.tested_squares) changed.push_back(leaf);
      }
      if (changed.empty()) return;
      std::sort(changed.begin(), changed.end());
      std::erase_if(out_.leaves, [&](CellId leaf) { return std::binary_search(changed.begin(), changed.end(), leaf); });
      for (const CellId cube : changed) waiting_[depth_of(cube)].push_back(cube);
      divide();
    }
  }

  /// Tests the waiting cubes, the largest first, and splits those that fail.
  void divide() {
    while (!waiting_.empty()) {
      const auto [depth, cubes] = *waiting_.begin();
      waiting_.erase(waiting_.begin());
      divide(depth, cubes);
    }
  }

  /// @param cubes  all of the size that belongs to `depth`.
  void divide(int depth, const std::vector<CellId>& cubes) {
    const bool is_last = depth >= options_.most_depth || is_full();
    std::vector<CellId> to_test;
    std::vector<CellId> crowded;
    for (const CellId cube : cubes) {
      (!is_last && is_crowded(out_.tree.cubes[cube], depth) ? crowded : to_test).push_back(cube);
    }
    std::vector<FailingCube> failed = test(to_test);
    if (!is_last && out_.tree.cubes.size() + 8 * (crowded.size() + failed.size()) <= options_.most_cubes) {
      out_.splits += failed.size();
      for (const FailingCube& one : failed) crowded.push_back(one.cube);
      std::sort(crowded.begin(), crowded.end());
      split(depth, crowded);
      return;
    }
    out_.was_full = out_.was_full || !is_last;
    const std::vector<FailingCube> more = test(crowded);
    failed.insert(failed.end(), more.begin(), more.end());
    for (const FailingCube& one : failed) out_.leaves.push_back(one.cube);
    out_.failing.insert(out_.failing.end(), failed.begin(), failed.end());
  }

  void split(int depth, const std::vector<CellId>& cubes) {
    splitter_.split_cubes(cubes, context_);
    for (const CellId cube : cubes) {
      for (CellId k = 0; k < 8; ++k) {
        const CellId child = out_.tree.cubes[cube].children + k;
        if (out_.tree.cubes[child].state != CubeState::trivial) waiting_[depth + 1].push_back(child);
      }
    }
  }

  [[nodiscard]] int depth_of(CellId cube) const {
    int depth = 0;
    while (out_.tree.cubes[cube].length << depth < Lattice::most) ++depth;
    return depth;
  }

  /// Splits leaves that pass but are too large.
  void split_leaves(const std::vector<CellId>& cubes) {
    std::map<int, std::vector<CellId>> by_depth;
    std::vector<CellId> gone;
    for (const CellId cube : cubes) {
      if (depth_of(cube) >= options_.most_depth) continue;
      by_depth[depth_of(cube)].push_back(cube);
      gone.push_back(cube);
    }
    std::sort(gone.begin(), gone.end());
    std::erase_if(out_.leaves, [&](CellId leaf) { return std::binary_search(gone.begin(), gone.end(), leaf); });
    for (auto& [depth, of_depth] : by_depth) {
      std::sort(of_depth.begin(), of_depth.end());
      split(depth, of_depth);
    }
  }

  /// Returns true if a cube may contain points of the requested part of the diagram.
  [[nodiscard]] bool may_hold_some(const GridCube& cube) const {
    if (solid_.rule.is_all()) return true;
    return std::any_of(cube.governors.begin(), cube.governors.end(), [&](LabelIndex label) {
      return solid_.labels[label].site != solid_.labels[cube.governors.front()].site;
    });
  }

  /// Returns true if a cube has too many governors for its test, and splits have reduced their number so far. Also
  /// returns true if the cube is less deep than the least depth and may contain points of the requested part.
  [[nodiscard]] bool is_crowded(const GridCube& cube, int depth) const {
    constexpr std::size_t many = 64;
    if (depth < 1) return true;
    if (depth < options_.least_depth && may_hold_some(cube)) return true;
    return cube.governors.size() > many && cube.governors.size() * 10 < cube.governors_of_parent * 9;
  }

  /// Returns true if no more cells may be made, because there are too many squares, or too many uncertain lines and
  /// nodes.
  [[nodiscard]] bool is_full() const {
    constexpr std::size_t squares_per_cube = 16;
    return out_.tree.squares.size() > squares_per_cube * options_.most_cubes ||
           splitter_.counts().undecided + splitter_.contradictions() > Subdivision::most_undecided;
  }

  /// Splits squares on the boundaries of cubes until each square is resolved or has the least size.
  void resolve_squares(const std::vector<CellId>& cubes) {
    std::vector<CellId> squares;
    for (const CellId cube : cubes) {
      for (const CellId square : out_.tree.cubes[cube].squares) {
        out_.tree.visit_leaf_squares(square, [&](CellId leaf) { squares.push_back(leaf); });
      }
    }
    const std::uint32_t length = cubes.empty() ? 1 : out_.tree.cubes[cubes.front()].length;
    const std::uint32_t least = std::max<std::uint32_t>(2, length >> options_.most_square_depth);
    while (!squares.empty()) {
      std::sort(squares.begin(), squares.end());
      squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
      std::erase_if(squares, [&](CellId id) { return out_.tree.squares[id].state == SquareState::resolved; });
      std::vector<std::uint8_t> is_left(squares.size());
      parallel_for(context_, squares.size(), grain, {}, [&](const WorkRange& range) {
        for (std::size_t k = range.begin; k < range.end; ++k) {
          is_left[k] = part_test_.resolve(out_.tree.squares[squares[k]]) ? 0 : 1;
        }
      });
      std::vector<CellId> left;
      for (std::size_t k = 0; k < squares.size(); ++k) {
        if (is_left[k] != 0 && out_.tree.squares[squares[k]].length >= 2 * least) left.push_back(squares[k]);
      }
      if (is_full()) return;
      splitter_.split_squares(left, context_);
      squares.clear();
      for (const CellId square : left) {
        for (CellId k = 0; k < 4; ++k) squares.push_back(out_.tree.squares[square].children + k);
      }
    }
  }

  /// Tests cubes. Adds those that pass to the leaves; returns the others.
  std::vector<FailingCube> test(const std::vector<CellId>& cubes) {
    resolve_squares(cubes);
    std::vector<VoronoiObstacle> obstacles(cubes.size());
    parallel_for(context_, cubes.size(), grain, {}, [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        obstacles[k] = cube_test_.run(out_.tree.cubes[cubes[k]]).obstacle;
      }
    });
    std::vector<FailingCube> failed;
    for (std::size_t k = 0; k < cubes.size(); ++k) {
      GridCube& cube = out_.tree.cubes[cubes[k]];
      cube.tested_squares = count_squares(cube);
      if (obstacles[k] == VoronoiObstacle::none) {
        cube.state = CubeState::passed;
        out_.leaves.push_back(cubes[k]);
      } else {
        cube.state = CubeState::failed;
        failed.push_back({cubes[k], obstacles[k]});
      }
    }
    return failed;
  }

  const VoronoiSolid& solid_;
  const SubdivisionOptions& options_;
  Subdivision& out_;
  const Context& context_;
  CellSplitter splitter_;
  SurfaceInCells surface_;
  SquareTest square_test_;
  PartSquareTest part_test_;
  CubeTest cube_test_;
  std::map<int, std::vector<CellId>> waiting_;  ///< cubes to test, by depth
};

}  // namespace

void CellSplitter::add_root(int grid) {
  const Box3& box = labels_.box();
  const Vec3d size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  // Planes of the grid must not coincide with features of typical shapes, at simple fractions of their size. The planes
  // must not coincide with seams between faces either, which often lie at square roots. So the shifts along the three
  // axes are derived from gamma, e and 1 / pi.
  const Vec3d fractions{std::numbers::egamma, std::numbers::e - 2, std::numbers::inv_pi};
  Vec3d shift;
  for (std::size_t axis = 0; axis < 3; ++axis) shift[axis] = std::fmod(fractions[axis] * (grid + 1), 1.0) - 0.5;
  const double side = longest * side_of_root;
  tree_.lattice.origin = box.center() - Vec3d{side, side, side} * 0.5 + shift * (0.2 * longest);
  tree_.lattice.unit = side / Lattice::most;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (CellId k = 0; k < 4; ++k) {
      GridEdge edge;
      edge.axis = static_cast<std::uint8_t>(axis);
      edge.length = Lattice::most;
      edge.low[next_axis(axis)] = (k & 1U) != 0 ? Lattice::most : 0;
      edge.low[next_axis(next_axis(axis))] = (k & 2U) != 0 ? Lattice::most : 0;
      tree_.edges.push_back(edge);
    }
  }
  GridCube cube;
  cube.length = Lattice::most;
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = next_axis(axis);
    const std::size_t v = next_axis(u);
    for (std::uint32_t side_k = 0; side_k < 2; ++side_k) {
      GridSquare square;
      square.axis = axis;
      square.length = Lattice::most;
      square.low[axis] = side_k * Lattice::most;
      square.state = SquareState::resolved;  // the whole square is outside
      // The four edges along u are ordered by v, then axis. The four edges along v are ordered by axis, then u.
      const auto along_u = [&](CellId at_v) { return static_cast<CellId>(4 * u) + at_v + 2 * side_k; };
      const auto along_v = [&](CellId at_u) { return static_cast<CellId>(4 * v) + side_k + 2 * at_u; };
      square.edges = {along_u(0), along_v(1), along_u(1), along_v(0)};
      cube.squares[2 * axis + side_k] = static_cast<CellId>(tree_.squares.size());
      tree_.squares.push_back(square);
    }
  }
  for (LabelIndex k = 0; k < labels_.count(); ++k) {
    if (!labels_.is_unseen(k)) cube.governors.push_back(k);
  }
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) cube.triangles.push_back(t);
  cube.governors_of_parent = cube.governors.size();
  tree_.cubes.push_back(cube);
}

void CellSplitter::expect_same(LabelIndex a, LabelIndex b) const {
  if (labels_.site_of(a) != labels_.site_of(b)) contradictions_.fetch_add(1, std::memory_order_relaxed);
}

// Edges.

std::vector<std::uint32_t> CellSplitter::crossed(const GridEdge& edge, std::span<const std::uint32_t> triangles) const {
  const std::size_t axis = edge.axis;
  const Vec3d low = tree_.lattice.at(edge.low);
  const Vec3d high = tree_.lattice.at(edge.high());
  const double u = low[next_axis(axis)];
  const double v = low[next_axis(next_axis(axis))];
  std::vector<std::uint32_t> out;
  for (const std::uint32_t t : triangles) {
    const std::array<Vec3d, 3> p = triangle_corners(mesh_, t);
    const int side = detail::side_of_line({p[0], p[1]}, axis, u, v);
    if (side == 0 || detail::side_of_line({p[1], p[2]}, axis, u, v) != side ||
        detail::side_of_line({p[2], p[0]}, axis, u, v) != side) {
      continue;
    }
    if (detail::side_of_node(p, low) != detail::side_of_node(p, high)) out.push_back(t);
  }
  std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
    return a != b && detail::is_crossed_before(triangle_corners(mesh_, a), triangle_corners(mesh_, b), axis, u, v);
  });
  return out;
}

double CellSplitter::crossing_at(const GridEdge& edge, std::uint32_t triangle) const {
  const PlacedLabel& placed = labels_[triangle];
  const Vec3d low = tree_.lattice.at(edge.low);
  const double begin = low[edge.axis];
  const double end = tree_.lattice.at(edge.axis, edge.low[edge.axis] + edge.length);
  const double at = begin - placed.height(low - labels_.centre()) / placed.direction[edge.axis];
  return at > begin ? std::min(at, end) : begin;
}

void CellSplitter::find_events(NewEdge& made, std::span<const LabelIndex> among,
                               std::span<const std::uint32_t> triangles) const {
  GridEdge& edge = made.edge;
  const std::vector<std::uint32_t> crossings = crossed(edge, triangles);
  const Vec3d origin = tree_.lattice.at(edge.low);
  LinePart part{origin, edge.axis, origin[edge.axis], 0, edge.first, outside};
  for (const std::uint32_t triangle : crossings) {
    const double at = crossing_at(edge, triangle);
    const double error = labels_.rounding() * (1 + 1 / std::abs(labels_[triangle].direction[edge.axis]));
    if (part.first == outside) {
      made.events.push_back({at, error, outside, triangle});
      part.low = at;
      part.first = triangle;
    } else {
      part.high = at;
      part.last = triangle;
      (void)lines_.add_events(part, among, made.events);
      made.events.push_back({at, error, triangle, outside});
      part.first = outside;
    }
  }
  if (part.first != outside) {
    part.high = tree_.lattice.at(edge.axis, edge.low[edge.axis] + edge.length);
    part.last = outside;
    (void)lines_.add_events(part, among, made.events);
  }
  pass_over_thin(made.events);
  edge.last = made.events.empty() ? edge.first : made.events.back().after;
  if (labels_.is_thin(edge.last)) contradictions_.fetch_add(1, std::memory_order_relaxed);
}

/// Merges the events at both ends of a thin region into one, because thin regions count as parts of walls.
void CellSplitter::pass_over_thin(std::vector<LineEvent>& events) const {
  std::size_t count = 0;
  for (const LineEvent& event : events) {
    if (count == 0 || !labels_.is_thin(events[count - 1].after)) {
      events[count++] = event;
      continue;
    }
    LineEvent& before = events[count - 1];
    before.has_several = before.thin != outside;
    if (!before.has_several) before.thin = before.after;
    before.width = event.at - before.at;
    before.error = std::max(before.error, event.error);
    before.after = event.after;
  }
  events.resize(count);
}

CellSplitter::NewEdge CellSplitter::edge_between(std::size_t axis, const Node& low, std::uint32_t length,
                                                 LabelIndex first, std::span<const LabelIndex> among,
                                                 std::span<const std::uint32_t> triangles) const {
  NewEdge made;
  made.edge.axis = static_cast<std::uint8_t>(axis);
  made.edge.low = low;
  made.edge.length = length;
  made.edge.first = first;
  find_events(made, among, triangles);
  return made;
}

void CellSplitter::store(CellId id, NewEdge& made) {
  made.edge.first_event = static_cast<std::uint32_t>(tree_.events.size());
  tree_.events.insert(tree_.events.end(), made.events.begin(), made.events.end());
  made.edge.last_event = static_cast<std::uint32_t>(tree_.events.size());
  tree_.edges[id] = made.edge;
}

bool CellSplitter::is_below(const GridEdge& edge, const LineEvent& event, const Node& node) const {
  const double at = tree_.lattice.at(edge.axis, node[edge.axis]);
  const double margin = 2 * event.error + labels_.rounding();
  if (event.upper() + margin < at) return true;
  if (event.at - margin > at) return false;
  if (event.thin != outside) {
    // The node lies in or near a thin region, which counts as a wall, and nodes must not lie on walls.
    contradictions_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  const Vec3d q = tree_.lattice.at(node);
  if (const std::optional<LabelIndex> triangle = event.crossed()) {
    const std::array<Vec3d, 3> p = triangle_corners(mesh_, *triangle);
    return detail::side_of_node(p, q) != detail::side_of_node(p, tree_.lattice.at(edge.low));
  }
  return is_behind_change(exact_, labels_, event.before, event.after, q);
}

void CellSplitter::split_edge(CellId id) {
  const GridEdge& edge = tree_.edges[id];
  Node middle = edge.low;
  middle[edge.axis] += edge.length / 2;
  std::uint32_t split = edge.first_event;
  while (split < edge.last_event && is_below(edge, tree_.events[split], middle)) ++split;
  const LabelIndex label = split > edge.first_event ? tree_.events[split - 1].after : edge.first;
  GridEdge& low = tree_.edges[edge.children];
  GridEdge& high = tree_.edges[edge.children + 1];
  low = edge;
  high = edge;
  low.children = high.children = no_cell;
  low.length = high.length = edge.length / 2;
  high.low = middle;
  low.last_event = high.first_event = split;
  low.last = high.first = label;
}

void CellSplitter::split_edges(std::vector<CellId> edges, const Context& context) {
  std::erase_if(edges, [&](CellId edge) { return tree_.edges[edge].children != no_cell; });
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  auto next = static_cast<CellId>(tree_.edges.size());
  for (const CellId edge : edges) {
    tree_.edges[edge].children = next;
    next += 2;
  }
  tree_.edges.resize(next);
  parallel_for(context, edges.size(), 256, {}, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) split_edge(edges[k]);
  });
}

// Squares.

std::array<CellSplitter::NewEdge, 4> CellSplitter::inner_edges(const GridSquare& square) const {
  const std::size_t u = next_axis(square.axis);
  const std::size_t v = next_axis(u);
  const std::uint32_t half = square.length / 2;
  const auto node = [&](std::uint32_t at_u, std::uint32_t at_v) {
    Node out = square.low;
    out[u] += at_u;
    out[v] += at_v;
    return out;
  };
  const auto middle_of = [&](std::size_t side) { return tree_.edges[tree_.edges[square.edges[side]].children].last; };
  std::array<NewEdge, 4> made;
  made[0] = edge_between(u, node(0, half), half, middle_of(3), square.governors, square.triangles);
  made[1] = edge_between(u, node(half, half), half, made[0].edge.last, square.governors, square.triangles);
  made[2] = edge_between(v, node(half, 0), half, middle_of(0), square.governors, square.triangles);
  made[3] = edge_between(v, node(half, half), half, made[0].edge.last, square.governors, square.triangles);
  expect_same(made[1].edge.last, middle_of(1));
  expect_same(made[2].edge.last, made[0].edge.last);
  expect_same(made[3].edge.last, middle_of(2));
  return made;
}

void CellSplitter::place_children(CellId id) {
  const GridSquare& square = tree_.squares[id];
  const std::size_t u = next_axis(square.axis);
  const std::size_t v = next_axis(u);
  const auto part = [&](std::size_t side, CellId half) { return tree_.edges[square.edges[side]].children + half; };
  const CellId inner = square.inner_edges;
  const std::array<std::array<CellId, 4>, 4> edges{{
      {part(0, 0), inner + 2, inner, part(3, 0)},
      {part(0, 1), part(1, 0), inner + 1, inner + 2},
      {inner, inner + 3, part(2, 0), part(3, 1)},
      {inner + 1, part(1, 1), part(2, 1), inner + 3},
  }};
  for (CellId k = 0; k < 4; ++k) {
    GridSquare& child = tree_.squares[square.children + k];
    child.low = square.low;
    child.length = square.length / 2;
    child.axis = square.axis;
    child.edges = edges[k];
    if ((k & 1U) != 0) child.low[u] += child.length;
    if ((k & 2U) != 0) child.low[v] += child.length;
    find_contents(child, square.governors, square.triangles);
  }
}

bool CellSplitter::is_outside(const GridSquare& square) const {
  return square.triangles.empty() && tree_.edges[square.edges[0]].first == outside;
}

void CellSplitter::find_contents(GridSquare& square, std::span<const LabelIndex> among,
                                 std::span<const std::uint32_t> triangles) const {
  const std::size_t u = next_axis(square.axis);
  const std::size_t v = next_axis(u);
  const Vec3d low = tree_.lattice.at(square.low);
  const Vec3d high = tree_.lattice.at(square.high());
  const Vec3d middle = (low + high) * 0.5 - labels_.centre();
  std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(square.triangles),
               [&](std::uint32_t t) { return may_meet(mesh_, labels_, t, {low, high}); });
  if (is_outside(square)) {
    square.state = SquareState::resolved;
    return;
  }
  std::array<Vec3d, 4> corners{};
  for (std::size_t k = 0; k < 4; ++k) {
    corners[k] = low - labels_.centre();
    if ((k & 1U) != 0) corners[k][u] = high[u] - labels_.centre()[u];
    if ((k & 2U) != 0) corners[k][v] = high[v] - labels_.centre()[v];
  }
  square.governors = governors(labels_, among, corners, middle);
}

void CellSplitter::split_squares(std::span<const CellId> squares, const Context& context) {
  std::vector<CellId> edges;
  for (const CellId square : squares) {
    edges.insert(edges.end(), tree_.squares[square].edges.begin(), tree_.squares[square].edges.end());
  }
  split_edges(std::move(edges), context);
  std::vector<std::array<NewEdge, 4>> made(squares.size());
  parallel_for(context, squares.size(), splitter_grain, {}, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) made[k] = inner_edges(tree_.squares[squares[k]]);
  });
  auto next_edge = static_cast<CellId>(tree_.edges.size());
  auto next_square = static_cast<CellId>(tree_.squares.size());
  tree_.edges.resize(next_edge + 4 * squares.size());
  tree_.squares.resize(next_square + 4 * squares.size());
  for (std::size_t k = 0; k < squares.size(); ++k) {
    GridSquare& square = tree_.squares[squares[k]];
    square.inner_edges = next_edge;
    square.children = next_square;
    for (NewEdge& edge : made[k]) store(next_edge++, edge);
    next_square += 4;
  }
  parallel_for(context, squares.size(), splitter_grain, {}, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) place_children(squares[k]);
  });
}

// Cubes.

std::array<CellSplitter::NewEdge, 6> CellSplitter::inner_edges(const GridCube& cube) const {
  const std::uint32_t half = cube.length / 2;
  // Returns the label at the middle of a square, where its inner edges along u meet.
  const auto middle_of = [&](std::size_t square) {
    return tree_.edges[tree_.squares[cube.squares[square]].inner_edges].last;
  };
  std::array<NewEdge, 6> made;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Node low = cube.low;
    low[next_axis(axis)] += half;
    low[next_axis(next_axis(axis))] += half;
    made[2 * axis] = edge_between(axis, low, half, middle_of(2 * axis), cube.governors, cube.triangles);
    low[axis] += half;
    made[2 * axis + 1] = edge_between(axis, low, half, made[0].edge.last, cube.governors, cube.triangles);
    expect_same(made[2 * axis].edge.last, made[0].edge.last);
    expect_same(made[2 * axis + 1].edge.last, middle_of(2 * axis + 1));
  }
  return made;
}

void CellSplitter::place_squares(const GridCube& cube, CellId first_edge, CellId first_square) {
  const std::uint32_t half = cube.length / 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = next_axis(axis);
    const std::size_t v = next_axis(u);
    const auto inner_of = [&](std::size_t square) { return tree_.squares[cube.squares[square]].inner_edges; };
    for (CellId k = 0; k < 4; ++k) {
      const CellId at_u = k & 1U;
      const CellId at_v = k >> 1U;
      // In a square across v, edges along u are inner edges along its second axis. In a square across u, edges along v
      // are inner edges along its first axis.
      const auto along_u = [&](CellId side) {
        return side == at_v ? inner_of(2 * v + side) + 2 + at_u : first_edge + static_cast<CellId>(2 * u) + at_u;
      };
      const auto along_v = [&](CellId side) {
        return side == at_u ? inner_of(2 * u + side) + at_v : first_edge + static_cast<CellId>(2 * v) + at_v;
      };
      GridSquare& square = tree_.squares[first_square + 4 * axis + k];
      square.axis = static_cast<std::uint8_t>(axis);
      square.low = cube.low;
      square.low[axis] += half;
      square.low[u] += at_u * half;
      square.low[v] += at_v * half;
      square.length = half;
      square.edges = {along_u(0), along_v(1), along_u(1), along_v(0)};
      find_contents(square, cube.governors, cube.triangles);
    }
  }
}

bool CellSplitter::is_outside(const GridCube& cube) const {
  return cube.triangles.empty() && tree_.edges[tree_.squares[cube.squares[0]].edges[0]].first == outside;
}

void CellSplitter::find_contents(GridCube& cube, const GridCube& parent) const {
  const Vec3d low = tree_.lattice.at(cube.low);
  const Vec3d high = tree_.lattice.at(cube.high());
  const Vec3d middle = (low + high) * 0.5 - labels_.centre();
  std::copy_if(parent.triangles.begin(), parent.triangles.end(), std::back_inserter(cube.triangles),
               [&](std::uint32_t t) { return may_meet(mesh_, labels_, t, {low, high}); });
  cube.governors_of_parent = parent.governors.size();
  if (is_outside(cube)) {
    cube.state = CubeState::trivial;
    return;
  }
  std::array<Vec3d, 8> corners{};
  for (std::size_t k = 0; k < 8; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      corners[k][axis] = ((k >> axis & 1U) != 0 ? high : low)[axis] - labels_.centre()[axis];
    }
  }
  cube.governors = governors(labels_, parent.governors, corners, middle);
}

void CellSplitter::place_children(const GridCube& cube, CellId first_square) {
  for (CellId k = 0; k < 8; ++k) {
    const std::array<CellId, 3> at{k & 1U, k >> 1U & 1U, k >> 2U};
    GridCube& child = tree_.cubes[cube.children + k];
    child.length = cube.length / 2;
    child.low = cube.low;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      child.low[axis] += at[axis] * child.length;
      const CellId quarter = at[next_axis(axis)] + 2 * at[next_axis(next_axis(axis))];
      for (CellId side = 0; side < 2; ++side) {
        child.squares[2 * axis + side] = side == at[axis]
                                             ? tree_.squares[cube.squares[2 * axis + side]].children + quarter
                                             : first_square + 4 * static_cast<CellId>(axis) + quarter;
      }
    }
    find_contents(child, cube);
  }
}

void CellSplitter::split_cubes(std::span<const CellId> cubes, const Context& context) {
  std::vector<CellId> squares;
  for (const CellId cube : cubes) {
    for (const CellId square : tree_.cubes[cube].squares) {
      if (tree_.squares[square].children == no_cell) squares.push_back(square);
    }
  }
  std::sort(squares.begin(), squares.end());
  squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
  split_squares(squares, context);
  std::vector<std::array<NewEdge, 6>> made(cubes.size());
  parallel_for(
      context, cubes.size(), splitter_grain, {},
      [&](const WorkRange& range) {
        for (std::size_t k = range.begin; k < range.end; ++k) made[k] = inner_edges(tree_.cubes[cubes[k]]);
      },
      Start::at_once);
  const auto first_edge = static_cast<CellId>(tree_.edges.size());
  const auto first_square = static_cast<CellId>(tree_.squares.size());
  const auto first_cube = static_cast<CellId>(tree_.cubes.size());
  tree_.edges.resize(first_edge + 6 * cubes.size());
  tree_.squares.resize(first_square + 12 * cubes.size());
  tree_.cubes.resize(first_cube + 8 * cubes.size());
  for (CellId k = 0; k < cubes.size(); ++k) {
    for (CellId edge = 0; edge < 6; ++edge) store(first_edge + 6 * k + edge, made[k][edge]);
    tree_.cubes[cubes[k]].children = first_cube + 8 * k;
    tree_.cubes[cubes[k]].state = CubeState::split;
  }
  parallel_for(
      context, cubes.size(), splitter_grain, {},
      [&](const WorkRange& range) {
        for (auto k = static_cast<CellId>(range.begin); k < range.end; ++k) {
          GridCube& cube = tree_.cubes[cubes[k]];
          place_squares(cube, first_edge + 6 * k, first_square + 12 * k);
          place_children(cube, first_square + 12 * k);
          cube.governors = {};
          cube.triangles = {};
        }
      },
      Start::at_once);
}

Subdivision subdivide(const VoronoiSolid& solid, const SubdivisionOptions& options, const Context& context,
                      const Refine& refine) {
  Subdivision out;
  Subdivider(solid, options, out, context).run(refine);
  return out;
}

}  // namespace blum::voronoi
