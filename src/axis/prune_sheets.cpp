#include "blum/axis/prune_sheets.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/axis/label_sheets.hpp"
#include "blum/axis/order_sheets.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/check_angle.hpp"

namespace blum {
namespace {

using detail::check_angle;
using detail::label_sheets;
using detail::order_sheets_as;

constexpr std::uint32_t none = 0xffffffffU;
constexpr std::size_t steps_between_looks = std::size_t{1} << 16U;

class Pruner {
 public:
  Pruner(const Complex& axis, double theta, const Context& context)
      : complex_(axis), axis_(axis), theta_(theta), context_(context), incidence_(axis.view(), context) {
    find_edges();
    find_sheets();
  }

  void prune() {
    Line line;
    for (std::uint32_t s = 0; s < angle_of_sheet_.size(); ++s) offer(s, line);
    while (!line.empty()) {
      const std::uint32_t sheet = line.top().second;
      line.pop();
      is_in_line_[sheet] = false;
      if (is_sheet_gone_[sheet] || !consume(sheet)) continue;
      is_sheet_gone_[sheet] = true;
      trim(sheet);
      for (const std::uint32_t t : triangles_of_sheet_[sheet]) {
        for (const std::uint32_t e : sides_of(t)) {
          for (const std::uint32_t other : incidence_.triangles_of_edge()[e]) {
            if (!is_triangle_gone_[other]) offer(sheet_of(other), line);
          }
        }
      }
    }
    trim_curves();
  }

  [[nodiscard]] Complex result() const {
    Complex out;
    std::vector<std::uint32_t> number(axis_.positions.size(), none);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (is_vertex_gone_[v]) continue;
      number[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
      out.positions.push_back(axis_.positions[v]);
    }
    out.vertex_columns = complex_.vertex_columns.pick(kept);
    kept.clear();
    for (std::uint32_t t = 0; t < axis_.triangles.size(); ++t) {
      if (is_triangle_gone_[t]) continue;
      const auto& [a, b, c] = axis_.triangles[t];
      out.triangles.push_back({number[a], number[b], number[c]});
      kept.push_back(t);
    }
    out.triangle_columns = complex_.triangle_columns.pick(kept);
    add_curves(out, number);
    label_sheets(out, Incidence(out.view()));
    std::vector<std::int32_t> before;
    for (const std::uint32_t t : kept) before.push_back(axis_.sheet[t]);
    order_sheets_as(out, before);
    return out;
  }

 private:
  /// Sheets in the order of their removal: by ascending angle, then ascending number.
  using Waiting = std::pair<float, std::uint32_t>;
  using Line = std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>>;

  void add_curves(Complex& out, const std::vector<std::uint32_t>& number) const {
    std::vector<float> angles;
    for (std::uint32_t e = 0; e < edge_count(); ++e) {
      if (is_edge_gone_[e] || triangle_count_[e] > 0) continue;
      const auto& [a, b] = incidence_.edges()[e];
      out.edges.push_back({number[a], number[b]});
      angles.push_back(angle_of_edge_[e]);
    }
    out.edge_columns = Columns(out.edges.size());
    out.edge_columns.add({std::string(medial_columns::separation_angle), 1, std::move(angles)});
    out.edge_columns.add<std::int32_t>(std::string(medial_columns::role), 1,
                                       static_cast<std::int32_t>(MedialRole::curve));
  }

  void find_edges() {
    angle_of_edge_.assign(edge_count(), 0);
    for (std::size_t i = 0; i < axis_.edges.size(); ++i) {
      angle_of_edge_[incidence_.edge_of_listed()[i]] = axis_.edge_angle[i];
    }
    for (std::uint32_t e = 0; e < edge_count(); ++e) {
      const std::span<const std::uint32_t> triangles = incidence_.triangles_of_edge()[e];
      for (const std::uint32_t t : triangles) angle_of_edge_[e] = std::max(angle_of_edge_[e], axis_.triangle_angle[t]);
      triangle_count_.push_back(static_cast<std::uint32_t>(triangles.size()));
    }
    for (std::size_t v = 0; v < axis_.positions.size(); ++v) {
      edges_left_.push_back(static_cast<std::uint32_t>(incidence_.edges_of_vertex()[v].size()));
    }
    is_triangle_gone_.assign(axis_.triangles.size(), false);
    is_edge_gone_.assign(edge_count(), false);
    is_vertex_gone_.assign(axis_.positions.size(), false);
  }

  void find_sheets() {
    const std::size_t count = sheet_count(complex_);
    triangles_of_sheet_.resize(count);
    angle_of_sheet_.assign(count, 0);
    for (std::uint32_t t = 0; t < axis_.triangles.size(); ++t) {
      triangles_of_sheet_[sheet_of(t)].push_back(t);
      float& angle = angle_of_sheet_[sheet_of(t)];
      angle = std::max(angle, axis_.triangle_angle[t]);
    }
    is_sheet_gone_.assign(count, false);
    is_in_line_.assign(count, false);
  }

  [[nodiscard]] std::size_t edge_count() const { return incidence_.edges().size(); }
  [[nodiscard]] const std::array<std::uint32_t, 2>& edge_ends(std::uint32_t e) const { return incidence_.edges()[e]; }
  [[nodiscard]] const std::array<std::uint32_t, 3>& sides_of(std::uint32_t t) const { return incidence_.sides()[t]; }
  [[nodiscard]] std::uint32_t sheet_of(std::uint32_t t) const { return static_cast<std::uint32_t>(axis_.sheet[t]); }

  void offer(std::uint32_t sheet, Line& line) {
    if (is_sheet_gone_[sheet] || is_in_line_[sheet] || angle_of_sheet_[sheet] > theta_) return;
    is_in_line_[sheet] = true;
    line.emplace(angle_of_sheet_[sheet], sheet);
  }
  void look() {
    if (++steps_ % steps_between_looks == 0) throw_if_cancelled(context_);
  }

  /// Returns the triangle at an edge if it is the only one left and belongs to the sheet; otherwise none.
  [[nodiscard]] std::uint32_t free_triangle(std::uint32_t e, std::uint32_t sheet) const {
    if (is_edge_gone_[e] || triangle_count_[e] != 1) return none;
    for (const std::uint32_t t : incidence_.triangles_of_edge()[e]) {
      if (!is_triangle_gone_[t]) return sheet_of(t) == sheet ? t : none;
    }
    return none;
  }

  void set_pair(std::uint32_t e, std::uint32_t t, bool is_gone) {
    is_edge_gone_[e] = is_gone;
    is_triangle_gone_[t] = is_gone;
    for (const std::uint32_t side : sides_of(t)) triangle_count_[side] += is_gone ? -1U : 1U;
    for (const std::uint32_t v : edge_ends(e)) edges_left_[v] += is_gone ? -1U : 1U;
  }

  /// Removes a sheet by collapses from its rim. If some of its triangles cannot be removed, restores the sheet and
  /// returns false.
  bool consume(std::uint32_t sheet) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> gone;
    std::vector<std::uint32_t> line;
    for (const std::uint32_t t : triangles_of_sheet_[sheet])
      line.insert(line.end(), sides_of(t).begin(), sides_of(t).end());
    for (std::size_t next = 0; next < line.size(); ++next) {
      look();
      const std::uint32_t t = free_triangle(line[next], sheet);
      if (t == none) continue;
      set_pair(line[next], t, true);
      gone.emplace_back(line[next], t);
      line.insert(line.end(), sides_of(t).begin(), sides_of(t).end());
    }
    if (gone.size() == triangles_of_sheet_[sheet].size()) return true;
    for (; !gone.empty(); gone.pop_back()) set_pair(gone.back().first, gone.back().second, false);
    return false;
  }

  /// Removes the edges of a curve one by one, starting at a free end, while `goes` returns true for the next edge.
  template <class Goes>
  void trim_from(std::uint32_t vertex, const Goes& goes) {
    while (vertex != none && !is_vertex_gone_[vertex] && edges_left_[vertex] == 1) {
      look();
      std::uint32_t edge = none;
      for (const std::uint32_t e : incidence_.edges_of_vertex()[vertex]) {
        if (!is_edge_gone_[e]) edge = e;
      }
      if (edge == none || triangle_count_[edge] > 0 || !goes(edge)) return;
      is_edge_gone_[edge] = true;
      is_vertex_gone_[vertex] = true;
      --edges_left_[vertex];
      const std::uint32_t other = edge_ends(edge)[0] == vertex ? edge_ends(edge)[1] : edge_ends(edge)[0];
      --edges_left_[other];
      vertex = other;
    }
  }

  /// Removes the edges of a removed sheet that now belong to no triangle, starting at their free ends.
  void trim(std::uint32_t sheet) {
    std::vector<std::uint32_t> own;
    for (const std::uint32_t t : triangles_of_sheet_[sheet])
      own.insert(own.end(), sides_of(t).begin(), sides_of(t).end());
    std::sort(own.begin(), own.end());
    const auto is_own = [&](std::uint32_t e) { return std::binary_search(own.begin(), own.end(), e); };
    for (const std::uint32_t e : own) {
      for (const std::uint32_t v : edge_ends(e)) trim_from(v, is_own);
    }
  }
  void trim_curves() {
    const auto is_weak = [&](std::uint32_t e) { return angle_of_edge_[e] <= theta_; };
    for (std::uint32_t v = 0; v < edges_left_.size(); ++v) trim_from(v, is_weak);
  }

  const Complex& complex_;
  MedialView axis_;
  double theta_;
  const Context& context_;
  Incidence incidence_;
  std::vector<float> angle_of_edge_;
  std::vector<std::uint32_t> triangle_count_;  ///< for each edge: number of triangles left
  std::vector<std::uint32_t> edges_left_;      ///< for each vertex: number of edges left
  std::vector<bool> is_triangle_gone_, is_edge_gone_, is_vertex_gone_;
  std::vector<std::vector<std::uint32_t>> triangles_of_sheet_;
  std::vector<float> angle_of_sheet_;
  std::vector<bool> is_sheet_gone_, is_in_line_;
  std::size_t steps_ = 0;
};

/// @throws InvalidOption if a column is missing: the angles of edges, or the angles or sheets of triangles.
void check_needed(const Complex& axis) {
  const auto check = [](const Columns& columns, bool has_rows, const char* kind, std::string_view name) {
    if (has_rows && columns.find(name) == nullptr) throw InvalidOption(missing_medial_column(kind, name));
  };
  check(axis.edge_columns, !axis.edges.empty(), "edges", medial_columns::separation_angle);
  check(axis.triangle_columns, !axis.triangles.empty(), "triangles", medial_columns::separation_angle);
  check(axis.triangle_columns, !axis.triangles.empty(), "triangles", medial_columns::sheet);
}

}  // namespace

Complex prune_sheets(const Complex& axis, double theta, const Context& context) {
  check_angle("theta", theta);
  check_needed(axis);
  const CompleteAxis all(axis);
  if (const std::string problem = problem_of_medial(all.get()); !problem.empty()) {
    throw InvalidOption("this is not a medial axis, so its sheets cannot be pruned: " + problem);
  }
  Pruner pruner(all.get(), theta, context);
  pruner.prune();
  Complex out = pruner.result();
  for (const Column& column : all.get().vertex_columns) {
    const bool was_there = axis.vertex_columns.find(column.name) != nullptr;
    if (!was_there && column.name != medial_columns::role) out.vertex_columns.erase(column.name);
  }
  return out;
}

}  // namespace blum
