#include "blum/complex/components.hpp"

#include <string>

#include "blum/core/ids.hpp"
#include "blum/core/union_find.hpp"

namespace blum {
namespace {

template <std::size_t n>
void append_cells(std::vector<std::array<std::uint32_t, n>>& cells, std::span<const std::array<std::uint32_t, n>> more,
                  std::uint32_t first_vertex) {
  for (std::array<std::uint32_t, n> cell : more) {
    for (std::uint32_t& v : cell) v += first_vertex;
    cells.push_back(cell);
  }
}

/// @param count       number of cells that `columns` belongs to.
/// @param more_count  number of cells that `more` belongs to.
void append_columns(Columns& columns, std::size_t count, const Columns& more, std::size_t more_count) {
  if (more_count == 0) return;
  if (count == 0) {
    columns = more;
  } else {
    columns.append(more);
  }
}

}  // namespace

std::vector<std::uint32_t> components(const ComplexView& complex) {
  if (const std::string problem = problem_of(complex); !problem.empty()) {
    throw InvalidOption("not a complex: " + problem);
  }
  detail::UnionFind joined(complex.vertex_count);
  for (const auto& [a, b] : complex.edges) joined.join(a, b);
  for (const auto& [a, b, c] : complex.triangles) {
    joined.join(a, b);
    joined.join(a, c);
  }
  std::vector<std::uint32_t> component(complex.vertex_count);
  for (std::uint32_t v = 0; v < component.size(); ++v) component[v] = joined.find(v);
  return component;
}

Complex disjoint_union(std::span<const Complex> parts) {
  Complex all;
  for (const Complex& part : parts) {
    const std::size_t vertices = all.positions.size();
    if (vertices + part.positions.size() > max_id_count) throw InvalidOption("there are more than 2^31 - 1 vertices");
    append_columns(all.vertex_columns, vertices, part.vertex_columns, part.positions.size());
    append_columns(all.edge_columns, all.edges.size(), part.edge_columns, part.edges.size());
    append_columns(all.triangle_columns, all.triangles.size(), part.triangle_columns, part.triangles.size());
    append_cells<2>(all.edges, part.edges, static_cast<std::uint32_t>(vertices));
    append_cells<3>(all.triangles, part.triangles, static_cast<std::uint32_t>(vertices));
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
  }
  return all;
}

}  // namespace blum
