#include <array>
#include <span>
#include <vector>

#include "blum/complex/components.hpp"
#include "blum/complex/homology.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

/// Cells in the order of the bodies that they are in, with corners counted within these, and where each body begins.
template <class Corners>
struct Sorted {
  std::vector<Corners> cells;
  std::vector<std::size_t> first;

  [[nodiscard]] std::span<const Corners> in(std::uint32_t body) const {
    return {cells.data() + first[body], first[body + 1] - first[body]};
  }
};

template <class Corners>
Sorted<Corners> sorted_by_body(std::span<const Corners> cells, const std::vector<std::uint32_t>& body_of,
                               const std::vector<std::uint32_t>& number, std::uint32_t body_count) {
  Sorted<Corners> sorted{std::vector<Corners>(cells.size()), std::vector<std::size_t>(body_count + 1, 0)};
  for (const Corners& cell : cells) ++sorted.first[body_of[cell[0]] + 1];
  for (std::uint32_t b = 0; b < body_count; ++b) sorted.first[b + 1] += sorted.first[b];
  std::vector<std::size_t> next(sorted.first.begin(), sorted.first.end() - 1);
  for (const Corners& cell : cells) {
    Corners& own = sorted.cells[next[body_of[cell[0]]]++];
    for (std::size_t k = 0; k < own.size(); ++k) own[k] = number[cell[k]];
  }
  return sorted;
}

}  // namespace

AxisParts parts_in_bodies(const ComplexView& axis, const std::vector<Location>& locations, std::uint32_t body_count,
                          const Context& context) {
  throw_if_cancelled(context);
  AxisParts parts;
  // Where bodies touch, a vertex may lie on both: the deepest one of those that are joined lies in one for certain.
  std::vector<std::uint32_t> deepest = components(axis);
  const std::vector<std::uint32_t> component = deepest;
  for (std::uint32_t v = 0; v < component.size(); ++v) {
    std::uint32_t& best = deepest[component[v]];
    if (locations[v].depth > locations[best].depth) best = v;
  }
  parts.body_of.resize(axis.vertex_count);
  std::vector<std::uint32_t> number(axis.vertex_count);
  std::vector<std::uint32_t> count(body_count, 0);
  for (std::uint32_t v = 0; v < component.size(); ++v) {
    parts.body_of[v] = locations[deepest[component[v]]].body;
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
