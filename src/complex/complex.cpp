#include "blum/complex/complex.hpp"

#include <algorithm>
#include <string_view>

namespace blum {
namespace {

template <std::size_t n>
std::string problem_of_cells(std::string_view kind, std::span<const std::array<std::uint32_t, n>> cells,
                             std::size_t vertex_count) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::array<std::uint32_t, n> corners = cells[i];
    std::sort(corners.begin(), corners.end());
    const auto problem = [&](std::uint32_t vertex, const std::string& what) {
      return std::string(kind) + " " + std::to_string(i) + " uses vertex " + std::to_string(vertex) + what;
    };
    if (corners.back() >= vertex_count) {
      return problem(corners.back(), ", but there are only " + std::to_string(vertex_count) + " vertices");
    }
    if (const auto twice = std::adjacent_find(corners.begin(), corners.end()); twice != corners.end()) {
      return problem(*twice, " twice");
    }
  }
  return {};
}

std::string problem_of_columns(std::string_view kind, const Columns& columns, std::size_t rows) {
  if (columns.empty() || columns.rows() == rows) return {};
  return "the columns of " + std::string(kind) + " have " + std::to_string(columns.rows()) + " rows, but " +
         std::to_string(rows) + " are needed";
}

}  // namespace

std::string problem_of(const ComplexView& complex) {
  std::string problem = problem_of_cells<2>("edge", complex.edges, complex.vertex_count);
  return problem.empty() ? problem_of_cells<3>("triangle", complex.triangles, complex.vertex_count) : problem;
}

std::string problem_of(const Complex& complex) {
  const std::size_t vertices = complex.positions.size();
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!is_finite(complex.positions[v])) return "the position of vertex " + std::to_string(v) + " is not finite";
  }
  for (std::string problem :
       {problem_of(complex.view()), problem_of_columns("vertices", complex.vertex_columns, vertices),
        problem_of_columns("edges", complex.edge_columns, complex.edges.size()),
        problem_of_columns("triangles", complex.triangle_columns, complex.triangles.size())}) {
    if (!problem.empty()) return problem;
  }
  return {};
}

void validate(const Complex& complex) {
  if (std::string problem = problem_of(complex); !problem.empty()) throw InvalidMesh("complex: " + problem);
}

}  // namespace blum
