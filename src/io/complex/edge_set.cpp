#include "io/complex/edge_set.hpp"

#include <algorithm>
#include <numeric>

namespace blum::complex_files {
namespace {

template <class Use>
void for_each_side(const ComplexView& complex, EdgeSet::Of which, Use use) {
  const auto add = [&](std::uint32_t a, std::uint32_t b) { use(std::min(a, b), std::max(a, b)); };
  if (which == EdgeSet::Of::edges_and_triangles) {
    for (const auto& edge : complex.edges) add(edge[0], edge[1]);
  }
  for (const auto& triangle : complex.triangles) {
    for (std::size_t i = 0; i < 3; ++i) add(triangle[i], triangle[(i + 1) % 3]);
  }
}

}  // namespace

EdgeSet::EdgeSet(const ComplexView& complex, Of which, const Context& context) : begin_(complex.vertex_count + 1, 0) {
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

std::vector<std::uint32_t> isolated_vertices(const ComplexView& complex) {
  std::vector<bool> used(complex.vertex_count, false);
  for (const auto& edge : complex.edges) {
    for (const std::uint32_t v : edge) used[v] = true;
  }
  for (const auto& triangle : complex.triangles) {
    for (const std::uint32_t v : triangle) used[v] = true;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) out.push_back(static_cast<std::uint32_t>(v));
  }
  return out;
}

}  // namespace blum::complex_files
