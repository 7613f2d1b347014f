#include "blum/medial_axis/axis_forms.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum {

double least_spacing(const MedialAxisReport& report) {
  double least = report.bodies.front().spacing;
  for (const BodyReport& body : report.bodies) least = std::min(least, body.spacing);
  return least;
}

std::vector<AxisForm> axis_forms(const MedialAxisReport& report, std::optional<double> tolerance) {
  const double most = tolerance.value_or(0.25 * least_spacing(report));
  if (!(most >= 0)) throw InvalidOption("the tolerance of an axis is at least 0");
  std::vector<AxisForm> forms;
  if (most > 0 && report.rule == SolidRule::polyhedron) {
    forms.push_back({true, most, "borders of sheets stay at the cells of the grid: elsewhere, "});
  }
  if (most > 0) forms.push_back({false, most, "the axis keeps all vertices: with fewer, "});
  forms.emplace_back();
  return forms;
}

std::vector<MovedGrid> moved_grids(double grid_shift) {
  constexpr std::size_t most = 3;
  std::vector<MovedGrid> grids;
  for (const double step : {0.3, -0.3, 0.15, -0.15, 0.6, -0.6}) {
    if (grids.size() == most) break;
    if (std::abs(grid_shift + step) > 1) continue;
    grids.push_back({grid_shift + step, "the grid was moved by " + rounded_text(step) + " voxels: as it was, "});
  }
  return grids;
}

DecimatedAxis decimate(Complex whole, const AxisForm& form, const Context& context) {
  if (form.tolerance) return decimate(whole, *form.tolerance, context);
  const std::size_t vertices = whole.positions.size();
  return {std::move(whole), 0, vertices};
}

DecimatedAxis axis_in_form(const MedialAxis& axis, double theta, const AxisForm& form, const Context& context) {
  if (form.is_fitted && form.tolerance) return axis.lean(theta, *form.tolerance, context);
  return decimate(form.is_fitted ? axis.fitted(theta, context) : axis.simplify(theta, context), form, context);
}

}  // namespace blum
