#include <algorithm>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/medial_axis/certificate.hpp"

namespace blum {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

/// Sorts cells whose corners rise, and drops copies: by their first corner in one pass, then each of these parts, so
/// that a caller who wants to stop need not wait for all.
template <class Cell>
std::vector<Cell> sorted(const std::vector<Cell>& cells, std::size_t vertex_count, const Context& context) {
  std::vector<std::size_t> begin(vertex_count + 1, 0);
  for (const Cell& cell : cells) ++begin[cell[0] + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) begin[v + 1] += begin[v];
  throw_if_cancelled(context);
  std::vector<Cell> out(cells.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const Cell& cell : cells) out[next[cell[0]]++] = cell;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    if (v % 65536 == 0) throw_if_cancelled(context);
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              out.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]));
  }
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

template <std::size_t n>
std::vector<std::array<std::uint32_t, n>> sorted_cells(std::span<const std::array<std::uint32_t, n>> cells,
                                                       std::size_t vertex_count, const Context& context) {
  std::vector<std::array<std::uint32_t, n>> out(cells.begin(), cells.end());
  for (auto& cell : out) {
    std::sort(cell.begin(), cell.end());
    if (cell.back() >= vertex_count) {
      throw InvalidOption("a complex names vertex " + std::to_string(cell.back()) + " of " +
                          std::to_string(vertex_count));
    }
    if (std::adjacent_find(cell.begin(), cell.end()) != cell.end()) {
      throw InvalidOption("an edge or triangle of a complex names vertex " + std::to_string(cell[0]) + " twice");
    }
  }
  return sorted(out, vertex_count, context);
}

/// All edges: those that are named, and those of triangles.
std::vector<Edge> all_edges(std::vector<Edge> edges, const std::vector<Face>& faces, std::size_t vertex_count,
                            const Context& context) {
  for (const Face& f : faces) {
    edges.push_back({f[0], f[1]});
    edges.push_back({f[0], f[2]});
    edges.push_back({f[1], f[2]});
  }
  return sorted(edges, vertex_count, context);
}

/// Rank of the map from edges to vertices: vertices less components.
std::size_t vertex_rank(std::size_t vertex_count, const std::vector<Edge>& edges) {
  std::vector<std::uint32_t> parent(vertex_count);
  for (std::uint32_t v = 0; v < vertex_count; ++v) parent[v] = v;
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::size_t joins = 0;
  for (const Edge& e : edges) {
    const std::uint32_t a = root(e[0]);
    const std::uint32_t b = root(e[1]);
    if (a == b) continue;
    parent[std::max(a, b)] = std::min(a, b);
    ++joins;
  }
  return joins;
}

/// The boundary matrix of the triangles, edges as rows, and its rank.
///
/// A triangle with an edge that no other triangle has is paired with that edge and removed, over and over. Where none
/// has one (the surface is closed) a triangle is set aside, and it goes on. Each paired edge is no edge of triangles
/// removed later: paired columns are independent, and only those set aside need elimination, edges that were paired
/// first coming first.
class BoundaryMatrix {
 public:
  BoundaryMatrix(const std::vector<Face>& faces, const std::vector<Edge>& edges, const Context& context)
      : context_(context), key_(edges.size(), none) {
    const auto row = [&](std::uint32_t a, std::uint32_t b) {
      return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), Edge{a, b}) - edges.begin());
    };
    rows_.reserve(faces.size());
    for (const Face& f : faces) {
      if (rows_.size() % 65536 == 0) throw_if_cancelled(context);
      rows_.push_back({row(f[0], f[1]), row(f[0], f[2]), row(f[1], f[2])});
    }
  }

  std::size_t rank() {
    const std::vector<std::uint32_t> set_aside = pair_up();
    for (const std::uint32_t face : set_aside) add_rest(rest_of(face));
    return paired_.size() + rests_.size();
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// Fills paired_ and key_; returns the triangles set aside.
  std::vector<std::uint32_t> pair_up() {
    std::vector<std::uint32_t> count(key_.size(), 0);
    std::vector<std::uint64_t> sum(key_.size(), 0);  // of the triangles at an edge: the last one is the sum
    for (std::uint32_t f = 0; f < rows_.size(); ++f) {
      for (const std::uint32_t e : rows_[f]) {
        ++count[e];
        sum[e] += f;
      }
    }
    std::vector<std::uint32_t> free;
    for (std::uint32_t e = 0; e < count.size(); ++e) {
      if (count[e] == 1) free.push_back(e);
    }
    std::vector<bool> is_gone(rows_.size(), false);
    const auto remove = [&](std::uint32_t f) {
      is_gone[f] = true;
      for (const std::uint32_t e : rows_[f]) {
        --count[e];
        sum[e] -= f;
        if (count[e] == 1) free.push_back(e);
      }
    };
    std::vector<std::uint32_t> set_aside;
    for (std::uint32_t f = 0; f < rows_.size(); ++f) {
      throw_now_and_then();
      while (!free.empty()) {
        const std::uint32_t e = free.back();
        free.pop_back();
        if (count[e] != 1) continue;
        const auto face = static_cast<std::uint32_t>(sum[e]);
        key_[e] = static_cast<std::uint32_t>(paired_.size());
        paired_.push_back(face);
        remove(face);
        throw_now_and_then();
      }
      if (is_gone[f]) continue;
      set_aside.push_back(f);
      remove(f);
    }
    return set_aside;
  }

  /// The column of a triangle that was set aside, freed of all paired edges: the edges that remain, rising.
  std::vector<std::uint32_t> rest_of(std::uint32_t face) {
    using Entry = std::pair<std::uint32_t, std::uint32_t>;  // when the edge was paired, and the edge
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> column;
    const auto add = [&](std::uint32_t f) {
      for (const std::uint32_t e : rows_[f]) column.emplace(key_[e], e);
    };
    add(face);
    std::vector<std::uint32_t> rest;
    while (!column.empty()) {
      throw_now_and_then();
      const auto [key, edge] = column.top();
      column.pop();
      if (!column.empty() && column.top().second == edge) {
        column.pop();  // twice is not at all
      } else if (key == none) {
        rest.push_back(edge);
      } else {
        column.emplace(key, edge);
        add(paired_[key]);
      }
    }
    return rest;
  }

  /// Reduces a column by those before it, and keeps it if anything is left.
  void add_rest(std::vector<std::uint32_t> column) {
    std::vector<std::uint32_t> sum;
    while (!column.empty()) {
      throw_now_and_then();
      const auto [other, is_new] = rests_.try_emplace(column.front());
      if (is_new) {
        other->second.swap(column);
        return;
      }
      sum.clear();
      std::set_symmetric_difference(column.begin(), column.end(), other->second.begin(), other->second.end(),
                                    std::back_inserter(sum));
      column.swap(sum);
    }
  }

  void throw_now_and_then() {
    if (++steps_ % 16384 == 0) throw_if_cancelled(context_);
  }

  const Context& context_;
  std::size_t steps_ = 0;
  std::vector<std::array<std::uint32_t, 3>> rows_;                       ///< the edges of each triangle
  std::vector<std::uint32_t> key_;                                       ///< of each edge: its place in paired_
  std::vector<std::uint32_t> paired_;                                    ///< triangles, in order of removal
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> rests_;  ///< by their first edge
};

}  // namespace

BettiNumbers homology(const ComplexView& complex, const Context& context) {
  const std::vector<Face> faces = sorted_cells<3>(complex.triangles, complex.vertex_count, context);
  const std::vector<Edge> edges =
      all_edges(sorted_cells<2>(complex.edges, complex.vertex_count, context), faces, complex.vertex_count, context);
  const std::size_t rank_1 = vertex_rank(complex.vertex_count, edges);
  const std::size_t rank_2 = BoundaryMatrix(faces, edges, context).rank();
  const auto number = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  return {number(complex.vertex_count - rank_1), number(edges.size()) - number(rank_1) - number(rank_2),
          number(faces.size() - rank_2)};
}

}  // namespace blum
