#include "medial_axis/contract_points.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"

namespace blum {
namespace {

using Pair = std::array<std::uint32_t, 2>;

constexpr std::uint32_t none = 0xffffffffU;

Pair ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// The edges whose ends are at the same place, each once, rising.
std::vector<Pair> points_of(const Complex& axis, const Incidence& incidence) {
  std::vector<Pair> points;
  for (const Pair& edge : incidence.edges()) {
    if (axis.positions[edge[0]] == axis.positions[edge[1]]) points.push_back(edge);
  }
  return points;
}

class Contractor {
 public:
  Contractor(Complex& axis, const Incidence& incidence)
      : axis_(axis),
        incidence_(incidence),
        merged_into_(axis.positions.size(), none),
        is_triangle_gone_(axis.triangles.size(), false),
        is_edge_gone_(axis.edges.size(), false) {}

  void contract(std::vector<Pair> points) {
    gather_around(points);
    // What one contraction forbids another one may allow.
    for (bool is_changed = true; is_changed && !points.empty();) {
      std::vector<Pair> left;
      for (const Pair& point : points) {
        const Pair now = ordered(now_at(point[0]), now_at(point[1]));
        if (now[0] == now[1]) continue;
        if (may_contract(now)) {
          contract(now);
        } else {
          left.push_back(now);
        }
      }
      is_changed = left.size() < points.size();
      points = std::move(left);
    }
    sweep();
  }

 private:
  /// The triangles and curves around a vertex; some may be gone.
  struct Around {
    std::vector<std::uint32_t> triangles, edges;
  };

  [[nodiscard]] std::uint32_t now_at(std::uint32_t v) const {
    while (merged_into_[v] != none) v = merged_into_[v];
    return v;
  }

  /// Of the vertices of points only.
  void gather_around(const std::vector<Pair>& points) {
    around_.resize(axis_.positions.size());
    std::vector<bool> is_wanted(axis_.positions.size(), false);
    for (const Pair& point : points) is_wanted[point[0]] = is_wanted[point[1]] = true;
    for (std::uint32_t v = 0; v < is_wanted.size(); ++v) {
      if (!is_wanted[v]) continue;
      const std::span<const std::uint32_t> triangles = incidence_.triangles_of_vertex()[v];
      around_[v].triangles.assign(triangles.begin(), triangles.end());
    }
    for (std::uint32_t e = 0; e < axis_.edges.size(); ++e) {
      for (const std::uint32_t v : axis_.edges[e]) {
        if (is_wanted[v]) around_[v].edges.push_back(e);
      }
    }
  }

  template <class Visit>
  void for_each_triangle(std::uint32_t v, const Visit& visit) const {
    for (const std::uint32_t t : around_[v].triangles) {
      if (!is_triangle_gone_[t]) visit(t);
    }
  }
  template <class Visit>
  void for_each_curve(std::uint32_t v, const Visit& visit) const {
    for (const std::uint32_t e : around_[v].edges) {
      const Pair& ends = axis_.edges[e];
      if (!is_edge_gone_[e]) visit(e, ends[0] == v ? ends[1] : ends[0]);
    }
  }

  /// The other two corners of a triangle.
  [[nodiscard]] Pair opposite(std::uint32_t t, std::uint32_t v) const {
    const auto& c = axis_.triangles[t];
    return c[0] == v ? ordered(c[1], c[2]) : c[1] == v ? ordered(c[2], c[0]) : ordered(c[0], c[1]);
  }

  /// Vertices and edges linked to a vertex, each once, rising.
  struct Link {
    std::vector<std::uint32_t> vertices;
    std::vector<Pair> edges;
  };
  [[nodiscard]] Link link_of(std::uint32_t v) const {
    Link link;
    for_each_triangle(v, [&](std::uint32_t t) {
      const Pair edge = opposite(t, v);
      link.edges.push_back(edge);
      link.vertices.insert(link.vertices.end(), edge.begin(), edge.end());
    });
    for_each_curve(v, [&](std::uint32_t, std::uint32_t other) { link.vertices.push_back(other); });
    std::sort(link.edges.begin(), link.edges.end());
    std::sort(link.vertices.begin(), link.vertices.end());
    link.vertices.erase(std::unique(link.vertices.begin(), link.vertices.end()), link.vertices.end());
    return link;
  }

  /// The third corners of the triangles at an edge, rising.
  [[nodiscard]] std::vector<std::uint32_t> link_of(const Pair& edge) const {
    std::vector<std::uint32_t> vertices;
    for_each_triangle(edge[0], [&](std::uint32_t t) {
      const Pair other = opposite(t, edge[0]);
      if (other[0] == edge[1]) vertices.push_back(other[1]);
      if (other[1] == edge[1]) vertices.push_back(other[0]);
    });
    std::sort(vertices.begin(), vertices.end());
    return vertices;
  }

  [[nodiscard]] bool may_contract(const Pair& edge) const {
    const Link a = link_of(edge[0]);
    const Link b = link_of(edge[1]);
    std::vector<Pair> edges;
    std::set_intersection(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(), std::back_inserter(edges));
    if (!edges.empty()) return false;
    std::vector<std::uint32_t> vertices;
    std::set_intersection(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                          std::back_inserter(vertices));
    return vertices == link_of(edge);
  }

  /// Moves all of the second vertex to the first one.
  void contract(const Pair& edge) {
    const auto [to, from] = edge;
    const auto angles = std::as_const(axis_.triangle_columns).get<float>(medial_columns::separation_angle);
    std::vector<std::pair<std::uint32_t, float>> bared;  // third corners of triangles that go
    for_each_triangle(from, [&](std::uint32_t t) {
      const Pair other = opposite(t, from);
      if (other[0] != to && other[1] != to) return;
      is_triangle_gone_[t] = true;
      bared.emplace_back(other[0] == to ? other[1] : other[0], angles[t]);
    });
    for_each_triangle(from, [&](std::uint32_t t) {
      for (std::uint32_t& v : axis_.triangles[t]) v = v == from ? to : v;
      around_[to].triangles.push_back(t);
    });
    for_each_curve(from, [&](std::uint32_t e, std::uint32_t other) {
      if (other == to) {
        is_edge_gone_[e] = true;
        return;
      }
      for (std::uint32_t& v : axis_.edges[e]) v = v == from ? to : v;
      around_[to].edges.push_back(e);
    });
    merged_into_[from] = to;
    // Of two sides of a triangle that goes one is left: a curve where no other triangle has it.
    for (const auto& [third, angle] : bared) {
      if (link_of(Pair{to, third}).empty()) add_curve(to, third, angle);
    }
  }

  void add_curve(std::uint32_t a, std::uint32_t b, float angle) {
    const auto e = static_cast<std::uint32_t>(axis_.edges.size());
    axis_.edges.push_back({a, b});
    axis_.edge_columns.resize(axis_.edges.size());
    axis_.edge_columns.edit<float>(medial_columns::separation_angle)[e] = angle;
    axis_.edge_columns.edit<std::int32_t>(medial_columns::role)[e] = static_cast<std::int32_t>(MedialRole::curve);
    is_edge_gone_.push_back(false);
    for (const std::uint32_t v : {a, b}) around_[v].edges.push_back(e);
  }

  /// Takes what is gone out of the complex.
  void sweep() {
    std::vector<std::uint32_t> number(axis_.positions.size(), none);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (merged_into_[v] != none) continue;
      number[v] = static_cast<std::uint32_t>(kept.size());
      axis_.positions[kept.size()] = axis_.positions[v];
      kept.push_back(v);
    }
    axis_.positions.resize(kept.size());
    axis_.vertex_columns = axis_.vertex_columns.pick(kept);
    sweep(axis_.triangles, axis_.triangle_columns, is_triangle_gone_, number);
    sweep(axis_.edges, axis_.edge_columns, is_edge_gone_, number);
  }

  template <class Cell>
  static void sweep(std::vector<Cell>& cells, Columns& columns, const std::vector<bool>& is_gone,
                    const std::vector<std::uint32_t>& number) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
      if (is_gone[c]) continue;
      Cell cell = cells[c];
      for (std::uint32_t& v : cell) v = number[v];
      cells[kept.size()] = cell;
      kept.push_back(c);
    }
    cells.resize(kept.size());
    columns = columns.pick(kept);
  }

  Complex& axis_;
  const Incidence& incidence_;
  std::vector<std::uint32_t> merged_into_;
  std::vector<bool> is_triangle_gone_, is_edge_gone_;
  std::vector<Around> around_;
};

}  // namespace

bool contract_points(Complex& axis, const Incidence& incidence) {
  std::vector<Pair> points = points_of(axis, incidence);
  if (points.empty()) return false;
  Contractor(axis, incidence).contract(std::move(points));
  return true;
}

}  // namespace blum
