#include "blum/complex/homology.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/union_find.hpp"

namespace blum {
namespace {

using Face = std::array<std::uint32_t, 3>;

/// Triangles with rising corners, each once and in rising order: sorted by their first corner in one pass, then each of
/// these parts, so that a caller who wants to stop need not wait for all.
std::vector<Face> distinct_triangles(const ComplexView& complex, const Context& context) {
  std::vector<std::size_t> first(complex.vertex_count + 1, 0);
  const auto rising = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  for (const Face& face : complex.triangles) ++first[rising(face)[0] + std::size_t{1}];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Face> out(complex.triangles.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const Face& face : complex.triangles) {
    const Face own = rising(face);
    out[next[own[0]]++] = own;
  }
  for (std::size_t v = 0; v < complex.vertex_count; ++v) {
    if (v % 65536 == 0) throw_if_cancelled(context);
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first[v]),
              out.begin() + static_cast<std::ptrdiff_t>(first[v + 1]));
  }
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// What a complex is made of, each cell once.
struct Cells {
  std::vector<Face> triangles;
  Incidence incidence;

  Cells(const ComplexView& complex, const Context& context) {
    if (const std::string problem = problem_of(complex); !problem.empty()) {
      throw InvalidOption("not a complex: " + problem);
    }
    triangles = distinct_triangles(complex, context);
    incidence = Incidence({complex.vertex_count, complex.edges, triangles}, context);
  }
};

/// Rank of the map from edges to vertices: vertices less components.
std::size_t vertex_rank(std::size_t vertex_count, const Incidence& incidence) {
  detail::UnionFind joined(vertex_count);
  std::size_t joins = 0;
  for (const auto& [a, b] : incidence.edges()) joins += joined.join(a, b) ? 1 : 0;
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
  BoundaryMatrix(const Incidence& incidence, const Context& context)
      : context_(context), rows_(incidence.sides()), key_(incidence.edges().size(), none) {}

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
  std::span<const std::array<std::uint32_t, 3>> rows_;                   ///< the edges of each triangle
  std::vector<std::uint32_t> key_;                                       ///< of each edge: its place in paired_
  std::vector<std::uint32_t> paired_;                                    ///< triangles, in order of removal
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> rests_;  ///< by their first edge
};

}  // namespace

BettiNumbers homology(const ComplexView& complex, const Context& context) {
  const Cells cells(complex, context);
  const std::size_t rank_1 = vertex_rank(complex.vertex_count, cells.incidence);
  const std::size_t rank_2 = BoundaryMatrix(cells.incidence, context).rank();
  const auto number = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  return {number(complex.vertex_count - rank_1),
          number(cells.incidence.edges().size()) - number(rank_1) - number(rank_2),
          number(cells.triangles.size() - rank_2)};
}

std::int64_t euler_characteristic(const ComplexView& complex, const Context& context) {
  const Cells cells(complex, context);
  const auto number = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  return number(complex.vertex_count) - number(cells.incidence.edges().size()) + number(cells.triangles.size());
}

}  // namespace blum
