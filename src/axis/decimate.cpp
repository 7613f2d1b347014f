#include "blum/axis/decimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/axis/sheet_decimator.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"

namespace blum {
namespace {

using detail::DecimatorInput;
using detail::SheetDecimator;

/// Limits of the successive passes, as fractions of the tolerance. Each pass removes only vertices whose removal moves
/// sheets by at most its limit.
constexpr std::array levels{1.0 / 256, 1.0 / 16, 1.0 / 4, 0.8};

/// The sheet of each triangle, and the patches on its sides if the axis has them.
class SheetParts {
 public:
  explicit SheetParts(const Columns& triangles) {
    columns_.push_back(triangles.get<std::int32_t>(medial_columns::sheet));
    for (const std::string_view name : medial_columns::patches) {
      if (triangles.find(name) != nullptr) columns_.push_back(triangles.get<std::int32_t>(name));
    }
  }
  [[nodiscard]] bool same(std::uint32_t a, std::uint32_t b) const {
    return std::all_of(columns_.begin(), columns_.end(), [&](const auto& column) { return column[a] == column[b]; });
  }

 private:
  std::vector<std::span<const std::int32_t>> columns_;
};

/// Returns the edges that bound sheets: the edges that the axis lists, and those between triangles of different sheets
/// or different patches.
std::vector<std::array<std::uint32_t, 2>> borders_of(const Complex& axis, const Context& context) {
  std::vector<std::array<std::uint32_t, 2>> borders = axis.edges;
  const Incidence incidence(axis.view(), context);
  std::vector<bool> is_listed(incidence.edges().size(), false);
  for (const std::uint32_t e : incidence.edge_of_listed()) is_listed[e] = true;
  const SheetParts parts(axis.triangle_columns);
  for (std::size_t e = 0; e < is_listed.size(); ++e) {
    const auto triangles = incidence.triangles_of_edge()[e];
    if (is_listed[e] || triangles.empty()) continue;
    const bool is_inner = triangles.size() == 2 && parts.same(triangles[0], triangles[1]);
    if (!is_inner) borders.push_back(incidence.edges()[e]);
  }
  return borders;
}

DecimatorInput input_of(const Complex& axis, const Context& context) {
  const MedialView view(axis);
  DecimatorInput input{.triangles = axis.triangles,
                       .triangle_angle = {view.triangle_angle.begin(), view.triangle_angle.end()},
                       .borders = borders_of(axis, context)};
  input.points.reserve(axis.positions.size());
  for (std::size_t v = 0; v < axis.positions.size(); ++v) input.points.push_back({axis.positions[v], view.radius[v]});
  // Edges between two sheets without a seam get the kind -1, which no role has.
  input.border_kind.assign(input.borders.size(), -1);
  for (std::size_t e = 0; e < axis.edges.size(); ++e) input.border_kind[e] = static_cast<int>(view.edge_role(e));
  return input;
}

/// Sets the angle of each rim and seam edge to the largest angle of its remaining triangles.
void give_borders_angles(Complex& axis) {
  const auto of_triangle = axis.triangle_columns.get<float>(medial_columns::separation_angle);
  std::vector<std::pair<std::array<std::uint32_t, 2>, float>> sides;
  sides.reserve(3 * axis.triangles.size());
  for (std::size_t t = 0; t < axis.triangles.size(); ++t) {
    const auto& [a, b, c] = axis.triangles[t];
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      sides.push_back({{std::min(p, q), std::max(p, q)}, of_triangle[t]});
    }
  }
  std::sort(sides.begin(), sides.end());
  const auto angles = axis.edge_columns.edit<float>(medial_columns::separation_angle);
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    const std::array<std::uint32_t, 2> edge{std::min(axis.edges[e][0], axis.edges[e][1]),
                                            std::max(axis.edges[e][0], axis.edges[e][1])};
    // The sides are sorted, so the last side of an edge has the largest angle.
    const auto after = std::upper_bound(sides.begin(), sides.end(), edge,
                                        [](const auto& value, const auto& side) { return value < side.first; });
    if (after != sides.begin() && std::prev(after)->first == edge) angles[e] = std::prev(after)->second;
  }
}

Complex rest_of(const Complex& axis, const SheetDecimator& decimator) {
  Complex out = decimator.cells().rest_of(axis);
  const auto angles = out.triangle_columns.edit<float>(medial_columns::separation_angle);
  std::size_t k = 0;
  for (std::uint32_t t = 0; t < axis.triangles.size(); ++t) {
    if (decimator.cells().has_triangle(t)) angles[k++] = decimator.triangle_angle()[t];
  }
  give_borders_angles(out);
  return out;
}

}  // namespace

DecimatedAxis decimate(const Complex& axis, double tolerance, const Context& context) {
  if (!(tolerance >= 0 && std::isfinite(tolerance))) {
    throw InvalidOption("tolerance is " + exact_text(tolerance) + ", but must be at least 0");
  }
  if (const std::string problem = problem_of_medial(axis); !problem.empty()) {
    throw InvalidOption("this is not a medial axis, so its triangles cannot be decimated: " + problem);
  }
  if (tolerance == 0) return {axis, 0, axis.positions.size()};
  SheetDecimator decimator(input_of(axis, context), tolerance, context);
  decimator.run(levels);
  return {rest_of(axis, decimator), decimator.moved(), axis.positions.size()};
}

}  // namespace blum
