#include "io/medial_edges.hpp"

#include <algorithm>
#include <numeric>

namespace blum::medial_files {
namespace {

template <class Use>
void for_each_side(const MedialComplex& complex, EdgeSet::Of which, Use use) {
  const auto add = [&](std::uint32_t a, std::uint32_t b) { use(std::min(a, b), std::max(a, b)); };
  if (which == EdgeSet::Of::edges_and_triangles) {
    for (const MedialEdge& edge : complex.edges) add(edge.vertices[0], edge.vertices[1]);
  }
  for (const MedialTriangle& triangle : complex.triangles) {
    for (std::size_t i = 0; i < 3; ++i) add(triangle.vertices[i], triangle.vertices[(i + 1) % 3]);
  }
}

}  // namespace

EdgeSet::EdgeSet(const MedialComplex& complex, Of which, const Context& context)
    : begin_(complex.vertices.size() + 1, 0) {
  for_each_side(complex, which, [&](std::uint32_t a, std::uint32_t /*b*/) { ++begin_[a + std::size_t{1}]; });
  throw_if_cancelled(context);
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  others_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for_each_side(complex, which, [&](std::uint32_t a, std::uint32_t b) { others_[next[a]++] = b; });
  throw_if_cancelled(context);
  sort_and_merge();
}

void EdgeSet::sort_and_merge() {
  std::size_t kept = 0;
  std::size_t from = 0;
  for (std::size_t a = 0; a + 1 < begin_.size(); ++a) {
    const auto first = others_.begin() + static_cast<std::ptrdiff_t>(from);
    const auto last = others_.begin() + static_cast<std::ptrdiff_t>(begin_[a + 1]);
    std::sort(first, last);
    const auto end = std::unique(first, last);
    std::copy(first, end, others_.begin() + static_cast<std::ptrdiff_t>(kept));
    kept += static_cast<std::size_t>(end - first);
    from = begin_[a + 1];
    begin_[a + 1] = kept;
  }
  others_.resize(kept);
}

bool EdgeSet::contains(const std::array<std::uint32_t, 2>& edge) const {
  const auto [low, high] = std::minmax(edge[0], edge[1]);
  return std::binary_search(others_.begin() + static_cast<std::ptrdiff_t>(begin_[low]),
                            others_.begin() + static_cast<std::ptrdiff_t>(begin_[low + std::size_t{1}]), high);
}

std::vector<std::uint32_t> isolated_vertices(const MedialComplex& complex) {
  std::vector<bool> used(complex.vertices.size(), false);
  for (const MedialEdge& edge : complex.edges) {
    for (const std::uint32_t v : edge.vertices) used[v] = true;
  }
  for (const MedialTriangle& triangle : complex.triangles) {
    for (const std::uint32_t v : triangle.vertices) used[v] = true;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) out.push_back(static_cast<std::uint32_t>(v));
  }
  return out;
}

}  // namespace blum::medial_files
