#include <algorithm>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/medial_axis/certificate.hpp"

namespace blum {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

template <std::size_t n>
std::vector<std::array<std::uint32_t, n>> sorted_cells(std::span<const std::array<std::uint32_t, n>> cells,
                                                       std::size_t vertex_count) {
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
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// All edges: those that are named, and those of triangles.
std::vector<Edge> all_edges(std::vector<Edge> edges, const std::vector<Face>& faces) {
  for (const Face& f : faces) {
    edges.push_back({f[0], f[1]});
    edges.push_back({f[0], f[2]});
    edges.push_back({f[1], f[2]});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
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

/// Columns of the boundary matrix of the triangles, edges as rows, reduced from left to right by the lowest entry.
class BoundaryMatrix {
 public:
  BoundaryMatrix(const std::vector<Face>& faces, const std::vector<Edge>& edges) : pivot_(edges.size(), none) {
    columns_.reserve(faces.size());
    const auto row = [&](std::uint32_t a, std::uint32_t b) {
      return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), Edge{a, b}) - edges.begin());
    };
    for (const Face& f : faces) {
      std::vector<std::uint32_t> column{row(f[0], f[1]), row(f[0], f[2]), row(f[1], f[2])};
      std::sort(column.begin(), column.end());
      columns_.push_back(std::move(column));
    }
  }

  std::size_t rank(const Context& context) {
    std::size_t rank = 0;
    std::vector<std::uint32_t> sum;
    for (std::uint32_t c = 0; c < columns_.size(); ++c) {
      if (c % 1024 == 0) throw_if_cancelled(context);
      std::vector<std::uint32_t>& column = columns_[c];
      while (!column.empty() && pivot_[column.back()] != none) {
        const std::vector<std::uint32_t>& other = columns_[pivot_[column.back()]];
        sum.clear();
        std::set_symmetric_difference(column.begin(), column.end(), other.begin(), other.end(),
                                      std::back_inserter(sum));
        column.swap(sum);
      }
      if (column.empty()) continue;
      pivot_[column.back()] = c;
      ++rank;
    }
    return rank;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;
  std::vector<std::vector<std::uint32_t>> columns_;
  std::vector<std::uint32_t> pivot_;  ///< per row, the column whose lowest entry it is
};

/// Removes triangles with an edge that no other triangle has, and that edge, as long as there are any: the ranks of
/// what is left tell those of the whole, one for one.
std::size_t peel(std::vector<Face>& faces, const std::vector<Edge>& edges, const Context& context) {
  const auto row = [&](std::uint32_t a, std::uint32_t b) {
    return static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), Edge{a, b}) - edges.begin());
  };
  std::vector<std::array<std::size_t, 3>> rows;
  rows.reserve(faces.size());
  std::vector<std::uint32_t> count(edges.size(), 0);
  std::vector<std::uint64_t> sum(edges.size(), 0);  // of the triangles at an edge: the last one is the sum
  for (std::uint64_t f = 0; f < faces.size(); ++f) {
    rows.push_back({row(faces[f][0], faces[f][1]), row(faces[f][0], faces[f][2]), row(faces[f][1], faces[f][2])});
    for (const std::size_t e : rows.back()) {
      ++count[e];
      sum[e] += f;
    }
  }
  throw_if_cancelled(context);
  std::vector<std::size_t> free;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (count[e] == 1) free.push_back(e);
  }
  std::vector<bool> is_gone(faces.size(), false);
  std::size_t removed = 0;
  while (!free.empty()) {
    const std::size_t e = free.back();
    free.pop_back();
    if (count[e] != 1) continue;
    const auto f = static_cast<std::size_t>(sum[e]);
    is_gone[f] = true;
    ++removed;
    for (const std::size_t other : rows[f]) {
      --count[other];
      sum[other] -= f;
      if (count[other] == 1) free.push_back(other);
    }
  }
  std::vector<Face> rest;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!is_gone[f]) rest.push_back(faces[f]);
  }
  faces.swap(rest);
  return removed;
}

}  // namespace

BettiNumbers homology(const ComplexView& complex, const Context& context) {
  std::vector<Face> faces = sorted_cells<3>(complex.triangles, complex.vertex_count);
  const std::vector<Edge> edges = all_edges(sorted_cells<2>(complex.edges, complex.vertex_count), faces);
  throw_if_cancelled(context);
  const std::size_t face_count = faces.size();
  const std::size_t rank_1 = vertex_rank(complex.vertex_count, edges);
  std::size_t rank_2 = peel(faces, edges, context);
  rank_2 += BoundaryMatrix(faces, edges).rank(context);
  const auto number = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  return {number(complex.vertex_count - rank_1), number(edges.size()) - number(rank_1) - number(rank_2),
          number(face_count - rank_2)};
}

}  // namespace blum
