#include "solid/model/cut_grid.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "solid/model/components.hpp"
#include "solid/model/section_loop.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t surface_grain = 4096;
constexpr std::uint32_t own_number = 0x80000000U;  ///< bit of piece numbers of a chunk, until it is appended
constexpr std::uint64_t most_passes = std::uint64_t{1} << 29U;
constexpr std::uint32_t no_piece = 0xffffffffU;

/// The squares of the grid through which edges of a surface pass from one cube to the next.
class TracedEdges {
 public:
  TracedEdges(const SurfaceMesh& mesh, const GridPlanes& planes, const CellLattice& lattice,
              const std::vector<Place>& cubes, const Context& context)
      : mesh_(mesh), planes_(planes), lattice_(lattice), cubes_(cubes) {
    const auto edges = mesh.edges();
    first_.resize(edges.size() + 1);
    std::uint64_t sum = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      first_[e] = static_cast<std::uint32_t>(sum);
      for (std::size_t a = 0; a < 3; ++a) {
        sum += static_cast<std::uint64_t>(std::abs(cubes[edges[e][1]][a] - cubes[edges[e][0]][a]));
      }
      // The numbers of all pieces must stay below own_number.
      if (sum > most_passes) throw InvalidGrid("the surface crosses the grid too often: use a coarser grid");
    }
    first_.back() = static_cast<std::uint32_t>(sum);
    squares_.resize(sum);
    parallel_for(context, edges.size(), surface_grain, "edges", [&](const WorkRange& range) {
      for (std::size_t e = range.begin; e < range.end; ++e) trace(static_cast<std::uint32_t>(e));
    });
  }

  /// Returns the squares that an edge passes, in order from its smaller vertex.
  [[nodiscard]] std::span<const Cell> squares(std::uint32_t edge) const {
    return std::span(squares_).subspan(first_[edge], first_[edge + 1] - first_[edge]);
  }
  [[nodiscard]] std::size_t passes() const { return squares_.size(); }
  /// Returns the number of the part of an edge that follows after `passed` squares.
  [[nodiscard]] std::uint32_t part(std::uint32_t edge, std::size_t passed) const {
    if (passed == 0) return mesh_.edges()[edge][0];
    if (passed == first_[edge + 1] - first_[edge]) return mesh_.edges()[edge][1];
    return static_cast<std::uint32_t>(mesh_.vertices().size() + first_[edge] + passed);
  }

 private:
  void trace(std::uint32_t edge) {
    const auto [a, b] = mesh_.edges()[edge];
    const EdgeEnds ends = mesh_.ends(edge);
    const Place& end = cubes_[b];
    Place at = cubes_[a];
    for (std::uint32_t k = first_[edge]; k < first_[edge + 1]; ++k) {
      std::size_t axis = 3;
      for (std::size_t candidate = 0; candidate < 3; ++candidate) {
        if (at[candidate] == end[candidate]) continue;
        if (axis == 3 || is_first(ends, candidate, axis, at, end)) axis = candidate;
      }
      const std::int32_t step = end[axis] > at[axis] ? 1 : -1;
      Place square = at;
      square[axis] = step > 0 ? at[axis] + 1 : at[axis];
      squares_[k] = cell_at(lattice_.node(square[0], square[1], square[2]), 7U ^ (1U << axis));
      at[axis] += step;
    }
  }

  /// Returns true if an edge passes the next plane across axis `one` before the next plane across axis `other`.
  [[nodiscard]] bool is_first(const EdgeEnds& ends, std::size_t one, std::size_t other, const Place& at,
                              const Place& end) const {
    // The result follows from the side of the edge on which the common line of both planes lies.
    const bool is_cyclic = next_axis(one) == other;
    const std::size_t u = is_cyclic ? one : other;
    const std::size_t v = is_cyclic ? other : one;
    const std::int32_t u_step = end[u] > at[u] ? 1 : -1;
    const std::int32_t v_step = end[v] > at[v] ? 1 : -1;
    const int side = side_of_line(ends, next_axis(v), planes_.at(u, u_step > 0 ? at[u] + 1 : at[u]),
                                  planes_.at(v, v_step > 0 ? at[v] + 1 : at[v]));
    const bool is_u_first = side * u_step * v_step > 0;
    return is_u_first == is_cyclic;
  }

  const SurfaceMesh& mesh_;
  const GridPlanes& planes_;
  const CellLattice& lattice_;
  const std::vector<Place>& cubes_;
  std::vector<std::uint32_t> first_;
  std::vector<Cell> squares_;
};

/// Intersections of consecutive triangles with the grid.
struct Chunk {
  std::vector<GridCrossing> crossings;
  std::vector<Arc> arcs;
  std::vector<std::uint32_t> parts;  ///< for each triangle and each cube that it meets: its piece there
  std::vector<std::array<std::uint32_t, 2>> joins;
  std::uint32_t own = 0;  ///< number of pieces first numbered here: parts of triangles without a vertex or edge
};

/// A pass of a triangle's side through a plane of the grid.
struct Pass {
  std::size_t axis;
  std::int32_t plane;
  std::size_t side;     ///< side of the triangle: 0, 1, 2
  std::uint32_t index;  ///< index in the squares of the side's edge
};

class TriangleTracer {
 public:
  TriangleTracer(const SurfaceMesh& mesh, const GridPlanes& planes, const CellLattice& lattice,
                 const std::vector<Place>& cubes, const TracedEdges& edges, Chunk& out)
      : mesh_(mesh), planes_(planes), lattice_(lattice), cubes_(cubes), edges_(edges), out_(out) {}

  void trace(std::uint32_t triangle) {
    const Triangle& t = mesh_.triangles()[triangle];
    if (cubes_[t[0]] == cubes_[t[1]] && cubes_[t[1]] == cubes_[t[2]]) {
      out_.parts.push_back(t[0]);
      return;
    }
    triangle_ = triangle;
    corners_ = mesh_.corners(triangle);
    find_passes();
    first_arc_ = out_.arcs.size();
    // Each plane that the triangle crosses is passed by exactly two of its sides.
    for (std::size_t k = 0; k + 1 < passes_.size(); k += 2) walk(passes_[k], passes_[k + 1]);
    join_in_cubes();
  }

 private:
  void find_passes() {
    passes_.clear();
    for (std::size_t side = 0; side < 3; ++side) {
      const auto squares = edges_.squares(mesh_.edges_of(triangle_)[side].value);
      for (std::uint32_t k = 0; k < squares.size(); ++k) {
        const std::size_t axis = normal_axis(squares[k]);
        passes_.push_back({axis, static_cast<std::int32_t>(lattice_.place(node_of(squares[k]))[axis]), side, k});
      }
    }
    std::sort(passes_.begin(), passes_.end(), [](const Pass& a, const Pass& b) {
      if (a.axis != b.axis) return a.axis < b.axis;
      return a.plane != b.plane ? a.plane < b.plane : a.side < b.side;
    });
  }

  /// Follows the section of the triangle with a plane from one side to the other, square by square.
  void walk(const Pass& one, const Pass& two) {
    const Triangle& t = mesh_.triangles()[triangle_];
    const std::size_t w = one.axis;
    const std::size_t u = next_axis(w);
    const std::size_t v = next_axis(u);
    // The common corner of both sides is alone on its side of the plane. The walk starts on the triangle's side that
    // follows that corner. For a viewer who looks against the axis, the normal points right of the walk if the corner
    // is above the plane. Otherwise it points left.
    const std::size_t alone = two.side == one.side + 1 ? two.side : one.side;
    const bool is_above = cubes_[t[alone]][w] >= one.plane;
    const bool normal_is_left = !is_above;
    const Pass& start = one.side == alone ? one : two;
    const Pass& end = one.side == alone ? two : one;
    const Cell target = square_of(end);
    Cell square = square_of(start);
    const auto to = lattice_.place(node_of(target));
    auto at = lattice_.place(node_of(square));
    ArcEnd from = edge_end(start);
    const std::size_t first = out_.arcs.size();
    while (square != target) {
      const std::int32_t u_step = to[u] > at[u] ? 1 : -1;
      const std::int32_t v_step = to[v] > at[v] ? 1 : -1;
      auto corner = at;
      corner[u] += u_step > 0 ? 1 : 0;
      corner[v] += v_step > 0 ? 1 : 0;
      bool is_along_u = at[v] == to[v];
      if (!is_along_u && at[u] != to[u]) {
        const int side = side_of_node(corners_, planes_.node(corner));
        is_along_u = side * (normal_is_left ? 1 : -1) * u_step * v_step > 0;
      }
      auto crossed = at;
      if (is_along_u) {
        crossed[u] = corner[u];
      } else {
        crossed[v] = corner[v];
      }
      const std::size_t along = is_along_u ? v : u;
      const Cell edge = cell_at(lattice_.node(crossed[0], crossed[1], crossed[2]), 1U << along);
      // A crossing lies in two planes. Only one of them records it.
      if (is_along_u) out_.crossings.push_back({edge, triangle_, (u_step > 0) == normal_is_left});
      add_arc(square, from, {edge, true});
      from = {edge, true};
      if (is_along_u) {
        at[u] += u_step;
      } else {
        at[v] += v_step;
      }
      square = cell_at(lattice_.node(at[0], at[1], at[2]), axes_of(target));
    }
    add_arc(square, from, edge_end(end));
    take_pieces(start, out_.arcs[first]);
    take_pieces(end, out_.arcs.back());
  }

  [[nodiscard]] std::uint32_t edge_of(const Pass& pass) const { return mesh_.edges_of(triangle_)[pass.side].value; }
  [[nodiscard]] Cell square_of(const Pass& pass) const { return edges_.squares(edge_of(pass))[pass.index]; }
  [[nodiscard]] ArcEnd edge_end(const Pass& pass) const { return {edge_of(pass), false}; }

  void add_arc(Cell square, const ArcEnd& from, const ArcEnd& to) {
    out_.arcs.push_back({square, triangle_, {from, to}, {no_piece, no_piece}});
  }

  /// Sets the pieces of an arc from the parts of the edge just below and just above the arc's end.
  void take_pieces(const Pass& pass, Arc& arc) {
    const std::uint32_t edge = edge_of(pass);
    const auto [a, b] = mesh_.edges()[edge];
    const bool rises = cubes_[b][pass.axis] > cubes_[a][pass.axis];
    for (std::size_t above = 0; above < 2; ++above) {
      const std::uint32_t part = edges_.part(edge, pass.index + (rises ? above : 1 - above));
      if (arc.pieces[above] != no_piece) out_.joins.push_back({arc.pieces[above], part});
      arc.pieces[above] = part;
    }
  }

  /// In each cube, gives all arcs of the triangle the same piece. It joins the pieces that the arcs have from edges.
  void join_in_cubes() {
    beside_.clear();
    for (std::size_t arc = first_arc_; arc < out_.arcs.size(); ++arc) {
      const Cell square = out_.arcs[arc].square;
      const auto [below, above] = lattice_.cubes_beside(square);
      beside_.emplace_back(below, 2 * arc);
      beside_.emplace_back(above, 2 * arc + 1);
    }
    std::sort(beside_.begin(), beside_.end());
    for (std::size_t i = 0; i < beside_.size();) {
      std::size_t j = i;
      while (j < beside_.size() && beside_[j].first == beside_[i].first) ++j;
      name_piece(i, j);
      i = j;
    }
  }

  void name_piece(std::size_t i, std::size_t j) {
    std::uint32_t piece = no_piece;
    for (std::size_t k = i; k < j; ++k) {
      const std::uint32_t part = piece_of(k);
      if (part == no_piece || part == piece) continue;
      if (piece != no_piece) out_.joins.push_back({piece, part});
      piece = part;
    }
    if (piece == no_piece) piece = own_number | out_.own++;
    out_.parts.push_back(piece);
    for (std::size_t k = i; k < j; ++k) piece_of(k) = piece;
  }
  [[nodiscard]] std::uint32_t& piece_of(std::size_t k) {
    return out_.arcs[beside_[k].second / 2].pieces[beside_[k].second % 2];
  }

  const SurfaceMesh& mesh_;
  const GridPlanes& planes_;
  const CellLattice& lattice_;
  const std::vector<Place>& cubes_;
  const TracedEdges& edges_;
  Chunk& out_;
  std::uint32_t triangle_ = 0;
  TriangleCorners corners_;
  std::vector<Pass> passes_;
  std::size_t first_arc_ = 0;
  std::vector<std::pair<Cell, std::size_t>> beside_;  ///< cube, and 2 * arc (+ 1 if the cube is above it)
};

/// Appends the intersections of a chunk of triangles to `out`.
void append(Chunk&& chunk, std::uint32_t& count, TracedSurface& out) {
  const auto number = [&](std::uint32_t piece) {
    return (piece & own_number) != 0 ? count + (piece & ~own_number) : piece;
  };
  const std::uint32_t end = count + chunk.own;
  for (const std::uint32_t part : chunk.parts) ++out.euler[number(part)];
  for (const auto& [a, b] : chunk.joins) out.pieces.join(number(a), number(b));
  for (Arc& arc : chunk.arcs) {
    for (std::uint32_t& piece : arc.pieces) piece = number(piece);
  }
  out.arcs.insert(out.arcs.end(), chunk.arcs.begin(), chunk.arcs.end());
  out.crossings.insert(out.crossings.end(), chunk.crossings.begin(), chunk.crossings.end());
  count = end;
}

constexpr std::size_t grain = 2048;

/// Returns the two axes that a square spans, the lower one first, as bits.
constexpr std::array<CellAxes, 2> span_of(Cell square) {
  const CellAxes axes = axes_of(square);
  const CellAxes lower = axes & (~axes + 1U);
  return {lower, axes ^ lower};
}

[[noreturn]] void throw_crossing(const GridPlanes& planes, const CellLattice& lattice, Cell cell) {
  const Vec3d p = planes.node(lattice.place(node_of(cell)));
  throw InvalidMesh("the mesh bounds no solid near (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
                    std::to_string(p.z) + "): its surface is open, or crosses itself");
}

/// Returns the keys and indices of the items in the order of the keys.
template <class Item, class Key>
std::vector<KeyedIndex> sorted_by(const std::vector<Item>& items, const Key& key) {
  std::vector<KeyedIndex> order(items.size());
  for (std::uint32_t k = 0; k < items.size(); ++k) order[k] = {key(items[k]), k};
  radix_sort(order);
  return order;
}

}  // namespace

TracedSurface trace_surface(const SurfaceMesh& mesh, const GridPlanes& planes, const CellLattice& lattice,
                            const Context& context) {
  TracedSurface out;
  out.cube_of_vertex.resize(mesh.vertices().size());
  parallel_for(context, mesh.vertices().size(), surface_grain, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) out.cube_of_vertex[v] = planes.cube(mesh.vertices()[v]);
  });
  const TracedEdges edges(mesh, planes, lattice, out.cube_of_vertex, context);
  std::vector<Chunk> chunks((mesh.triangles().size() + surface_grain - 1) / surface_grain);
  parallel_for(context, mesh.triangles().size(), surface_grain, "triangles", [&](const WorkRange& range) {
    Chunk& chunk = chunks[range.begin / surface_grain];
    TriangleTracer tracer(mesh, planes, lattice, out.cube_of_vertex, edges, chunk);
    for (std::size_t t = range.begin; t < range.end; ++t) tracer.trace(static_cast<std::uint32_t>(t));
  });
  auto count = static_cast<std::uint32_t>(mesh.vertices().size() + edges.passes());
  std::size_t pieces = count;
  for (const Chunk& chunk : chunks) pieces += chunk.own;
  out.pieces.reset(pieces);
  out.euler.assign(pieces, 0);
  std::fill_n(out.euler.begin(), mesh.vertices().size(), 1);
  for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
    const std::size_t passed = edges.squares(e).size();
    for (std::size_t k = 0; k <= passed; ++k) --out.euler[edges.part(e, k)];
    if (passed == 0) out.pieces.join(mesh.edges()[e][0], mesh.edges()[e][1]);
  }
  for (Chunk& chunk : chunks) {
    throw_if_cancelled(context);
    append(std::move(chunk), count, out);
    chunk = {};
  }
  for (std::uint32_t k = 0; k < out.euler.size(); ++k) {
    if (const std::uint32_t first = out.pieces.find(k); first != k) out.euler[first] += out.euler[k];
  }
  return out;
}

struct CutGrid::Scratch {
  SquareComponents square;
  CubeComponents cube;
  std::vector<std::uint32_t> loop_edges;
  std::vector<Cell> failing;
};

std::array<Cell, 4> CutGrid::sides_of(Cell square) const {
  const auto [lower, upper] = span_of(square);
  const std::size_t node = node_of(square);
  return {cell_at(node, lower), cell_at(node + lattice_.stride(axis_of(upper)), lower), cell_at(node, upper),
          cell_at(node + lattice_.stride(axis_of(lower)), upper)};
}

std::array<Cell, 6> CutGrid::faces_of(Cell cube) const {
  std::array<Cell, 6> faces{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const CellAxes spanned = 7U ^ (1U << axis);
    faces[2 * axis] = cell_at(node_of(cube), spanned);
    faces[2 * axis + 1] = cell_at(node_of(cube) + lattice_.stride(axis), spanned);
  }
  return faces;
}

std::span<const std::uint32_t> CutGrid::crossings(Cell edge) const {
  if (!cut_.contains(edge)) return {};
  const CutCell& own = cut(edge);
  return std::span(crossings_).subspan(own.first, own.count);
}

std::uint32_t CutGrid::component_of_interval(Cell square, Cell side, std::uint32_t interval) const {
  if (!cut_.contains(square)) return 0;
  std::uint32_t at = cut(square).table + interval;
  for (const Cell before : sides_of(square)) {
    if (before == side) break;
    at += components(before);
  }
  return interval_component_[at];
}

std::uint32_t CutGrid::component_of_part(Cell cube, std::size_t face, std::uint32_t part) const {
  if (!cut_.contains(cube)) return 0;
  std::uint32_t at = cut(cube).table + part;
  const std::array<Cell, 6> faces = faces_of(cube);
  for (std::size_t before = 0; before < face; ++before) at += components(faces[before]);
  return part_component_[at];
}

std::vector<ArcEnd> CutGrid::loose_ends(Cell square, std::uint32_t component) const {
  std::vector<ArcEnd> ends;
  if (!cut_.contains(square)) return ends;
  const CutCell& own = cut(square);
  for (std::uint32_t a = own.first; a < own.first + own.count; ++a) {
    if (arc_component_[a] != component) continue;
    for (const ArcEnd& end : arcs_[a].ends) {
      if (end.on_border) return {};
      ends.push_back(end);
    }
  }
  return ends;
}

std::span<const std::pair<Cell, std::uint32_t>> CutGrid::shells_in(Cell cube) const {
  const auto first = std::lower_bound(whole_shells_.begin(), whole_shells_.end(), std::pair{cube, std::uint32_t{0}});
  auto last = first;
  while (last != whole_shells_.end() && last->first == cube) ++last;
  return {first, last};
}

CutGrid::CutGrid(const SurfaceMesh& mesh, GridPlanes planes, const Context& context)
    : planes_(std::move(planes)),
      lattice_({planes_.count(0) - 1, planes_.count(1) - 1, planes_.count(2) - 1}),
      cut_(lattice_) {
  TracedSurface surface = trace_surface(mesh, planes_, lattice_, context);
  take_closed_shells(mesh, surface);
  number_cells(surface);
  sort_crossings(mesh, surface);
  sort_arcs(surface);
  throw_if_cancelled(context);
  find_inside(context);
  connect_squares(mesh, context);
  connect_cubes(surface, context);
  std::sort(failing_.begin(), failing_.end());
  failing_.erase(std::unique(failing_.begin(), failing_.end()), failing_.end());
}

/// Records shells that no plane of the grid cuts. The cube that contains such a shell fails, unless the shell is the
/// outer shell of a body without tunnels.
void CutGrid::take_closed_shells(const SurfaceMesh& mesh, TracedSurface& surface) {
  std::vector<bool> is_cut(surface.euler.size(), false);
  for (const Arc& arc : surface.arcs) {
    for (const std::uint32_t piece : arc.pieces) is_cut[surface.pieces.find(piece)] = true;
  }
  const auto vertices = mesh.vertices();
  std::vector<std::uint32_t> closed;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    // find() returns the smallest number in a piece. If this number is not that of a vertex, a plane cuts the piece.
    if (surface.pieces.find(v) == v && !is_cut[v]) closed.push_back(v);
  }
  if (closed.empty()) return;
  std::vector<std::uint32_t> outer;
  for (const std::uint32_t v : mesh.outermost()) outer.push_back(surface.pieces.find(v));
  std::sort(outer.begin(), outer.end());
  for (const std::uint32_t shell : closed) {
    const Place& at = surface.cube_of_vertex[shell];
    const Cell cube = cell_at(lattice_.node(at[0], at[1], at[2]), 7);
    cut_.insert(cube);
    whole_shells_.emplace_back(cube, shell);
    const bool is_outer = std::binary_search(outer.begin(), outer.end(), shell);
    if (!is_outer || surface.euler_of(shell) != 2) failing_.push_back(cube);
  }
  std::sort(whole_shells_.begin(), whole_shells_.end());
}

void CutGrid::number_cells(TracedSurface& surface) {
  for (const GridCrossing& crossing : surface.crossings) cut_.insert(crossing.edge);
  for (const Arc& arc : surface.arcs) {
    cut_.insert(arc.square);
    for (const Cell cube : lattice_.cubes_beside(arc.square)) cut_.insert(cube);
  }
  cut_.finish();
  cells_.resize(cut_.size());
  cut_cells_ = cut_.cells();
}

void CutGrid::sort_crossings(const SurfaceMesh& mesh, const TracedSurface& surface) {
  const auto order = sorted_by(surface.crossings, [](const GridCrossing& crossing) { return crossing.edge; });
  crossings_.resize(order.size());
  inside_ = Buffer<std::uint8_t>(lattice_.node_count(), 0);
  std::vector<GridCrossing> row;
  for (std::size_t i = 0; i < order.size();) {
    const Cell edge = order[i].key;
    row.clear();
    std::size_t j = i;
    for (; j < order.size() && order[j].key == edge; ++j) row.push_back(surface.crossings[order[j].index]);
    const std::size_t axis = axis_of(axes_of(edge));
    if (row.size() > 1) {
      const auto place = lattice_.place(node_of(edge));
      const std::size_t u = next_axis(axis);
      const std::size_t v = next_axis(u);
      const double at_u = planes_.at(u, place[u]);
      const double at_v = planes_.at(v, place[v]);
      std::sort(row.begin(), row.end(), [&](const GridCrossing& a, const GridCrossing& b) {
        return is_crossed_before(mesh.corners(a.triangle), mesh.corners(b.triangle), axis, at_u, at_v);
      });
    }
    CutCell& own = cut(edge);
    own.first = static_cast<std::uint32_t>(i);
    own.count = static_cast<std::uint32_t>(row.size());
    own.components = intervals_of(own.count, row.front().leaves);
    for (std::size_t k = 0; k < row.size(); ++k) {
      if ((row[k].leaves == row.front().leaves) != (k % 2 == 0)) throw_crossing(planes_, lattice_, edge);
      crossings_[i + k] = row[k].triangle;
    }
    // Until find_inside(), `inside_` is 1 if the node and the node below it along z are on different sides of the
    // surface.
    if (axis == 2 && row.size() % 2 == 1) inside_[node_of(edge) + lattice_.stride(2)] = 1;
    i = j;
  }
}

void CutGrid::sort_arcs(TracedSurface& surface) {
  const auto order = sorted_by(surface.arcs, [](const Arc& arc) { return arc.square; });
  arcs_.reserve(order.size());
  for (const KeyedIndex& item : order) {
    const Arc& arc = surface.arcs[item.index];
    CutCell& own = cut(arc.square);
    if (own.count == 0) own.first = static_cast<std::uint32_t>(arcs_.size());
    ++own.count;
    arcs_.push_back(arc);
    for (std::uint32_t& piece : arcs_.back().pieces) piece = surface.pieces.find(piece);
  }
  surface.arcs = {};
  arc_component_.resize(arcs_.size());
}

void CutGrid::find_inside(const Context& context) {
  const std::size_t layer = lattice_.stride(2);
  const auto layers = static_cast<std::size_t>(lattice_.size()[2]);
  parallel_for(context, layer, 16384, "", [&](const WorkRange& range) {
    for (std::size_t k = 1; k < layers; ++k) {
      std::uint8_t* own = inside_.data() + k * layer;
      const std::uint8_t* below = own - layer;
      for (std::size_t n = range.begin; n < range.end; ++n) own[n] ^= below[n];
    }
  });
  for (const Cell cell : cut_cells_) {
    if (dimension_of(cell) != 1) continue;
    const CutCell& own = cut(cell);
    const bool begins_inside = is_inside(node_of(cell));
    const bool ends_inside = is_inside(node_of(cell) + lattice_.stride(axis_of(axes_of(cell))));
    if (begins_inside != (ends_inside != (own.count % 2 == 1)) ||
        own.components != intervals_of(own.count, begins_inside)) {
      throw_crossing(planes_, lattice_, cell);
    }
  }
}

void CutGrid::connect_squares(const SurfaceMesh& mesh, const Context& context) {
  std::uint32_t table = 0;
  for (const Cell cell : cut_cells_) {
    if (dimension_of(cell) != 2) continue;
    cut(cell).table = table;
    for (const Cell side : sides_of(cell)) table += components(side);
  }
  interval_component_.resize(table);
  std::vector<Scratch> chunks((cut_cells_.size() + grain - 1) / grain);
  parallel_for(context, cut_cells_.size(), grain, "squares", [&](const WorkRange& range) {
    Scratch& scratch = chunks[range.begin / grain];
    for (std::size_t c = range.begin; c < range.end; ++c) {
      const Cell cell = cut_cells_[c];
      if (dimension_of(cell) != 2 || connect_square(mesh, cell, scratch)) continue;
      for (const Cell cube : lattice_.cubes_beside(cell)) scratch.failing.push_back(cube);
    }
  });
  for (const Scratch& scratch : chunks) {
    failing_.insert(failing_.end(), scratch.failing.begin(), scratch.failing.end());
  }
}

bool CutGrid::connect_square(const SurfaceMesh& mesh, Cell square, Scratch& scratch) {
  CutCell& own = cut(square);
  const std::array<Cell, 4> sides = sides_of(square);
  std::array<std::uint32_t, 5> first{};
  for (std::size_t s = 0; s < 4; ++s) first[s + 1] = first[s] + components(sides[s]);
  SquareComponents& components_here = scratch.square;
  components_here.start(first[4]);
  // An inside corner joins the intervals of two sides that end there: the first or last interval of each.
  const auto [lower, upper] = span_of(square);
  const std::size_t node = node_of(square);
  const std::size_t along_lower = lattice_.stride(axis_of(lower));
  const std::size_t along_upper = lattice_.stride(axis_of(upper));
  if (is_inside(node)) components_here.join(first[0], first[2]);
  if (is_inside(node + along_lower)) components_here.join(first[1] - 1, first[3]);
  if (is_inside(node + along_upper)) components_here.join(first[1], first[3] - 1);
  if (is_inside(node + along_lower + along_upper)) components_here.join(first[2] - 1, first[4] - 1);
  const auto end_of = [&](const ArcEnd& end, std::uint32_t triangle) -> SquareComponents::End {
    if (!end.on_border) return {false, end.id};
    const auto s = static_cast<std::size_t>(std::find(sides.begin(), sides.end(), end.id) - sides.begin());
    const auto row = crossings(end.id);
    const auto index = static_cast<std::uint32_t>(std::find(row.begin(), row.end(), triangle) - row.begin());
    return {true, first[s] + interval_at(index, is_inside(node_of(end.id)))};
  };
  const auto arcs = std::span(arcs_).subspan(own.first, own.count);
  for (const Arc& arc : arcs) {
    components_here.add_arc(end_of(arc.ends[0], arc.triangle), end_of(arc.ends[1], arc.triangle));
  }
  const std::size_t across = normal_axis(square);
  const double plane = planes_.at(across, lattice_.place(node)[across]);
  const bool passes = components_here.finish([&](std::span<const std::uint32_t> loop) {
    scratch.loop_edges.clear();
    for (const std::uint32_t arc : loop) {
      for (const ArcEnd& end : arcs[arc].ends) scratch.loop_edges.push_back(end.id);
    }
    return is_around_hole(mesh, scratch.loop_edges, across, plane);
  });
  own.components = components_here.count();
  for (std::uint32_t k = 0; k < first[4]; ++k) interval_component_[own.table + k] = components_here.of_interval(k);
  for (std::uint32_t a = 0; a < own.count; ++a) arc_component_[own.first + a] = components_here.of_arc(a);
  return passes;
}

void CutGrid::connect_cubes(TracedSurface& surface, const Context& context) {
  std::uint32_t table = 0;
  for (const Cell cell : cut_cells_) {
    if (dimension_of(cell) != 3) continue;
    cut(cell).table = table;
    for (const Cell face : faces_of(cell)) table += components(face);
  }
  part_component_.resize(table);
  std::vector<Scratch> chunks((cut_cells_.size() + grain - 1) / grain);
  parallel_for(context, cut_cells_.size(), grain, "cubes", [&](const WorkRange& range) {
    Scratch& scratch = chunks[range.begin / grain];
    for (std::size_t c = range.begin; c < range.end; ++c) {
      const Cell cell = cut_cells_[c];
      if (dimension_of(cell) == 3 && !connect_cube(surface, cell, scratch)) scratch.failing.push_back(cell);
    }
  });
  for (const Scratch& scratch : chunks) {
    failing_.insert(failing_.end(), scratch.failing.begin(), scratch.failing.end());
  }
}

bool CutGrid::connect_cube(const TracedSurface& surface, Cell cube, Scratch& scratch) {
  CutCell& own = cut(cube);
  const std::array<Cell, 6> faces = faces_of(cube);
  std::array<std::uint32_t, 7> first{};
  for (std::size_t f = 0; f < 6; ++f) first[f + 1] = first[f] + components(faces[f]);
  CubeComponents& components_here = scratch.cube;
  components_here.start(first[6]);
  const std::size_t node = node_of(cube);
  // An edge along an axis lies in two faces of the cube: one across the next axis, and one across the axis after that.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = next_axis(axis);
    const std::size_t v = next_axis(u);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t at_u = corner & 1U;
      const std::size_t at_v = corner >> 1U;
      const Cell edge = cell_at(node + at_u * lattice_.stride(u) + at_v * lattice_.stride(v), 1U << axis);
      const std::size_t face_u = 2 * u + at_u;
      const std::size_t face_v = 2 * v + at_v;
      const std::uint32_t intervals = components(edge);
      for (std::uint32_t k = 0; k < intervals; ++k) {
        const std::uint32_t one = first[face_u] + component_of_interval(faces[face_u], edge, k);
        components_here.join_at_interval(one, first[face_v] + component_of_interval(faces[face_v], edge, k));
        // Each corner of the cube is an end of exactly one edge along x, so it is added once.
        if (axis != 0) continue;
        if (k == 0 && is_inside(node_of(edge))) components_here.add_corner(one);
        if (k + 1 == intervals && is_inside(node_of(edge) + 1)) components_here.add_corner(one);
      }
    }
  }
  for (std::size_t f = 0; f < 6; ++f) {
    if (!cut_.contains(faces[f])) continue;
    const CutCell& square = cut(faces[f]);
    for (std::uint32_t a = square.first; a < square.first + square.count; ++a) {
      components_here.add_arc(arcs_[a].pieces[f % 2 == 0 ? 1 : 0], first[f] + arc_component_[a]);
    }
  }
  const bool passes = components_here.finish([&](std::uint32_t piece) { return surface.euler_of(piece); });
  for (std::uint32_t k = 0; k < first[6]; ++k) part_component_[own.table + k] = components_here.of_part(k);
  own.components = components_here.count();
  own.components += static_cast<std::uint32_t>(shells_in(cube).size());
  return passes;
}

}  // namespace blum::detail
