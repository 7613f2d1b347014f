#include "blum/complex/incidence.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

constexpr std::size_t vertices_per_range = 4096;

/// Calls use(a, b, number) with the ends a < b of each listed edge, and then of each side of a triangle. The calls are
/// numbered consecutively.
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

/// Loops of two to eight ranges read all cells. From some 10,000 cells, such a loop takes long.
Start start_for(const ComplexView& complex) {
  return complex.edges.size() + complex.triangles.size() > 10000 ? Start::at_once : Start::measured;
}

/// Pairs of vertices, grouped by the smaller vertex. Each is a listed edge or a side of a triangle.
struct VertexPairs {
  std::vector<std::size_t> first;    ///< for each vertex: index of its first pair; then the number of pairs
  std::vector<std::uint64_t> pairs;  ///< sort keys: the larger vertex in the upper 32 bits, the number in the lower
  std::uint32_t listed = 0;          ///< numbers below this belong to listed edges, all other numbers to sides

  VertexPairs(const ComplexView& complex, const Context& context)
      : first(complex.vertex_count + 1, 0), listed(static_cast<std::uint32_t>(complex.edges.size())) {
    for_each_of_own(complex, context, [&](std::uint32_t a, std::uint32_t /*b*/, std::uint32_t) { ++first[a]; });
    std::exclusive_scan(first.begin(), first.end(), first.begin(), std::size_t{0});
    pairs.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for_each_of_own(complex, context, [&](std::uint32_t a, std::uint32_t b, std::uint32_t number) {
      pairs[next[a]++] = std::uint64_t{b} << 32U | number;
    });
  }

  /// Does the same as for_each_pair(), on several threads. Each thread reads all pairs, and uses those whose smaller
  /// vertex is in its range. Reading all pairs in order costs less than writing at random positions of the lists.
  template <class Use>
  static void for_each_of_own(const ComplexView& complex, const Context& context, const Use& use) {
    constexpr std::size_t most_ranges = 8;
    const std::size_t count = complex.vertex_count;
    const std::size_t ranges = std::min(static_cast<std::size_t>(thread_count(context)), most_ranges);
    parallel_for(
        context, count, (count + ranges - 1) / ranges, {},
        [&](const WorkRange& range) {
          for_each_pair(complex, [&](std::uint32_t a, std::uint32_t b, std::uint32_t number) {
            if (a >= range.begin && a < range.end) use(a, b, number);
          });
        },
        start_for(complex));
  }

  void sort(std::size_t a) {
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first[a]),
              pairs.begin() + static_cast<std::ptrdiff_t>(first[a + 1]));
  }
  [[nodiscard]] std::uint32_t larger(std::size_t k) const { return static_cast<std::uint32_t>(pairs[k] >> 32U); }
  [[nodiscard]] std::uint32_t number(std::size_t k) const { return static_cast<std::uint32_t>(pairs[k]); }
  /// Returns true if pair k is the first of several equal pairs. Pairs must be sorted.
  /// @param a  the smaller vertex of the pair.
  [[nodiscard]] bool is_new_edge(std::size_t k, std::size_t a) const {
    return k == first[a] || larger(k) != larger(k - 1);
  }
};

/// Returns true if all vertex indices of the cells exist, and no cell has the same vertex twice.
template <std::size_t n>
bool are_good(std::span<const std::array<std::uint32_t, n>> cells, std::size_t vertex_count, const Context& context) {
  constexpr std::size_t cells_per_range = 65536;
  std::atomic<bool> is_any_bad{false};
  parallel_for(context, cells.size(), cells_per_range, {}, [&](const WorkRange& range) {
    bool is_bad = false;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (std::size_t k = 0; k < n; ++k) is_bad |= cells[i][k] >= vertex_count || cells[i][k] == cells[i][(k + 1) % n];
    }
    if (is_bad) is_any_bad = true;
  });
  return !is_any_bad;
}

}  // namespace

Incidence::Incidence(const ComplexView& complex, const Context& context) {
  if (!are_good(complex.edges, complex.vertex_count, context) ||
      !are_good(complex.triangles, complex.vertex_count, context)) {
    throw InvalidOption("not a complex: " + problem_of(complex));
  }
  if (complex.edges.size() + 3 * complex.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidOption("a complex with 2^32 or more edges and sides of triangles is too large");
  }
  throw_if_cancelled(context);
  find_edges(complex, context);
  const auto find_rows = [&](const WorkRange& range) {
    const auto rows_of = [&](const auto& cells) {
      return detail::rows_of(cells.size(), complex.vertex_count,
                             [&](std::size_t k) -> const auto& { return cells[k]; });
    };
    if (range.begin == 0) edges_of_vertex_ = rows_of(edges_);
    if (range.end == 2) triangles_of_vertex_ = rows_of(complex.triangles);
  };
  parallel_for(context, 2, 1, {}, find_rows, start_for(complex));
}

/// Each range of vertices sorts and counts its pairs. Then each range writes its edges after the edges of all earlier
/// ranges.
void Incidence::find_edges(const ComplexView& complex, const Context& context) {
  VertexPairs pairs(complex, context);
  const std::size_t ranges = (complex.vertex_count + vertices_per_range - 1) / vertices_per_range;
  std::vector<std::size_t> first_edge(ranges + 1, 0);
  std::vector<std::size_t> first_side(ranges + 1, 0);
  parallel_for(context, complex.vertex_count, vertices_per_range, {}, [&](const WorkRange& range) {
    std::size_t edges = 0;
    std::size_t sides = 0;
    for (std::size_t a = range.begin; a < range.end; ++a) {
      pairs.sort(a);
      for (std::size_t k = pairs.first[a]; k < pairs.first[a + 1]; ++k) {
        edges += pairs.is_new_edge(k, a) ? 1 : 0;
        sides += pairs.number(k) >= pairs.listed ? 1 : 0;
      }
    }
    first_edge[range.begin / vertices_per_range + 1] = edges;
    first_side[range.begin / vertices_per_range + 1] = sides;
  });
  std::partial_sum(first_edge.begin(), first_edge.end(), first_edge.begin());
  std::partial_sum(first_side.begin(), first_side.end(), first_side.begin());

  edges_.resize(first_edge.back());
  edge_of_listed_.resize(pairs.listed);
  sides_.resize(complex.triangles.size());
  std::vector<std::size_t> first_triangle(edges_.size() + 1, first_side.back());
  std::vector<std::uint32_t> triangles(first_side.back());
  parallel_for(context, complex.vertex_count, vertices_per_range, {}, [&](const WorkRange& range) {
    std::size_t next_edge = first_edge[range.begin / vertices_per_range];
    std::size_t next_side = first_side[range.begin / vertices_per_range];
    for (std::size_t a = range.begin; a < range.end; ++a) {
      for (std::size_t k = pairs.first[a]; k < pairs.first[a + 1]; ++k) {
        if (pairs.is_new_edge(k, a)) {
          edges_[next_edge] = {static_cast<std::uint32_t>(a), pairs.larger(k)};
          first_triangle[next_edge++] = next_side;
        }
        const auto edge = static_cast<std::uint32_t>(next_edge - 1);
        const std::uint32_t number = pairs.number(k);
        if (number < pairs.listed) {
          edge_of_listed_[number] = edge;
        } else {
          const std::uint32_t side = number - pairs.listed;
          sides_[side / 3][side % 3] = edge;
          triangles[next_side++] = side / 3;
        }
      }
    }
  });
  triangles_of_edge_ = {std::move(first_triangle), std::move(triangles)};
}

std::optional<std::uint32_t> Incidence::find_edge(std::uint32_t a, std::uint32_t b) const {
  const std::array<std::uint32_t, 2> wanted{std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), wanted);
  if (at == edges_.end() || *at != wanted) return std::nullopt;
  return static_cast<std::uint32_t>(at - edges_.begin());
}

}  // namespace blum
