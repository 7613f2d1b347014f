#include "blum/complex/incidence.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

namespace blum {
namespace {

constexpr std::size_t steps_between_looks = 65536;

/// For each of `count` cells the indices of the things that name it, rising.
template <std::size_t n>
IndexRows rows_of(std::span<const std::array<std::uint32_t, n>> things, std::size_t count) {
  std::vector<std::size_t> first(count + 1, 0);
  for (const auto& thing : things) {
    for (const std::uint32_t cell : thing) ++first[cell + std::size_t{1}];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> items(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < things.size(); ++i) {
    for (const std::uint32_t cell : things[i]) items[next[cell]++] = static_cast<std::uint32_t>(i);
  }
  return {std::move(first), std::move(items)};
}

/// Calls use(a, b, number) for the listed edges and then the sides of triangles, numbered through; a < b.
template <class Use>
void for_each_pair(const ComplexView& complex, const Use& use) {
  std::uint32_t number = 0;
  const auto add = [&](std::uint32_t a, std::uint32_t b) { use(std::min(a, b), std::max(a, b), number++); };
  for (const auto& [a, b] : complex.edges) add(a, b);
  for (const auto& [a, b, c] : complex.triangles) {
    add(a, b);
    add(b, c);
    add(c, a);
  }
}

}  // namespace

Incidence::Incidence(const ComplexView& complex, const Context& context) {
  if (const std::string problem = problem_of(complex); !problem.empty()) {
    throw InvalidOption("not a complex: " + problem);
  }
  if (complex.edges.size() + 3 * complex.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidOption("a complex with 2^32 or more edges and sides of triangles is too large");
  }
  throw_if_cancelled(context);
  find_edges(complex, context);
  edges_of_vertex_ = rows_of<2>(edges_, complex.vertex_count);
  triangles_of_vertex_ = rows_of<3>(complex.triangles, complex.vertex_count);
}

/// Sorts the pairs by their smaller vertex in one pass, and then those of each vertex.
void Incidence::find_edges(const ComplexView& complex, const Context& context) {
  std::vector<std::size_t> first(complex.vertex_count + 1, 0);
  for_each_pair(complex, [&](std::uint32_t a, std::uint32_t /*b*/, std::uint32_t) { ++first[a + std::size_t{1}]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  // The larger vertex in the upper half, so that pairs sort by it and then by number.
  std::vector<std::uint64_t> pairs(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for_each_pair(complex, [&](std::uint32_t a, std::uint32_t b, std::uint32_t number) {
    pairs[next[a]++] = std::uint64_t{b} << 32U | number;
  });
  throw_if_cancelled(context);
  const auto listed = static_cast<std::uint32_t>(complex.edges.size());
  edge_of_listed_.resize(listed);
  sides_.resize(complex.triangles.size());
  std::vector<std::size_t> first_triangle;
  std::vector<std::uint32_t> triangles;
  triangles.reserve(3 * sides_.size());
  for (std::uint32_t a = 0; a < complex.vertex_count; ++a) {
    if (a % steps_between_looks == 0) throw_if_cancelled(context);
    const auto begin = pairs.begin() + static_cast<std::ptrdiff_t>(first[a]);
    const auto end = pairs.begin() + static_cast<std::ptrdiff_t>(first[a + std::size_t{1}]);
    std::sort(begin, end);
    for (auto pair = begin; pair != end; ++pair) {
      const auto b = static_cast<std::uint32_t>(*pair >> 32U);
      if (pair == begin || edges_.back()[1] != b) {
        edges_.push_back({a, b});
        first_triangle.push_back(triangles.size());
      }
      const auto edge = static_cast<std::uint32_t>(edges_.size() - 1);
      const auto number = static_cast<std::uint32_t>(*pair);
      if (number < listed) {
        edge_of_listed_[number] = edge;
      } else {
        const std::uint32_t side = number - listed;
        sides_[side / 3][side % 3] = edge;
        triangles.push_back(side / 3);
      }
    }
  }
  first_triangle.push_back(triangles.size());
  triangles_of_edge_ = {std::move(first_triangle), std::move(triangles)};
}

std::optional<std::uint32_t> Incidence::find_edge(std::uint32_t a, std::uint32_t b) const {
  const std::array<std::uint32_t, 2> wanted{std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), wanted);
  if (at == edges_.end() || *at != wanted) return std::nullopt;
  return static_cast<std::uint32_t>(at - edges_.begin());
}

}  // namespace blum
