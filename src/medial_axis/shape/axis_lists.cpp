#include "medial_axis/shape/axis_lists.hpp"

#include <optional>
#include <string>
#include <utility>

#include "blum/complex/medial_columns.hpp"

namespace blum::detail {
namespace {

/// Adds a column with `components` numbers for each vertex. `numbers_of` returns the number for a vertex and a
/// component.
template <ColumnNumber T, class NumbersOf>
void add_column(Columns& columns, const std::vector<AxisVertex>& vertices, std::string_view name,
                std::size_t components, const NumbersOf& numbers_of) {
  std::vector<T> numbers;
  numbers.reserve(vertices.size() * components);
  for (const AxisVertex& vertex : vertices) {
    for (std::size_t c = 0; c < components; ++c) numbers.push_back(numbers_of(vertex, c));
  }
  columns.add({std::string(name), components, std::move(numbers)});
}

Columns columns_of(const std::vector<AxisVertex>& vertices) {
  using V = AxisVertex;
  namespace names = medial_columns;
  Columns columns(vertices.size());
  add_column<double>(columns, vertices, names::radius, 1, [](const V& v, std::size_t) { return v.radius; });
  for (std::size_t k = 0; k < 2; ++k) {
    add_column<double>(columns, vertices, names::footprints[k], 3,
                       [&](const V& v, std::size_t c) { return v.footprints[k][c]; });
  }
  for (std::size_t k = 0; k < 2; ++k) {
    add_column<std::int32_t>(columns, vertices, names::sites[k], 1,
                             [&](const V& v, std::size_t) { return v.sites[k].to_file(); });
  }
  add_column<double>(columns, vertices, names::separation_angle, 1,
                     [](const V& v, std::size_t) { return v.separation_angle; });
  return columns;
}

Columns columns_of(std::vector<float> angles) {
  Columns columns(angles.size());
  columns.add({std::string(medial_columns::separation_angle), 1, std::move(angles)});
  return columns;
}

}  // namespace

namespace {

/// @param edge, triangle  callables: return the vertices of an edge or triangle that is kept, and nullopt for others.
template <class HasVertex, class Edge, class Triangle>
void keep_in_place(AxisLists& lists, const HasVertex& has_vertex, const Edge& edge, const Triangle& triangle) {
  std::vector<std::uint32_t> number(lists.vertices.size(), 0);
  std::uint32_t left = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    number[v] = left;
    if (!has_vertex(v)) continue;
    if (left != v) lists.vertices[left] = lists.vertices[v];
    ++left;
  }
  lists.vertices.resize(left);
  const auto keep_cells = [&](auto& cells, std::vector<float>& angles, const auto& cell_left) {
    std::size_t kept = 0;
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
      const auto corners = cell_left(c);
      if (!corners) continue;
      for (std::size_t k = 0; k < corners->size(); ++k) cells[kept][k] = number[(*corners)[k]];
      angles[kept++] = angles[c];
    }
    cells.resize(kept);
    angles.resize(kept);
  };
  keep_cells(lists.edges, lists.edge_angles, edge);
  keep_cells(lists.triangles, lists.triangle_angles, triangle);
}

}  // namespace

void keep(const ShrinkingComplex& cells, AxisLists& lists) {
  keep_in_place(
      lists, [&](std::uint32_t v) { return cells.has_vertex(v); },
      [&](std::uint32_t e) { return cells.has_edge(e) ? std::optional(cells.edge(e)) : std::nullopt; },
      [&](std::uint32_t t) { return cells.has_triangle(t) ? std::optional(cells.triangle(t)) : std::nullopt; });
}

void keep(const std::vector<bool>& has_vertex, const std::vector<bool>& has_triangle, AxisLists& lists) {
  keep_in_place(
      lists, [&](std::uint32_t v) { return bool(has_vertex[v]); },
      [&](std::uint32_t e) { return std::optional(lists.edges[e]); },
      [&](std::uint32_t t) { return has_triangle[t] ? std::optional(lists.triangles[t]) : std::nullopt; });
}

void append(AxisLists more, AxisLists& lists) {
  const auto first = static_cast<std::uint32_t>(lists.vertices.size());
  lists.vertices.insert(lists.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (std::size_t e = 0; e < more.edges.size(); ++e) {
    const auto& [a, b] = more.edges[e];
    lists.add_edge({first + a, first + b}, more.edge_angles[e]);
  }
  for (std::size_t t = 0; t < more.triangles.size(); ++t) {
    const auto& [a, b, c] = more.triangles[t];
    lists.add_triangle({first + a, first + b, first + c}, more.triangle_angles[t]);
  }
}

Complex complex_of(AxisLists lists) {
  Complex complex;
  complex.positions.reserve(lists.vertices.size());
  for (const AxisVertex& vertex : lists.vertices) complex.positions.push_back(vertex.position);
  complex.edges = std::move(lists.edges);
  complex.triangles = std::move(lists.triangles);
  complex.vertex_columns = columns_of(lists.vertices);
  complex.edge_columns = columns_of(std::move(lists.edge_angles));
  complex.triangle_columns = columns_of(std::move(lists.triangle_angles));
  add_missing_medial_columns(complex);
  return complex;
}

}  // namespace blum::detail
