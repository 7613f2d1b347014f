#include "medial_axis/shape/nest_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/axis/label_sheets.hpp"

namespace blum {
namespace {

using Pair = std::array<std::uint32_t, 2>;

/// Looks at whether it is cancelled after so many cells: a few milliseconds.
constexpr std::size_t cells_between_looks = 65536;

struct HashOfPlace {
  std::size_t operator()(const Vec3d& p) const {
    std::size_t hash = 0;
    // 0.0 makes 0 of -0, which is equal to it.
    for (const double x : {p.x, p.y, p.z}) hash = (hash ^ std::hash<double>()(x + 0.0)) * 0x9e3779b97f4a7c15U;
    return hash ^ hash >> 32U;
  }
};

/// How long something is there, and how important it is.
struct Stay {
  float until = 0;
  float angle = 0;

  void extend(const Stay& other) {
    until = std::max(until, other.until);
    angle = std::max(angle, other.angle);
  }
};

class Nest {
 public:
  Nest(double least_theta, const Context& context) : least_theta_(least_theta), context_(context) {}

  void add(const AxisPiece& piece) {
    std::vector<std::uint32_t> vertex(piece.vertices.size(), 0);
    std::vector<bool> is_known(piece.vertices.size(), false);
    // Vertices come before what joins them: a face stays as long as what it is a face of.
    for (int dimension = 0; dimension <= 2; ++dimension) {
      for (std::size_t c = 0; c < piece.cells.size(); ++c) {
        if (c % cells_between_looks == 0) throw_if_cancelled(context_);
        const AxisCell& cell = piece.cells[c];
        if (!is_there(cell) || cell.dimension != dimension) continue;
        const auto shape = piece.shapes[c];
        for (const std::uint32_t v : shape) {
          if (!is_known[v]) vertex[v] = vertex_at(piece.vertices[v], cell.level);
          is_known[v] = true;
        }
        for (std::size_t k = 0; dimension == 1 && k + 1 < shape.size(); ++k) {
          add_thread(vertex[shape[k]], vertex[shape[k + 1]], cell);
        }
        for (std::size_t k = 0; dimension == 2 && k < shape.size(); k += 3) {
          add_triangle({vertex[shape[k]], vertex[shape[k + 1]], vertex[shape[k + 2]]}, cell);
        }
      }
    }
  }

  Complex finish() {
    add_edges();
    Complex nested = labelled();
    set_edges(nested);
    add_level(nested.vertex_columns, medial_columns::until, std::move(vertex_until_));
    add_level(nested.edge_columns, medial_columns::from, std::move(edge_from_));
    add_level(nested.edge_columns, medial_columns::until, std::move(edge_until_));
    add_level(nested.triangle_columns, medial_columns::until, std::move(triangle_until_));
    return nested;
  }

 private:
  [[nodiscard]] bool is_there(const AxisCell& cell) const { return cell.level > least_theta_; }

  std::uint32_t vertex_at(const AxisVertex& vertex, float until) {
    const auto next = static_cast<std::uint32_t>(lists_.vertices.size());
    const auto [entry, is_new] = place_.try_emplace(vertex.position, next);
    if (is_new) {
      lists_.vertices.push_back(vertex);
      vertex_until_.push_back(until);
    } else {
      float& known = vertex_until_[entry->second];
      known = std::max(known, until);
    }
    return entry->second;
  }

  void add_thread(std::uint32_t a, std::uint32_t b, const AxisCell& cell) {
    if (a == b) return;
    threads_.push_back({a, b});
    stays_.push_back({cell.level, cell.angle});
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
    lists_.add_triangle(corners, cell.angle);
    triangle_until_.push_back(cell.level);
  }

  /// Gives each pair of vertices that anything joins its roles: a seam while it has three triangles, a rim while it has
  /// one, a curve when it has none.
  void add_edges() {
    const Incidence incidence({lists_.vertices.size(), threads_, lists_.triangles}, context_);
    // Every side of a triangle is a thread, too, but for diagonals.
    std::vector<Stay> threads(incidence.edges().size());
    for (std::size_t t = 0; t < threads_.size(); ++t) threads[incidence.edge_of_listed()[t]].extend(stays_[t]);
    std::vector<float> untils;  // of the triangles at an edge, falling
    for (std::size_t e = 0; e < threads.size(); ++e) {
      untils.clear();
      float angle = 0;
      for (const std::uint32_t t : incidence.triangles_of_edge()[e]) {
        untils.push_back(triangle_until_[t]);
        angle = std::max(angle, lists_.triangle_angles[t]);
      }
      std::sort(untils.begin(), untils.end(), std::greater<>());
      const auto until_of = [&](std::size_t k) { return k < untils.size() ? untils[k] : 0; };
      const Pair& pair = incidence.edges()[e];
      add_role(pair, MedialRole::seam, angle, 0, until_of(2));
      add_role(pair, MedialRole::rim, angle, until_of(1), until_of(0));
      add_role(pair, MedialRole::curve, threads[e].angle, until_of(0), threads[e].until);
    }
  }

  void add_role(const Pair& pair, MedialRole role, float angle, float from, float until) {
    if (!(until > from)) return;
    edges_.push_back(pair);
    edge_angles_.push_back(angle);
    edge_roles_.push_back(static_cast<std::int32_t>(role));
    edge_from_.push_back(from);
    edge_until_.push_back(until);
  }

  /// Vertices and triangles with their sheets and roles at the least angle.
  Complex labelled() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const bool is_curve = edge_roles_[e] == static_cast<std::int32_t>(MedialRole::curve);
      if (is_curve && edge_from_[e] <= least_theta_) lists_.add_edge(edges_[e], edge_angles_[e]);
    }
    Complex complex = complex_of(std::move(lists_));
    label_sheets(complex, Incidence(complex.view(), context_));
    throw_if_cancelled(context_);
    return complex;
  }

  /// Puts the edges of all angles in the place of those of the least.
  void set_edges(Complex& nested) {
    nested.edges = std::move(edges_);
    nested.edge_columns = Columns(nested.edges.size());
    nested.edge_columns.add({std::string(medial_columns::separation_angle), 1, std::move(edge_angles_)});
    nested.edge_columns.add({std::string(medial_columns::role), 1, std::move(edge_roles_)});
  }

  static void add_level(Columns& columns, std::string_view name, std::vector<float> levels) {
    columns.add({std::string(name), 1, std::move(levels)});
  }

  double least_theta_;
  const Context& context_;
  AxisLists lists_;  ///< vertices and triangles
  std::unordered_map<Vec3d, std::uint32_t, HashOfPlace> place_;
  std::vector<float> vertex_until_, triangle_until_;
  std::vector<Pair> threads_;  ///< edges, and sides of triangles without extent
  std::vector<Stay> stays_;    ///< of the threads
  // The edges of the result.
  std::vector<Pair> edges_;
  std::vector<float> edge_angles_, edge_from_, edge_until_;
  std::vector<std::int32_t> edge_roles_;
};

}  // namespace

Complex nest_pieces(const std::vector<AxisPiece>& pieces, double least_theta, const Context& context) {
  Nest nest(least_theta, context);
  for (const AxisPiece& piece : pieces) nest.add(piece);
  return nest.finish();
}

}  // namespace blum
