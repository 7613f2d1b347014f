#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/union_find.hpp"
#include "medial_axis/certificate/checks.hpp"

namespace blum::verifier {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

/// @throws InvalidOption for a cell that names a vertex that is not there, or one twice.
template <class Cell>
void check_corners(const std::vector<Cell>& cells, std::size_t vertex_count) {
  for (const Cell& cell : cells) {
    auto corners = cell.vertices;
    std::sort(corners.begin(), corners.end());
    if (corners.back() >= vertex_count) {
      throw InvalidOption("a complex names vertex " + std::to_string(corners.back()) + " of " +
                          std::to_string(vertex_count));
    }
    if (std::adjacent_find(corners.begin(), corners.end()) != corners.end()) {
      throw InvalidOption("an edge or triangle of a complex names vertex " + std::to_string(corners[0]) + " twice");
    }
  }
}

/// For each vertex one that stands for all that are joined with it.
std::vector<std::uint32_t> components(const MedialComplex& axis) {
  detail::UnionFind joined(axis.vertices.size());
  for (const MedialEdge& edge : axis.edges) joined.join(edge.vertices[0], edge.vertices[1]);
  for (const MedialTriangle& triangle : axis.triangles) {
    joined.join(triangle.vertices[0], triangle.vertices[1]);
    joined.join(triangle.vertices[0], triangle.vertices[2]);
  }
  std::vector<std::uint32_t> component(axis.vertices.size());
  for (std::uint32_t v = 0; v < component.size(); ++v) component[v] = joined.find(v);
  return component;
}

/// Cells in the order of the bodies that they are in, with corners counted within these, and where each body begins.
template <class Corners>
struct Sorted {
  std::vector<Corners> cells;
  std::vector<std::size_t> first;

  [[nodiscard]] std::span<const Corners> in(std::uint32_t body) const {
    return {cells.data() + first[body], first[body + 1] - first[body]};
  }
};

template <class Corners, class Cell>
Sorted<Corners> sorted_by_body(const std::vector<Cell>& cells, const std::vector<std::uint32_t>& body_of,
                               const std::vector<std::uint32_t>& number, std::uint32_t body_count) {
  Sorted<Corners> sorted{std::vector<Corners>(cells.size()), std::vector<std::size_t>(body_count + 1, 0)};
  for (const Cell& cell : cells) ++sorted.first[body_of[cell.vertices[0]] + 1];
  for (std::uint32_t b = 0; b < body_count; ++b) sorted.first[b + 1] += sorted.first[b];
  std::vector<std::size_t> next(sorted.first.begin(), sorted.first.end() - 1);
  for (const Cell& cell : cells) {
    Corners& own = sorted.cells[next[body_of[cell.vertices[0]]]++];
    for (std::size_t k = 0; k < own.size(); ++k) own[k] = number[cell.vertices[k]];
  }
  return sorted;
}

}  // namespace

BettiNumbers axis_betti_numbers(const MedialComplex& axis, const Context& context) {
  std::vector<Edge> edges;
  std::vector<Face> triangles;
  edges.reserve(axis.edges.size());
  triangles.reserve(axis.triangles.size());
  for (const MedialEdge& edge : axis.edges) edges.push_back(edge.vertices);
  for (const MedialTriangle& triangle : axis.triangles) triangles.push_back(triangle.vertices);
  return homology({axis.vertices.size(), edges, triangles}, context);
}

AxisParts parts_in_bodies(const MedialComplex& axis, const std::vector<Place>& places, std::uint32_t body_count,
                          const Context& context) {
  check_corners(axis.edges, axis.vertices.size());
  check_corners(axis.triangles, axis.vertices.size());
  throw_if_cancelled(context);
  AxisParts parts;
  // Where bodies touch, a vertex may lie on both: the deepest one of those that are joined lies in one for certain.
  std::vector<std::uint32_t> deepest = components(axis);
  const std::vector<std::uint32_t> component = deepest;
  for (std::uint32_t v = 0; v < component.size(); ++v) {
    std::uint32_t& best = deepest[component[v]];
    if (places[v].depth > places[best].depth) best = v;
  }
  parts.body_of.resize(axis.vertices.size());
  std::vector<std::uint32_t> number(axis.vertices.size());
  std::vector<std::uint32_t> count(body_count, 0);
  for (std::uint32_t v = 0; v < component.size(); ++v) {
    parts.body_of[v] = places[deepest[component[v]]].body;
    number[v] = count[parts.body_of[v]]++;
  }
  const auto edges = sorted_by_body<Edge>(axis.edges, parts.body_of, number, body_count);
  const auto triangles = sorted_by_body<Face>(axis.triangles, parts.body_of, number, body_count);
  for (std::uint32_t b = 0; b < body_count; ++b) {
    parts.betti.push_back(count[b] == 0 ? BettiNumbers{0, 0, 0}
                                        : homology({count[b], edges.in(b), triangles.in(b)}, context));
  }
  return parts;
}

}  // namespace blum::verifier
