#include "axis/patch_axis.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "blum/axis/label_sheets.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"

namespace blum::detail {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

void check_columns(const Complex& axis) {
  for (const std::string_view name :
       {medial_columns::patches[0], medial_columns::patches[1], medial_columns::patch_sheet}) {
    if (axis.triangles.empty() || axis.triangle_columns.find(name) != nullptr) continue;
    throw InvalidOption("a graph of patches needs the triangle column '" + std::string(name) +
                        "', which this axis does not have: make the axis from a Voronoi diagram with patches");
  }
}

/// Adds the curves of an axis to another complex, with all columns.
void add_curves(const Complex& axis, Complex& out) {
  const MedialView view(axis);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t e = 0; e < axis.edges.size(); ++e) {
    if (view.edge_role(e) != MedialRole::curve) continue;
    kept.push_back(e);
    out.edges.push_back(axis.edges[e]);
  }
  out.edge_columns = axis.edge_columns.pick(kept);
}

void add_triangles(const Complex& axis, Complex& out) {
  if (axis.triangles.empty()) return;
  const auto sheets = axis.triangle_columns.get<std::int32_t>(medial_columns::patch_sheet);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t t = 0; t < axis.triangles.size(); ++t) {
    if (sheets[t] < 0) continue;
    kept.push_back(t);
    out.triangles.push_back(axis.triangles[t]);
  }
  out.triangle_columns = axis.triangle_columns.pick(kept);
}

}  // namespace

PatchAxis::PatchAxis(const Complex& axis, const Context& context) {
  check_columns(axis);
  add_curves(axis, axis_);
  add_triangles(axis, axis_);
  pick_vertices(axis);
  label_sheets(axis_, Incidence(axis_.view(), context));  // adds rims and seams; its sheets are replaced
  if (axis_.triangles.empty()) return;
  const auto sheets = axis_.triangle_columns.get<std::int32_t>(medial_columns::patch_sheet);
  std::copy(sheets.begin(), sheets.end(), axis_.triangle_columns.edit<std::int32_t>(medial_columns::sheet).begin());
}

/// Keeps the vertices of the curves and triangles that are left.
void PatchAxis::pick_vertices(const Complex& axis) {
  std::vector<std::uint32_t> number(axis.positions.size(), none);
  for (const auto& edge : axis_.edges) {
    for (const std::uint32_t v : edge) number[v] = 0;
  }
  for (const auto& triangle : axis_.triangles) {
    for (const std::uint32_t v : triangle) number[v] = 0;
  }
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == none) continue;
    number[v] = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(v);
    axis_.positions.push_back(axis.positions[v]);
  }
  for (auto& edge : axis_.edges) {
    for (std::uint32_t& v : edge) v = number[v];
  }
  for (auto& triangle : axis_.triangles) {
    for (std::uint32_t& v : triangle) v = number[v];
  }
  axis_.vertex_columns = axis.vertex_columns.pick(vertices_);
}

void PatchAxis::complete(AxisGraph& graph) const {
  for (AxisJunction& junction : graph.junctions) junction.vertex = vertices_[junction.vertex];
  for (std::vector<AxisLine>* lines : {&graph.seams, &graph.curves}) {
    for (AxisLine& line : *lines) {
      for (std::uint32_t& v : line.vertices) v = vertices_[v];
    }
  }
  if (axis_.triangles.empty()) return;
  const auto sheets = axis_.triangle_columns.get<std::int32_t>(medial_columns::patch_sheet);
  const auto patch_a = axis_.triangle_columns.get<std::int32_t>(medial_columns::patches[0]);
  const auto patch_b = axis_.triangle_columns.get<std::int32_t>(medial_columns::patches[1]);
  std::vector<std::uint32_t> first(sheet_count(axis_), none);  // for each sheet, one of its triangles
  for (std::uint32_t t = 0; t < sheets.size(); ++t) first[static_cast<std::size_t>(sheets[t])] = t;
  for (AxisSheet& sheet : graph.sheets) {
    const std::uint32_t t = first[sheet.sheet];
    sheet.sides = {static_cast<std::uint32_t>(patch_a[t]), static_cast<std::uint32_t>(patch_b[t])};
  }
}

}  // namespace blum::detail
