#include "medial_axis/centreline/prune_spurs.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace blum::centrelines {
namespace {

// Voxels by which a spur may extend beyond the ball at its root. A single extra voxel on the surface makes a spur of
// this length.
constexpr double noise = 1.5;
// Radii of the ball at the root. The corner of a square strut's end is 0.73 radii beyond the ball.
constexpr double fork_reach = 0.75;

class Pruner {
 public:
  Pruner(CurveGraph& graph, const ChainMeasure& measure, double spur, const Context& context)
      : graph_(graph), measure_(measure), spur_(spur), context_(context) {
    for (const Chain& chain : graph.chains) length_.push_back(measure.length(chain.voxels));
  }

  void prune() {
    std::vector<std::uint32_t> order(graph_.nodes.size());
    std::iota(order.begin(), order.end(), 0U);
    // Nodes with small balls come first. So spurs inside a large ball are removed before the ball's own branches are
    // examined.
    std::sort(order.begin(), order.end(),
              [this](std::uint32_t a, std::uint32_t b) { return std::pair(radius(a), a) < std::pair(radius(b), b); });
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      throw_if_cancelled(context_);
      for (const std::uint32_t node : order) {
        if (graph_.nodes[node].is_there) has_changed |= drop_spurs(node);
      }
      for (const std::uint32_t node : order) {
        if (graph_.nodes[node].is_there) has_changed |= drop_fork(node);
      }
      for (std::uint32_t c = 0; c < graph_.chains.size(); ++c) {
        if (graph_.chains[c].is_there) has_changed |= contract(c);
      }
    }
  }

 private:
  [[nodiscard]] double radius(std::uint32_t node) const { return measure_.depth[graph_.nodes[node].voxel]; }
  [[nodiscard]] std::uint32_t other_end(std::uint32_t chain, std::uint32_t node) const {
    const auto& nodes = graph_.chains[chain].nodes;
    return static_cast<std::uint32_t>(nodes[0] == static_cast<std::int32_t>(node) ? nodes[1] : nodes[0]);
  }
  [[nodiscard]] bool has_free_end(std::uint32_t chain, std::uint32_t node) const {
    const std::uint32_t end = other_end(chain, node);
    return end != node && graph_.nodes[end].chains.size() == 1;
  }

  /// Returns those branches of a node that have a free end and that `is_short` accepts, the shortest first.
  template <class Limit>
  std::vector<std::uint32_t> free_branches(std::uint32_t node, const Limit& is_short) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t c : graph_.nodes[node].chains) {
      if (has_free_end(c, node) && is_short(c)) found.push_back(c);
    }
    std::sort(found.begin(), found.end(),
              [this](std::uint32_t a, std::uint32_t b) { return std::pair(length_[a], a) < std::pair(length_[b], b); });
    return found;
  }

  bool drop_spurs(std::uint32_t node) {
    const std::size_t degree = graph_.nodes[node].chains.size();
    if (degree < 2) return drop_blob(node);
    if (degree < 3) return false;
    const double limit = spur_ * radius(node) + noise * measure_.voxel();
    std::vector<std::uint32_t> spurs =
        free_branches(node, [&](std::uint32_t c) { return lies_within(c, node, limit); });
    if (spurs.size() == degree) spurs.resize(degree - 2);
    for (const std::uint32_t c : spurs) remove_spur(c, node);
    if (!spurs.empty()) join_two(node);
    return !spurs.empty();
  }

  /// Returns true if the distance of each voxel of a branch from a node is at most `distance`.
  [[nodiscard]] bool lies_within(std::uint32_t c, std::uint32_t node, double distance) const {
    const Vec3d centre = measure_.position(graph_.nodes[node].voxel);
    const auto is_near = [&](std::uint32_t voxel) { return length(measure_.position(voxel) - centre) <= distance; };
    if (!is_near(graph_.nodes[other_end(c, node)].voxel)) return false;
    return std::all_of(graph_.chains[c].voxels.begin(), graph_.chains[c].voxels.end(), is_near);
  }

  bool drop_fork(std::uint32_t node) {
    const std::size_t degree = graph_.nodes[node].chains.size();
    if (degree < 3) return false;
    const double limit = fork_reach * radius(node) + measure_.voxel();
    const std::vector<std::uint32_t> tips = free_branches(
        node, [&](std::uint32_t c) { return length_[c] + radius(other_end(c, node)) - radius(node) <= limit; });
    if (spur_ == 0 || tips.size() + 1 < degree) return false;
    for (const std::uint32_t c : tips) remove_spur(c, node);
    return true;
  }

  /// Contracts a branch with two free ends to a point if neither end is far beyond the largest ball on the branch.
  bool drop_blob(std::uint32_t node) {
    if (spur_ == 0 || graph_.nodes[node].chains.empty()) return false;
    const std::uint32_t c = graph_.nodes[node].chains.front();
    if (!has_free_end(c, node)) return false;
    const std::vector<std::uint32_t>& voxels = graph_.chains[c].voxels;
    const auto deepest = std::max_element(voxels.begin(), voxels.end(),
                                          [this](auto a, auto b) { return measure_.depth[a] < measure_.depth[b]; });
    const double radius = measure_.depth[*deepest];
    const double limit = (1 + fork_reach) * radius + measure_.voxel();
    const double first = measure_.length({voxels.begin(), deepest + 1});
    if (first + measure_.depth[voxels.front()] > limit) return false;
    if (length_[c] - first + measure_.depth[voxels.back()] > limit) return false;
    const std::uint32_t centre = *deepest;
    remove_spur(c, node);
    graph_.nodes[node].voxel = centre;
    return true;
  }

  void remove_spur(std::uint32_t chain, std::uint32_t root) {
    const std::uint32_t end = other_end(chain, root);
    detach(chain, root);
    graph_.nodes[end] = {graph_.nodes[end].voxel, {}, false};
    drop(chain);
  }

  void detach(std::uint32_t chain, std::uint32_t node) {
    auto& chains = graph_.nodes[node].chains;
    chains.erase(std::find(chains.begin(), chains.end(), chain));
  }
  void drop(std::uint32_t chain) { graph_.chains[chain] = {{no_node, no_node}, {}, false}; }

  /// Returns the voxels of a chain in the order that starts at the given node.
  [[nodiscard]] std::vector<std::uint32_t> from(std::uint32_t chain, std::uint32_t node) const {
    std::vector<std::uint32_t> voxels = graph_.chains[chain].voxels;
    if (graph_.chains[chain].nodes[0] != static_cast<std::int32_t>(node)) std::reverse(voxels.begin(), voxels.end());
    return voxels;
  }

  /// Joins the two branches of a node to one, if it has exactly two.
  void join_two(std::uint32_t node) {
    if (graph_.nodes[node].chains.size() != 2) return;
    const std::uint32_t a = graph_.nodes[node].chains[0];
    const std::uint32_t b = graph_.nodes[node].chains[1];
    if (a == b) {  // a closed curve
      graph_.chains[a].nodes = {no_node, no_node};
      graph_.nodes[node] = {graph_.nodes[node].voxel, {}, false};
      return;
    }
    const std::uint32_t first = other_end(a, node);
    const std::uint32_t last = other_end(b, node);
    std::vector<std::uint32_t> voxels = from(a, first);
    const std::vector<std::uint32_t> rest = from(b, node);
    voxels.insert(voxels.end(), rest.begin() + 1, rest.end());
    graph_.chains[a] = {{static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)}, std::move(voxels), true};
    length_[a] += length_[b];
    auto& of_last = graph_.nodes[last].chains;
    *std::find(of_last.begin(), of_last.end(), b) = a;
    graph_.nodes[node] = {graph_.nodes[node].voxel, {}, false};
    drop(b);
  }

  /// Merges two junctions if the branch between them is not longer than the radius of the smaller of their balls plus
  /// one voxel.
  bool contract(std::uint32_t chain) {
    const auto [first, last] = graph_.chains[chain].nodes;
    if (first == no_node || first == last) return false;
    auto keep = static_cast<std::uint32_t>(first);
    auto gone = static_cast<std::uint32_t>(last);
    if (graph_.nodes[keep].chains.size() < 3 || graph_.nodes[gone].chains.size() < 3) return false;
    if (length_[chain] > std::min(radius(keep), radius(gone)) + measure_.voxel()) return false;
    if (radius(keep) < radius(gone)) std::swap(keep, gone);
    const std::vector<std::uint32_t> way = from(chain, keep);
    const double way_length = length_[chain];
    detach(chain, keep);
    detach(chain, gone);
    drop(chain);
    const std::vector<std::uint32_t> moved = graph_.nodes[gone].chains;
    for (const std::uint32_t c : moved) {
      move_end(c, gone, keep, way);
      length_[c] += way_length;
      graph_.nodes[keep].chains.push_back(c);
    }
    graph_.nodes[gone] = {graph_.nodes[gone].voxel, {}, false};
    return true;
  }

  /// Extends the end of a chain at `from_node` along `way`, backwards, to the start of `way` at node `to`.
  void move_end(std::uint32_t c, std::uint32_t from_node, std::uint32_t to, const std::vector<std::uint32_t>& way) {
    Chain& chain = graph_.chains[c];
    if (chain.nodes[0] == static_cast<std::int32_t>(from_node)) {
      chain.voxels.insert(chain.voxels.begin(), way.begin(), way.end() - 1);
      chain.nodes[0] = static_cast<std::int32_t>(to);
    } else {
      chain.voxels.insert(chain.voxels.end(), way.rbegin() + 1, way.rend());
      chain.nodes[1] = static_cast<std::int32_t>(to);
    }
  }

  CurveGraph& graph_;
  const ChainMeasure& measure_;
  double spur_;
  const Context& context_;
  std::vector<double> length_;  ///< length of each chain
};

/// Removes the nodes and chains whose `is_there` is false.
CurveGraph compact(CurveGraph&& graph) {
  CurveGraph out;
  std::vector<std::int32_t> node_of(graph.nodes.size(), no_node);
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    if (!graph.nodes[n].is_there) continue;
    node_of[n] = static_cast<std::int32_t>(out.nodes.size());
    out.nodes.push_back({graph.nodes[n].voxel, {}, true});
  }
  for (Chain& chain : graph.chains) {
    if (!chain.is_there) continue;
    for (std::int32_t& node : chain.nodes) {
      if (node == no_node) continue;
      node = node_of[static_cast<std::size_t>(node)];
      out.nodes[static_cast<std::size_t>(node)].chains.push_back(static_cast<std::uint32_t>(out.chains.size()));
    }
    out.chains.push_back(std::move(chain));
  }
  return out;
}

}  // namespace

Vec3d ChainMeasure::position(std::uint32_t voxel) const {
  const auto x = static_cast<std::uint32_t>(size[0]);
  const auto y = static_cast<std::uint32_t>(size[1]);
  const std::uint32_t row = voxel / x;
  return {(voxel - row * x) * spacing.x, (row % y) * spacing.y, (row / y) * spacing.z};
}

double ChainMeasure::length(const std::vector<std::uint32_t>& voxels) const {
  double sum = 0;
  for (std::size_t v = 1; v < voxels.size(); ++v) sum += blum::length(position(voxels[v]) - position(voxels[v - 1]));
  return sum;
}

double ChainMeasure::voxel() const {
  return std::max({spacing.x, spacing.y, spacing.z});
}

void prune_spurs(CurveGraph& graph, const ChainMeasure& measure, double spur, const Context& context) {
  Pruner(graph, measure, spur, context).prune();
  graph = compact(std::move(graph));
}

}  // namespace blum::centrelines
