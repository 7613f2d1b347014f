#include "field/cpu/cluster_forest.hpp"

#include <algorithm>

#include "blum/core/parallel.hpp"

namespace blum::cpu {
namespace {

/// Bounds each sixteen consecutive boxes. Boxes around nothing do not count, unless there is nothing else.
void bound_children(const BoxArrays& children, const Context& context, BoxArrays& parents) {
  const std::size_t count = (children.count + cluster_size - 1) / cluster_size;
  parents.resize(count);
  parallel_for(context, count, 256, "", [&](const WorkRange& range) {
    for (std::size_t parent = range.begin; parent < range.end; ++parent) {
      const std::size_t first = parent * cluster_size;
      const std::size_t last = std::min(first + cluster_size, children.count);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float lower = far_away;
        float upper = -far_away;
        for (std::size_t child = first; child < last; ++child) {
          lower = std::min(lower, children.lower[axis][child]);
          if (children.lower[axis][child] < far_away) upper = std::max(upper, children.upper[axis][child]);
        }
        parents.lower[axis][parent] = lower;
        parents.upper[axis][parent] = std::max(lower, upper);
      }
      parents.reach[parent] = *std::max_element(children.reach.begin() + static_cast<std::ptrdiff_t>(first),
                                                children.reach.begin() + static_cast<std::ptrdiff_t>(last));
    }
  });
}

}  // namespace

void build_cluster_forest(const SiteRecords& sites, const Context& context, ClusterForest& out) {
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    ClusterTree& tree = out.trees[kind];
    const BoxArrays* children = &sites.kinds[kind].cluster_boxes;
    std::size_t depth = 0;
    do {
      if (tree.levels.size() == depth) tree.levels.emplace_back();
      // emplace_back may have moved the level that `children` points to.
      if (depth > 0) children = &tree.levels[depth - 1];
      bound_children(*children, context, tree.levels[depth]);
      children = &tree.levels[depth];
      ++depth;
    } while (children->count > cluster_size);
    tree.levels.resize(depth);
  }
}

}  // namespace blum::cpu
