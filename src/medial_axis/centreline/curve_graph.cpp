#include "medial_axis/centreline/curve_graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "blum/core/union_find.hpp"

namespace blum::centrelines {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

struct Edge {
  double length;
  std::uint32_t a;
  std::uint32_t b;  ///< larger than a
};

/// An edge at one of its two voxels: the edge and its other voxel.
struct Link {
  std::uint32_t to;
  std::uint32_t edge;
};

std::vector<std::uint32_t> listed(const VoxelSet& voxels) {
  std::vector<std::uint32_t> out;
  const auto& size = voxels.size();
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const auto row = voxels.row(j, k);
      const auto first = static_cast<std::size_t>((k * size[1] + j) * size[0]);
      for (std::size_t w = 0; w < row.size(); ++w) {
        for (std::uint64_t rest = row[w]; rest != 0; rest &= rest - 1) {
          out.push_back(static_cast<std::uint32_t>(first + 64 * w + static_cast<std::size_t>(std::countr_zero(rest))));
        }
      }
    }
  }
  return out;
}

/// Returns an edge for each pair of neighbouring voxels, the shortest edges first. Voxels are given by their indices in
/// `list`.
std::vector<Edge> edges_between(const VoxelSet& voxels, const std::vector<std::uint32_t>& list, const Vec3d& spacing,
                                const Context& context) {
  std::vector<Edge> edges;
  const auto& size = voxels.size();
  for (std::size_t v = 0; v < list.size(); ++v) {
    if (v % 65536 == 0) throw_if_cancelled(context);
    const auto at = voxels.place(list[v]);
    for (std::int64_t n = 14; n < 27; ++n) {  // the 13 neighbours with larger linear indices
      const std::int64_t x = n % 3 - 1;
      const std::int64_t y = n / 3 % 3 - 1;
      const std::int64_t z = n / 9 - 1;
      if (!voxels.contains(at[0] + x, at[1] + y, at[2] + z)) continue;
      const auto other = static_cast<std::uint32_t>(list[v] + (z * size[1] + y) * size[0] + x);
      const auto found = std::lower_bound(list.begin() + static_cast<std::ptrdiff_t>(v), list.end(), other);
      const Vec3d step{static_cast<double>(x) * spacing.x, static_cast<double>(y) * spacing.y,
                       static_cast<double>(z) * spacing.z};
      edges.push_back({length(step), static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(found - list.begin())});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return std::tie(a.length, a.a, a.b) < std::tie(b.length, b.a, b.b); });
  return edges;
}

/// Selects the edges that the graph keeps: those of the spanning forest, and one for each tunnel.
class Tunnels {
 public:
  Tunnels(std::size_t voxels, const std::vector<Edge>& edges, const Context& context)
      : edges_(edges), links_(voxels), is_kept_(edges.size(), true) {
    detail::UnionFind joined(voxels);
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      if (e % 65536 == 0) throw_if_cancelled(context);
      if (!joined.join(edges[e].a, edges[e].b)) close(e);
      links_[edges[e].a].push_back({edges[e].b, e});
      links_[edges[e].b].push_back({edges[e].a, e});
    }
  }

  [[nodiscard]] const std::vector<bool>& kept() const { return is_kept_; }

 private:
  /// Adds the triangles whose longest edge is `edge`. The longest edge of such a triangle closes a loop of shorter
  /// edges.
  void close(std::uint32_t edge) {
    const Edge& e = edges_[edge];
    for (const Link& one : links_[e.a]) {
      for (const Link& two : links_[e.b]) {
        if (one.to == two.to) add({edge, std::max(one.edge, two.edge), std::min(one.edge, two.edge)});
      }
    }
  }

  /// Adds the border of a triangle: its edges, descending. Borders that begin with the same edge are added to it modulo
  /// 2. If edges are left, the first of them need not be kept.
  void add(std::vector<std::uint32_t> border) {
    while (!border.empty()) {
      const auto [at, is_new] = closing_.try_emplace(border.front());
      if (is_new) {
        is_kept_[border.front()] = false;
        at->second = std::move(border);
        return;
      }
      std::vector<std::uint32_t> sum;
      std::set_symmetric_difference(border.begin(), border.end(), at->second.begin(), at->second.end(),
                                    std::back_inserter(sum), std::greater<>());
      border = std::move(sum);
    }
  }

  const std::vector<Edge>& edges_;
  std::vector<std::vector<Link>> links_;
  std::vector<bool> is_kept_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> closing_;  ///< reduced borders by their first edge
};

/// Joins edges to chains. Chains end at voxels that do not have exactly two edges.
class Tracer {
 public:
  Tracer(const std::vector<std::uint32_t>& list, const std::vector<Edge>& edges, const std::vector<bool>& is_kept)
      : list_(list), links_(list.size()), node_of_(list.size(), none), is_done_(edges.size(), false) {
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      if (!is_kept[e]) continue;
      links_[edges[e].a].push_back({edges[e].b, e});
      links_[edges[e].b].push_back({edges[e].a, e});
    }
  }

  CurveGraph trace() {
    for (std::uint32_t v = 0; v < list_.size(); ++v) {
      if (links_[v].size() == 2) continue;
      node_of_[v] = static_cast<std::uint32_t>(graph_.nodes.size());
      graph_.nodes.push_back({list_[v], {}, true});
    }
    for (std::uint32_t v = 0; v < list_.size(); ++v) {
      if (node_of_[v] != none) walk_all(v);
    }
    for (std::uint32_t v = 0; v < list_.size(); ++v) {
      if (node_of_[v] == none) walk_all(v);  // closed curves: one chain each
    }
    return std::move(graph_);
  }

 private:
  void walk_all(std::uint32_t start) {
    for (const Link& link : links_[start]) {
      if (!is_done_[link.edge]) walk(start, link);
    }
  }

  void walk(std::uint32_t start, Link link) {
    Chain chain;
    chain.voxels.push_back(list_[start]);
    for (;;) {
      is_done_[link.edge] = true;
      chain.voxels.push_back(list_[link.to]);
      if (node_of_[link.to] != none || link.to == start) break;
      const std::vector<Link>& onward = links_[link.to];
      link = is_done_[onward[0].edge] ? onward[1] : onward[0];
    }
    const auto index = static_cast<std::uint32_t>(graph_.chains.size());
    if (node_of_[start] != none) {
      chain.nodes = {static_cast<std::int32_t>(node_of_[start]), static_cast<std::int32_t>(node_of_[link.to])};
      graph_.nodes[node_of_[start]].chains.push_back(index);
      graph_.nodes[node_of_[link.to]].chains.push_back(index);
    }
    graph_.chains.push_back(std::move(chain));
  }

  const std::vector<std::uint32_t>& list_;
  std::vector<std::vector<Link>> links_;
  std::vector<std::uint32_t> node_of_;
  std::vector<bool> is_done_;
  CurveGraph graph_;
};

}  // namespace

CurveGraph curve_graph(const VoxelSet& voxels, const Vec3d& spacing, const Context& context) {
  const std::vector<std::uint32_t> list = listed(voxels);
  const std::vector<Edge> edges = edges_between(voxels, list, spacing, context);
  const Tunnels tunnels(list.size(), edges, context);
  return Tracer(list, edges, tunnels.kept()).trace();
}

BettiNumbers betti_numbers(const CurveGraph& graph) {
  detail::UnionFind joined(graph.nodes.size());
  BettiNumbers betti{0, 0, 0};
  for (const ChainNode& node : graph.nodes) betti[0] += node.is_there ? 1 : 0;
  for (const Chain& chain : graph.chains) {
    if (!chain.is_there) continue;
    if (chain.nodes[0] == no_node) {
      ++betti[0];
      ++betti[1];
    } else if (joined.join(static_cast<std::uint32_t>(chain.nodes[0]), static_cast<std::uint32_t>(chain.nodes[1]))) {
      --betti[0];
    } else {
      ++betti[1];
    }
  }
  return betti;
}

}  // namespace blum::centrelines
