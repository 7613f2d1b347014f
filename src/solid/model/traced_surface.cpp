#include "solid/model/traced_surface.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <span>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t grain = 4096;
constexpr std::uint32_t own_number = 0x80000000U;  ///< of pieces that a chunk of triangles makes, until it is appended
constexpr std::uint64_t most_passes = std::uint64_t{1} << 29U;
constexpr std::uint32_t no_piece = 0xffffffffU;

/// Where the edges of a surface pass from cube to cube.
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
      // All pieces together must be counted below own_number.
      if (sum > most_passes) throw InvalidGrid("the surface crosses the grid too often: use a coarser grid");
    }
    first_.back() = static_cast<std::uint32_t>(sum);
    squares_.resize(sum);
    parallel_for(context, edges.size(), grain, "edges", [&](const WorkRange& range) {
      for (std::size_t e = range.begin; e < range.end; ++e) trace(static_cast<std::uint32_t>(e));
    });
  }

  /// The squares that an edge passes, from its smaller vertex.
  [[nodiscard]] std::span<const Cell> squares(std::uint32_t edge) const {
    return std::span(squares_).subspan(first_[edge], first_[edge + 1] - first_[edge]);
  }
  [[nodiscard]] std::size_t passes() const { return squares_.size(); }
  /// The number of the part of an edge after `passed` squares.
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

  /// Whether an edge passes the next plane across `one` before that across `other`.
  [[nodiscard]] bool is_first(const EdgeEnds& ends, std::size_t one, std::size_t other, const Place& at,
                              const Place& end) const {
    // The line in which both planes meet lies on one side of the edge.
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

/// What some triangles in a row meet.
struct Chunk {
  std::vector<GridCrossing> crossings;
  std::vector<Arc> arcs;
  std::vector<std::uint32_t> parts;  ///< one for each triangle and cube: a piece that it belongs to
  std::vector<std::array<std::uint32_t, 2>> joins;
  std::uint32_t own = 0;  ///< pieces that no vertex or edge has a part in
};

/// Where an edge of a triangle passes a plane.
struct Pass {
  std::size_t axis;
  std::int32_t plane;
  std::size_t side;     ///< of the triangle: 0, 1, 2
  std::uint32_t index;  ///< among the squares of the edge
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
    // Two sides pass each plane that the triangle crosses.
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

  /// Follows the triangle through a plane from side to side.
  void walk(const Pass& one, const Pass& two) {
    const Triangle& t = mesh_.triangles()[triangle_];
    const std::size_t w = one.axis;
    const std::size_t u = next_axis(w);
    const std::size_t v = next_axis(u);
    // The corner that both sides have in common lies alone on its side of the plane. Seen against the axis, the
    // triangle's normal points to the right of the walk, which starts on the side after that corner, or to the left.
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
      // Each crossing is met in two planes, and noted in one.
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

  /// Gives an arc the pieces that the parts of an edge below and above its end belong to.
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

  /// Gives the arcs around each part of the triangle in a cube one piece, joined from the parts of edges there.
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
  std::vector<std::pair<Cell, std::size_t>> beside_;  ///< cubes, and twice the arcs on their sides
};

/// Adds what a chunk of triangles meets.
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

}  // namespace

TracedSurface trace_surface(const SurfaceMesh& mesh, const GridPlanes& planes, const CellLattice& lattice,
                            const Context& context) {
  TracedSurface out;
  out.cube_of_vertex.resize(mesh.vertices().size());
  parallel_for(context, mesh.vertices().size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) out.cube_of_vertex[v] = planes.cube(mesh.vertices()[v]);
  });
  const TracedEdges edges(mesh, planes, lattice, out.cube_of_vertex, context);
  std::vector<Chunk> chunks((mesh.triangles().size() + grain - 1) / grain);
  parallel_for(context, mesh.triangles().size(), grain, "triangles", [&](const WorkRange& range) {
    Chunk& chunk = chunks[range.begin / grain];
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

}  // namespace blum::detail
