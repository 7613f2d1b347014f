#include "medial_axis/label_sheets.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/union_find.hpp"
#include "medial_axis/sheet_joiner.hpp"

namespace blum {
namespace {

constexpr std::int32_t no_sheet = -1;

/// As columns hold it.
constexpr std::int32_t number_of(MedialRole role) {
  return static_cast<std::int32_t>(role);
}

/// What is known of a vertex from its edges.
struct Around {
  std::uint32_t rims = 0, seams = 0, curves = 0;
  std::int32_t sheet = no_sheet;
  bool has_several_sheets = false;
};

MedialRole role_of(const Around& a) {
  if (a.curves == 0 && a.seams == 0) {
    if (a.sheet == no_sheet) return MedialRole::curve;                    // a vertex alone
    if (a.rims > 2 || a.has_several_sheets) return MedialRole::junction;  // sheets touch here only
    return a.rims > 0 ? MedialRole::rim : MedialRole::sheet;
  }
  if (a.seams == 2 && a.curves == 0) return a.rims == 0 ? MedialRole::seam : MedialRole::junction;
  if (a.curves <= 2 && a.seams == 0 && a.rims == 0 && a.sheet == no_sheet) return MedialRole::curve;
  return MedialRole::junction;
}

/// Adds the sides of triangles that are rims or seams to the edges; returns those that are neither.
std::vector<Hinge> add_rims_and_seams(Complex& axis, const Incidence& incidence) {
  const std::span<const float> angles = axis.triangle_columns.get<float>(medial_columns::separation_angle);
  std::vector<Hinge> hinges;
  std::vector<float> new_angles;
  std::vector<std::int32_t> new_roles;
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    const std::span<const std::uint32_t> triangles = incidence.triangles_of_edge()[e];
    if (triangles.empty()) continue;
    if (triangles.size() == 2) {
      hinges.push_back({incidence.edges()[e], {triangles[0], triangles[1]}});
      continue;
    }
    float largest = 0;
    for (const std::uint32_t t : triangles) largest = std::max(largest, angles[t]);
    axis.edges.push_back(incidence.edges()[e]);
    new_angles.push_back(largest);
    new_roles.push_back(number_of(triangles.size() == 1 ? MedialRole::rim : MedialRole::seam));
  }
  axis.edge_columns.resize(axis.edges.size());
  const auto first = static_cast<std::ptrdiff_t>(axis.edges.size() - new_angles.size());
  const std::span<float> edge_angles = axis.edge_columns.edit<float>(medial_columns::separation_angle);
  std::copy(new_angles.begin(), new_angles.end(), edge_angles.begin() + first);
  const std::span<std::int32_t> edge_roles = axis.edge_columns.edit<std::int32_t>(medial_columns::role);
  std::copy(new_roles.begin(), new_roles.end(), edge_roles.begin() + first);
  return hinges;
}

void number_sheets(Complex& axis, detail::UnionFind sheets) {
  const std::span<std::int32_t> sheet_of = axis.triangle_columns.edit<std::int32_t>(medial_columns::sheet);
  std::int32_t count = 0;
  for (std::uint32_t t = 0; t < sheet_of.size(); ++t) {
    // The smallest triangle of a sheet stands for it, and so has its number before the others.
    const std::uint32_t first = sheets.find(t);
    sheet_of[t] = first == t ? count++ : sheet_of[first];
  }
}

void find_vertex_roles(Complex& axis) {
  std::vector<Around> around(axis.positions.size());
  const std::span<const std::int32_t> edge_roles = axis.edge_columns.get<std::int32_t>(medial_columns::role);
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    for (const std::uint32_t v : axis.edges[e]) {
      ++(edge_roles[e] == number_of(MedialRole::rim)    ? around[v].rims
         : edge_roles[e] == number_of(MedialRole::seam) ? around[v].seams
                                                        : around[v].curves);
    }
  }
  const std::span<const std::int32_t> sheets = axis.triangle_columns.get<std::int32_t>(medial_columns::sheet);
  for (std::size_t t = 0; t < axis.triangles.size(); ++t) {
    for (const std::uint32_t v : axis.triangles[t]) {
      if (around[v].sheet != no_sheet && around[v].sheet != sheets[t]) around[v].has_several_sheets = true;
      around[v].sheet = sheets[t];
    }
  }
  const std::span<std::int32_t> roles = axis.vertex_columns.edit<std::int32_t>(medial_columns::role);
  for (std::size_t v = 0; v < around.size(); ++v) roles[v] = number_of(role_of(around[v]));
}

}  // namespace

void label_sheets(Complex& axis, const Incidence& incidence) {
  const std::vector<Hinge> hinges = add_rims_and_seams(axis, incidence);
  number_sheets(axis, join_sheets(axis, hinges));
  find_vertex_roles(axis);
}

}  // namespace blum
