#include "blum/axis/collapse_axis.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/axis/label_patch_sheets.hpp"
#include "blum/axis/label_sheets.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/check_angle.hpp"

namespace blum {
namespace {

using detail::check_angle;
using detail::label_sheets;

constexpr std::uint32_t none = 0xffffffffU;
constexpr std::size_t steps_between_looks = std::size_t{1} << 16U;

class AxisCollapser {
 public:
  AxisCollapser(const Complex& walls, double theta, const Context& context)
      : walls_(walls),
        theta_(theta),
        context_(context),
        angles_(walls.triangle_columns.get<float>(medial_columns::separation_angle)),
        vertex_angles_(walls.vertex_columns.get<double>(medial_columns::separation_angle)),
        incidence_(ComplexView{walls.positions.size(), {}, walls.triangles}, context) {}

  Complex run() {
    collapse_triangles();
    collapse_edges();
    Complex out = result();
    if (out.triangle_columns.find(medial_columns::patches[0]) != nullptr) label_patch_sheets(out, context_);
    return out;
  }

 private:
  [[nodiscard]] std::size_t edge_count() const { return incidence_.edges().size(); }
  void look() {
    if (++steps_ % steps_between_looks == 0) throw_if_cancelled(context_);
  }

  /// Returns the smaller separation angle of an edge's ends. Along a seam, this angle is larger than the angles of the
  /// triangles.
  [[nodiscard]] float own_angle(std::uint32_t edge) const {
    const auto& [a, b] = incidence_.edges()[edge];
    return static_cast<float>(std::min(vertex_angles_[a], vertex_angles_[b]));
  }

  /// Returns the last triangle that is left at an edge; none unless exactly one is left.
  [[nodiscard]] std::uint32_t only_triangle(std::uint32_t edge) const {
    if (triangles_left_[edge] != 1) return none;
    const std::span<const std::uint32_t> all = incidence_.triangles_of_edge()[edge];
    return *std::find_if(all.begin(), all.end(), [&](std::uint32_t t) { return !is_triangle_gone_[t]; });
  }

  void collapse_triangles() {
    is_triangle_gone_.assign(walls_.triangles.size(), false);
    is_edge_gone_.assign(edge_count(), false);
    for (std::uint32_t e = 0; e < edge_count(); ++e) {
      triangles_left_.push_back(static_cast<std::uint32_t>(incidence_.triangles_of_edge()[e].size()));
    }
    // Ordered by ascending angle, then by ascending number of the free edge.
    using Waiting = std::pair<float, std::uint32_t>;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> line;
    const auto offer = [&](std::uint32_t edge) {
      const std::uint32_t t = only_triangle(edge);
      if (t != none && angles_[t] <= theta_ && own_angle(edge) <= theta_) line.emplace(angles_[t], edge);
    };
    for (std::uint32_t e = 0; e < edge_count(); ++e) offer(e);
    while (!line.empty()) {
      look();
      const std::uint32_t edge = line.top().second;
      line.pop();
      if (is_edge_gone_[edge]) continue;
      const std::uint32_t t = only_triangle(edge);
      if (t == none) continue;
      is_edge_gone_[edge] = true;
      is_triangle_gone_[t] = true;
      for (const std::uint32_t side : incidence_.sides()[t]) {
        --triangles_left_[side];
        if (!is_edge_gone_[side]) offer(side);
      }
    }
  }

  /// Returns the largest of an edge's own angle and the angles of all triangles that the input has at it.
  [[nodiscard]] float angle_of_edge(std::uint32_t edge) const {
    float largest = own_angle(edge);
    for (const std::uint32_t t : incidence_.triangles_of_edge()[edge]) largest = std::max(largest, angles_[t]);
    return largest;
  }

  void collapse_edges() {
    is_vertex_gone_.assign(walls_.positions.size(), false);
    std::vector<std::uint32_t> edges_left(walls_.positions.size(), 0);
    for (std::uint32_t e = 0; e < edge_count(); ++e) {
      if (is_edge_gone_[e]) continue;
      for (const std::uint32_t v : incidence_.edges()[e]) ++edges_left[v];
    }
    using Waiting = std::pair<float, std::uint32_t>;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> line;
    const auto offer = [&](std::uint32_t v) {
      if (edges_left[v] != 1) return;
      for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
        if (is_edge_gone_[e] || triangles_left_[e] > 0) continue;
        const float angle = angle_of_edge(e);
        if (angle <= theta_) line.emplace(angle, v);
      }
    };
    for (std::uint32_t v = 0; v < edges_left.size(); ++v) offer(v);
    while (!line.empty()) {
      look();
      const std::uint32_t v = line.top().second;
      line.pop();
      if (is_vertex_gone_[v] || edges_left[v] != 1) continue;
      is_vertex_gone_[v] = true;
      for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
        if (is_edge_gone_[e]) continue;
        is_edge_gone_[e] = true;
        const auto& [a, b] = incidence_.edges()[e];
        const std::uint32_t other = a == v ? b : a;
        --edges_left[v];
        --edges_left[other];
        offer(other);
        break;
      }
    }
  }

  [[nodiscard]] Complex result() const {
    Complex out;
    std::vector<std::uint32_t> number(walls_.positions.size(), none);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (is_vertex_gone_[v]) continue;
      number[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
      out.positions.push_back(walls_.positions[v]);
    }
    out.vertex_columns = walls_.vertex_columns.pick(kept);
    kept.clear();
    for (std::uint32_t t = 0; t < walls_.triangles.size(); ++t) {
      if (is_triangle_gone_[t]) continue;
      const auto& [a, b, c] = walls_.triangles[t];
      out.triangles.push_back({number[a], number[b], number[c]});
      kept.push_back(t);
    }
    out.triangle_columns = walls_.triangle_columns.pick(kept);
    std::vector<float> angles;
    for (std::uint32_t e = 0; e < edge_count(); ++e) {
      if (is_edge_gone_[e] || triangles_left_[e] > 0) continue;
      const auto& [a, b] = incidence_.edges()[e];
      out.edges.push_back({number[a], number[b]});
      angles.push_back(angle_of_edge(e));
    }
    out.edge_columns = Columns(out.edges.size());
    out.edge_columns.add({std::string(medial_columns::separation_angle), 1, std::move(angles)});
    add_missing_medial_columns(out);
    label_sheets(out, Incidence(out.view()));
    return out;
  }

  const Complex& walls_;
  double theta_;
  const Context& context_;
  std::span<const float> angles_;
  std::span<const double> vertex_angles_;
  Incidence incidence_;
  std::vector<bool> is_triangle_gone_, is_edge_gone_, is_vertex_gone_;
  std::vector<std::uint32_t> triangles_left_;  ///< for each edge: number of triangles left
  std::size_t steps_ = 0;
};

/// @throws InvalidOption if a column is missing: radii, footprints, sites or angles of vertices, or angles of
/// triangles.
void check_columns(const Complex& walls) {
  const auto has = [&](const Columns& columns, std::string_view kind, std::string_view name) {
    if (columns.find(name) == nullptr) throw InvalidOption(missing_medial_column(kind, name));
  };
  has(walls.vertex_columns, "vertices", medial_columns::radius);
  for (const std::string_view name : medial_columns::footprints) has(walls.vertex_columns, "vertices", name);
  for (const std::string_view name : medial_columns::sites) has(walls.vertex_columns, "vertices", name);
  has(walls.vertex_columns, "vertices", medial_columns::separation_angle);
  has(walls.triangle_columns, "triangles", medial_columns::separation_angle);
}

}  // namespace

Complex collapse_axis(const Complex& walls, double theta, const Context& context) {
  check_angle("theta", theta);
  validate(walls);
  check_columns(walls);
  return AxisCollapser(walls, theta, context).run();
}

}  // namespace blum
