#include "medial_axis/fit/contract_points.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/axis/shrinking_complex.hpp"
#include "blum/complex/medial_columns.hpp"

namespace blum::detail {
namespace {

using Pair = std::array<std::uint32_t, 2>;

constexpr std::uint32_t none = 0xffffffffU;

Pair ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Returns the edges whose two ends have equal positions, each once, ascending.
std::vector<Pair> points_of(const Complex& axis, const Incidence& incidence) {
  std::vector<Pair> points;
  for (const Pair& edge : incidence.edges()) {
    if (axis.positions[edge[0]] == axis.positions[edge[1]]) points.push_back(edge);
  }
  return points;
}

class Contractor {
 public:
  explicit Contractor(Complex& axis) : axis_(axis), cells_(axis.view()), merged_into_(axis.positions.size(), none) {}

  void contract(std::vector<Pair> points) {
    // A contraction may make other contractions possible that the link condition forbade before.
    for (bool is_changed = true; is_changed && !points.empty();) {
      std::vector<Pair> left;
      for (const Pair& point : points) {
        const Pair now = ordered(now_at(point[0]), now_at(point[1]));
        if (now[0] == now[1]) continue;
        if (cells_.may_contract(now[1], now[0], scratch_)) {
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
  [[nodiscard]] std::uint32_t now_at(std::uint32_t v) const {
    while (merged_into_[v] != none) v = merged_into_[v];
    return v;
  }

  [[nodiscard]] bool is_side(std::uint32_t a, std::uint32_t b) const {
    bool found = false;
    cells_.for_each_triangle(
        a, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) { found = found || p == b || q == b; });
    return found;
  }

  /// Moves all cells of the second vertex to the first one.
  void contract(const Pair& edge) {
    const auto [to, from] = edge;
    const auto angles = std::as_const(axis_.triangle_columns).get<float>(medial_columns::separation_angle);
    merged_into_[from] = to;
    // Two sides of a removed triangle become one edge. It is a curve if it is not a side of another triangle.
    for (const auto& [triangle, third] : cells_.contract(from, to)) {
      if (!is_side(to, third)) add_curve(to, third, angles[triangle]);
    }
  }

  void add_curve(std::uint32_t a, std::uint32_t b, float angle) {
    const auto e = static_cast<std::uint32_t>(axis_.edges.size());
    cells_.add_edge({a, b});
    axis_.edges.push_back({a, b});
    axis_.edge_columns.resize(axis_.edges.size());
    axis_.edge_columns.edit<float>(medial_columns::separation_angle)[e] = angle;
    axis_.edge_columns.edit<std::int32_t>(medial_columns::role)[e] = static_cast<std::int32_t>(MedialRole::curve);
  }

  /// Takes removed cells out of the complex.
  void sweep() { axis_ = cells_.rest_of(axis_); }

  Complex& axis_;
  ShrinkingComplex cells_;
  LinkScratch scratch_;
  std::vector<std::uint32_t> merged_into_;
};

}  // namespace

bool contract_points(Complex& axis, const Incidence& incidence) {
  std::vector<Pair> points = points_of(axis, incidence);
  if (points.empty()) return false;
  Contractor(axis).contract(std::move(points));
  return true;
}

}  // namespace blum::detail
