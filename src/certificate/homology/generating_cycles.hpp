// Blum: cycles that generate the homology of a complex, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"

namespace blum::verifier {

/// A graph with cells of dimension 2. Each row of `sides` lists the `per_cell` edges around a cell.
struct CellGraph {
  std::size_t vertex_count = 0;
  std::span<const std::array<std::uint32_t, 2>> edges;
  std::span<const std::uint32_t> sides;
  std::size_t per_cell = 3;
};

/// Edges that close cycles which generate the fundamental group of each component. First, cells with free edges are
/// removed repeatedly. Then a shortest-path tree of the remaining graph is built. An edge closes a cycle unless a cell
/// expresses it by the tree and earlier edges. If everything collapses to a graph or to spheres, the number of these
/// edges is that of the tunnels. In all other cases, the number is a little larger.
class GeneratingCycles {
 public:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// @throws Cancelled. Cost: linear.
  GeneratingCycles(const CellGraph& graph, const Context& context);

  /// Returns the edges that close the cycles, in ascending order.
  [[nodiscard]] const std::vector<std::uint32_t>& closing() const { return closing_; }

  /// Calls use(edge, sign) along the cycle that an edge closes. The sign is 1 if the cycle traverses the edge from its
  /// first vertex to its second, otherwise -1.
  template <class Use>
  void walk(std::uint32_t closing, const Use& use) const {
    auto [a, b] = edges_[closing];
    use(closing, 1);
    const auto up = [&](std::uint32_t& v, int sign) {
      const std::uint32_t e = parent_edge_[v];
      const bool is_first = edges_[e][0] == v;
      use(e, is_first ? sign : -sign);
      v = edges_[e][is_first ? 1 : 0];
    };
    while (a != b) {
      if (depth_[b] >= depth_[a]) {
        up(b, 1);
      } else {
        up(a, -1);
      }
    }
  }

 private:
  void collapse(const CellGraph& graph, const IndexRows& cells_of_edge, const Context& context);
  void grow_trees(const CellGraph& graph, const Context& context);
  void find_closing(const CellGraph& graph, const IndexRows& cells_of_edge, const Context& context);

  std::span<const std::array<std::uint32_t, 2>> edges_;
  std::vector<bool> is_edge_left_, is_cell_left_;
  std::vector<std::uint32_t> parent_edge_;  ///< for each vertex; none at a root
  std::vector<std::uint32_t> depth_;
  std::vector<std::uint32_t> closing_;
};

}  // namespace blum::verifier
