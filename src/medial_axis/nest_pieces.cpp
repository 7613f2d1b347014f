#include "medial_axis/nest_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <unordered_map>

#include "medial_axis/label_sheets.hpp"

namespace blum {
namespace {

using Pair = std::array<std::uint32_t, 2>;

/// A pair of vertices that a cell joins until some angle.
struct Side {
  Pair vertices;  ///< smaller first
  float until;
  float angle;
};

Side make_side(std::uint32_t a, std::uint32_t b, const AxisCell& cell) {
  return {{std::min(a, b), std::max(a, b)}, cell.level, cell.angle};
}

void sort(std::vector<Side>& sides) {
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.until > b.until;
  });
}

struct HashOfPlace {
  std::size_t operator()(const Vec3d& p) const {
    std::size_t hash = 0;
    // 0.0 makes 0 of -0, which is equal to it.
    for (const double x : {p.x, p.y, p.z}) hash = (hash ^ std::hash<double>()(x + 0.0)) * 0x9e3779b97f4a7c15U;
    return hash ^ hash >> 32U;
  }
};

class Nest {
 public:
  explicit Nest(double least_theta) { nested_.least_theta = least_theta; }

  void add(const AxisPiece& piece) {
    std::vector<std::uint32_t> vertex(piece.vertices.size(), 0);
    // Vertices come before what joins them: a face stays as long as what it is a face of.
    for (const AxisCell& cell : piece.cells) {
      if (!is_there(cell) || dimension_of(cell.cell) != 0) continue;
      const std::size_t place = piece.place_of(node_of(cell.cell));
      vertex[place] = vertex_at(piece.vertices[place], cell.level);
    }
    for (const AxisCell& cell : piece.cells) {
      if (!is_there(cell)) continue;
      if (dimension_of(cell.cell) == 1) {
        const auto [a, b] = ends_of(piece, cell.cell);
        add_thread(vertex[a], vertex[b], cell);
      } else if (dimension_of(cell.cell) == 2) {
        for (const auto& [a, b, c] : triangles_of(piece, cell.cell)) {
          add_triangle({vertex[a], vertex[b], vertex[c]}, cell);
        }
      }
    }
  }

  NestedComplex finish() {
    sort(sides_);
    sort(threads_);
    add_edges();
    label();
    return std::move(nested_);
  }

 private:
  [[nodiscard]] bool is_there(const AxisCell& cell) const { return cell.level > nested_.least_theta; }

  std::uint32_t vertex_at(const MedialVertex& vertex, float until) {
    const auto next = static_cast<std::uint32_t>(nested_.vertices.size());
    const auto [entry, is_new] = place_.try_emplace(vertex.position, next);
    if (is_new) {
      nested_.vertices.push_back(vertex);
      nested_.vertex_until.push_back(until);
    } else {
      float& known = nested_.vertex_until[entry->second];
      known = std::max(known, until);
    }
    return entry->second;
  }

  void add_thread(std::uint32_t a, std::uint32_t b, const AxisCell& cell) {
    if (a != b) threads_.push_back(make_side(a, b, cell));
  }

  /// One without extent is as good as its sides.
  void add_triangle(const std::array<std::uint32_t, 3>& corners, const AxisCell& cell) {
    const auto& [a, b, c] = corners;
    if (a == b || b == c || c == a) {
      add_thread(a, b, cell);
      add_thread(b, c, cell);
      add_thread(c, a, cell);
      return;
    }
    nested_.triangles.push_back({corners, cell.angle, cell.level, 0});
    for (std::size_t k = 0; k < 3; ++k) sides_.push_back(make_side(corners[k], corners[(k + 1) % 3], cell));
  }

  /// Gives a pair its roles: a seam while it has three triangles, a rim while it has one, a curve when it has none.
  /// @param sides  of its triangles, falling.  @param until  when the pair itself goes.
  void add_roles(const Pair& pair, std::span<const Side> sides, float until, float thread_angle) {
    const auto until_of = [&](std::size_t k) { return k < sides.size() ? sides[k].until : 0; };
    float angle = 0;
    for (const Side& side : sides) angle = std::max(angle, side.angle);
    const auto add = [&](MedialRole role, float from, float to) {
      if (to > from) nested_.edges.push_back({pair, role == MedialRole::curve ? thread_angle : angle, role, from, to});
    };
    add(MedialRole::seam, 0, until_of(2));
    add(MedialRole::rim, until_of(1), until_of(0));
    add(MedialRole::curve, until_of(0), until);
  }

  void add_edges() {
    std::size_t s = 0;
    // Every side of a triangle is a thread, too, but for diagonals.
    const auto roles_before = [&](const Pair* limit) {
      while (s < sides_.size() && (limit == nullptr || sides_[s].vertices < *limit)) {
        const std::size_t end = end_of(sides_, s);
        add_roles(sides_[s].vertices, std::span(sides_).subspan(s, end - s), 0, 0);
        s = end;
      }
    };
    for (std::size_t t = 0; t < threads_.size();) {
      const std::size_t end = end_of(threads_, t);
      const Side& thread = threads_[t];
      float angle = 0;
      for (std::size_t k = t; k < end; ++k) angle = std::max(angle, threads_[k].angle);
      roles_before(&thread.vertices);
      const bool has_sides = s < sides_.size() && sides_[s].vertices == thread.vertices;
      const std::size_t end_of_sides = has_sides ? end_of(sides_, s) : s;
      add_roles(thread.vertices, std::span(sides_).subspan(s, end_of_sides - s), thread.until, angle);
      s = end_of_sides;
      t = end;
    }
    roles_before(nullptr);
  }

  static std::size_t end_of(const std::vector<Side>& sides, std::size_t first) {
    std::size_t end = first;
    while (end < sides.size() && sides[end].vertices == sides[first].vertices) ++end;
    return end;
  }

  /// Sheets and roles at the least angle.
  void label() {
    MedialComplex complex;
    complex.vertices = std::move(nested_.vertices);
    for (const NestedTriangle& t : nested_.triangles) {
      complex.triangles.push_back({t.vertices, t.separation_angle, 0});
    }
    for (const NestedEdge& edge : nested_.edges) {
      const bool is_curve = edge.role == MedialRole::curve && edge.from <= nested_.least_theta;
      if (is_curve) complex.edges.push_back({edge.vertices, edge.separation_angle, edge.role});
    }
    label_sheets(complex);
    nested_.vertices = std::move(complex.vertices);
    nested_.sheet_count = complex.sheet_count;
    for (std::size_t t = 0; t < nested_.triangles.size(); ++t) nested_.triangles[t].sheet = complex.triangles[t].sheet;
  }

  NestedComplex nested_;
  std::unordered_map<Vec3d, std::uint32_t, HashOfPlace> place_;
  std::vector<Side> sides_;    ///< of triangles
  std::vector<Side> threads_;  ///< edges, and sides of triangles without extent
};

}  // namespace

NestedComplex nest_pieces(const std::vector<AxisPiece>& pieces, double least_theta) {
  Nest nest(least_theta);
  for (const AxisPiece& piece : pieces) nest.add(piece);
  return nest.finish();
}

}  // namespace blum
