#include "blum/complex/medial_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blum {
namespace {

namespace names = medial_columns;

/// @param count  number of vertices, edges or triangles that the columns belong to.
/// @param kind   "vertices", "edges" or "triangles".
template <ColumnNumber T>
std::span<const T> column(const Columns& columns, std::size_t count, const char* kind, std::string_view name,
                          std::size_t components = 1) {
  if (columns.find(name) == nullptr) throw InvalidOption(missing_medial_column(kind, name));
  const std::span<const T> numbers = columns.get<T>(name, components);
  if (numbers.size() != count * components) {
    throw InvalidOption("column '" + std::string(name) + "' has " + std::to_string(numbers.size() / components) +
                        " rows, but must have " + std::to_string(count));
  }
  return numbers;
}

std::string place(const char* what, std::size_t index) {
  return std::string(what) + " " + std::to_string(index) + " (counted from 0)";
}

bool is_role(std::int32_t number) {
  return number >= 0 && number <= static_cast<std::int32_t>(MedialRole::junction);
}

bool is_role_of_edges(std::int32_t number) {
  return is_role(number) && number != static_cast<std::int32_t>(MedialRole::sheet) &&
         number != static_cast<std::int32_t>(MedialRole::junction);
}

/// Returns a description of the problem of a vertex; null if the vertex is valid.
const char* vertex_problem(const MedialView& axis, std::size_t v, std::int32_t role) {
  if (!std::isfinite(axis.radius[v]) || axis.radius[v] < 0) return "has a radius that is negative or not finite";
  if (!is_finite(axis.footprint(v, 0)) || !is_finite(axis.footprint(v, 1))) return "has a footprint that is not finite";
  if (!std::isfinite(axis.separation_angle[v])) return "has an angle that is not finite";
  for (const std::size_t k : {0U, 1U}) {
    const SiteId site = axis.site(v, k);
    if (site.has_value() && site.value > max_id_count) return "has a site that is neither an index nor -1";
  }
  return is_role(role) ? nullptr : "has an unknown role";
}

/// Returns a message about the first wrong number; empty if no number is wrong.
/// @param is_wrong  returns true for a wrong number.
template <class T, class Test>
std::string problem_of_numbers(std::span<const T> numbers, const char* what, const char* problem,
                               const Test& is_wrong) {
  const auto at = std::find_if(numbers.begin(), numbers.end(), is_wrong);
  if (at == numbers.end()) return {};
  return place(what, static_cast<std::size_t>(at - numbers.begin())) + " " + problem;
}

/// Allows at most one sheet per triangle, so that sheet numbers in a file cannot cause huge allocations.
std::string problem_of_sheets(std::span<const std::int32_t> sheets) {
  std::int64_t count = 0;
  for (std::size_t t = 0; t < sheets.size(); ++t) {
    if (sheets[t] < 0) return place("triangle", t) + " has a negative sheet number";
    count = std::max(count, std::int64_t{sheets[t]} + 1);
  }
  if (static_cast<std::size_t>(count) <= sheets.size()) return {};
  return "there are " + std::to_string(count) + " sheets, but only " + std::to_string(sheets.size()) + " triangles";
}

std::string problem_of_levels(const MedialLevels& levels) {
  const auto is_nan = [](float level) { return std::isnan(level); };
  for (const auto& [numbers, what] :
       {std::pair{levels.vertex_until, "vertex"}, std::pair{levels.edge_from, "edge"},
        std::pair{levels.edge_until, "edge"}, std::pair{levels.triangle_until, "triangle"}}) {
    std::string problem = problem_of_numbers(numbers, what, "has an angle that is not a number", is_nan);
    if (!problem.empty()) return problem;
  }
  return {};
}

std::string problem_of_values(const Complex& axis) {
  const MedialView view(axis);
  const std::span<const std::int32_t> roles = axis.vertex_columns.get<std::int32_t>(names::role);
  for (std::size_t v = 0; v < view.positions.size(); ++v) {
    if (const char* problem = vertex_problem(view, v, roles[v])) return place("vertex", v) + " " + problem;
  }
  const auto is_not_finite = [](float angle) { return !std::isfinite(angle); };
  for (std::string problem :
       {problem_of_numbers(view.edge_angle, "edge", "has an angle that is not finite", is_not_finite),
        problem_of_numbers(axis.edge_columns.get<std::int32_t>(names::role), "edge",
                           "has a role other than curve, rim and seam",
                           [](std::int32_t role) { return !is_role_of_edges(role); }),
        problem_of_numbers(view.triangle_angle, "triangle", "has an angle that is not finite", is_not_finite),
        problem_of_sheets(view.sheet)}) {
    if (!problem.empty()) return problem;
  }
  return {};
}

/// Returns the result of a check. If a column is missing or has another type, returns the message of that error.
template <class Check>
std::string problem_in(const Check& check) {
  try {
    return check();
  } catch (const InvalidOption& wrong) {
    return wrong.what();
  }
}

template <ColumnNumber T>
void add_missing(Columns& columns, std::string_view name, std::size_t components = 1, T fill = T{}) {
  if (columns.find(name) == nullptr) columns.add<T>(std::string(name), components, fill);
}

}  // namespace

MedialView::MedialView(const Complex& complex)
    : positions(complex.positions),
      radius(column<double>(complex.vertex_columns, positions.size(), "vertices", names::radius)),
      separation_angle(column<double>(complex.vertex_columns, positions.size(), "vertices", names::separation_angle)),
      edges(complex.edges),
      edge_angle(column<float>(complex.edge_columns, edges.size(), "edges", names::separation_angle)),
      triangles(complex.triangles),
      triangle_angle(column<float>(complex.triangle_columns, triangles.size(), "triangles", names::separation_angle)),
      sheet(column<std::int32_t>(complex.triangle_columns, triangles.size(), "triangles", names::sheet)),
      roles_(column<std::int32_t>(complex.vertex_columns, positions.size(), "vertices", names::role)),
      edge_roles_(column<std::int32_t>(complex.edge_columns, edges.size(), "edges", names::role)) {
  for (std::size_t k = 0; k < 2; ++k) {
    footprints_[k] = column<double>(complex.vertex_columns, positions.size(), "vertices", names::footprints[k], 3);
    sites_[k] = column<std::int32_t>(complex.vertex_columns, positions.size(), "vertices", names::sites[k]);
  }
}

MedialLevels::MedialLevels(const Complex& complex)
    : vertex_until(column<float>(complex.vertex_columns, complex.positions.size(), "vertices", names::until)),
      edge_from(column<float>(complex.edge_columns, complex.edges.size(), "edges", names::from)),
      edge_until(column<float>(complex.edge_columns, complex.edges.size(), "edges", names::until)),
      triangle_until(column<float>(complex.triangle_columns, complex.triangles.size(), "triangles", names::until)) {}

std::string missing_medial_column(std::string_view kind, std::string_view name) {
  const bool is_in_ma = kind == "vertices" && name == names::radius;
  return "the axis has no column '" + std::string(name) + "' of " + std::string(kind) + ", which is needed; " +
         (is_in_ma ? ".vtp, .ply, .npz and .ma files hold it, .obj files do not"
                   : ".vtp, .ply and .npz files hold it, .obj and .ma files do not");
}

CompleteAxis::CompleteAxis(const Complex& axis) : axis_(axis) {
  const auto has = [](const Columns& columns, auto... all) { return ((columns.find(all) != nullptr) && ...); };
  if (has(axis.vertex_columns, names::radius, names::footprints[0], names::footprints[1], names::sites[0],
          names::sites[1], names::separation_angle, names::role) &&
      has(axis.edge_columns, names::separation_angle, names::role) &&
      has(axis.triangle_columns, names::separation_angle, names::sheet)) {
    return;
  }
  add_missing_medial_columns(copy_.emplace(axis));
}

void add_missing_medial_columns(Complex& complex) {
  const auto prepared = [](Columns& columns, std::size_t count) -> Columns& {
    if (columns.empty()) columns.resize(count);
    return columns;
  };
  Columns& vertices = prepared(complex.vertex_columns, complex.positions.size());
  add_missing<double>(vertices, names::radius);
  for (const std::string_view name : names::footprints) add_missing<double>(vertices, name, 3);
  for (const std::string_view name : names::sites) add_missing<std::int32_t>(vertices, name, 1, -1);
  add_missing<double>(vertices, names::separation_angle);
  add_missing<std::int32_t>(vertices, names::role, 1, static_cast<std::int32_t>(MedialRole::sheet));
  Columns& edges = prepared(complex.edge_columns, complex.edges.size());
  add_missing<float>(edges, names::separation_angle);
  add_missing<std::int32_t>(edges, names::role, 1, static_cast<std::int32_t>(MedialRole::curve));
  Columns& triangles = prepared(complex.triangle_columns, complex.triangles.size());
  add_missing<float>(triangles, names::separation_angle);
  add_missing<std::int32_t>(triangles, names::sheet);
}

std::string problem_of_medial(const Complex& axis) {
  std::string problem = problem_of(axis);
  if (!problem.empty()) return problem;
  if (axis.positions.size() > max_id_count) return "there are more than 2^31 - 1 vertices";
  return problem_in([&] { return problem_of_values(axis); });
}

std::string problem_of_nested(const Complex& axes) {
  std::string problem = problem_of_medial(axes);
  return problem.empty() ? problem_in([&] { return problem_of_levels(MedialLevels(axes)); }) : problem;
}

std::size_t sheet_count(const Complex& axis) {
  std::int32_t largest = -1;
  for (const std::int32_t sheet :
       column<std::int32_t>(axis.triangle_columns, axis.triangles.size(), "triangles", names::sheet)) {
    largest = std::max(largest, sheet);
  }
  return static_cast<std::size_t>(std::int64_t{largest} + 1);
}

MedialCounts count(const Complex& axis) {
  const MedialView view(axis);
  MedialCounts counts;
  counts.vertices = view.positions.size();
  counts.triangles = view.triangles.size();
  counts.sheets = sheet_count(axis);
  for (std::size_t e = 0; e < view.edges.size(); ++e) {
    const MedialRole role = view.edge_role(e);
    ++(role == MedialRole::rim ? counts.rim_edges : role == MedialRole::seam ? counts.seam_edges : counts.curve_edges);
  }
  for (std::size_t v = 0; v < view.positions.size(); ++v)
    counts.junctions += view.role(v) == MedialRole::junction ? 1 : 0;
  return counts;
}

}  // namespace blum
