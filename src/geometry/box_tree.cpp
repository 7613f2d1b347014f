#include "geometry/box_tree.hpp"

#include <algorithm>
#include <limits>

#include "blum/core/parallel.hpp"

namespace blum {

void entries(const BoxBlock& block, const Ray& ray, const Vec3d& inverse, double (&out)[lanes]) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  // Each end of a slab is rounded three times (Ize 2013: 1 + 2 gamma(3) makes up for it at one end).
  constexpr double widened = 1 + 2e-15;
  for (std::size_t i = 0; i < lanes; ++i) {
    double enter = 0;
    double leave = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double below = block.lower[axis][i] - ray.origin[axis];
      const double above = block.upper[axis][i] - ray.origin[axis];
      if (inverse[axis] == 0) {
        if (below > 0 || above < 0) leave = -1;
        continue;
      }
      const double first = below * inverse[axis];
      const double last = above * inverse[axis];
      enter = std::max(enter, std::min(first, last) * (2 - widened));
      leave = std::min(leave, std::max(first, last) * widened);
    }
    out[i] = enter <= leave && block.lower[0][i] <= block.upper[0][i] ? enter : nothing;
  }
}

BoxTree make_box_tree(std::span<const Box3> leaves, const Context& context) {
  BoxTree tree;
  std::vector<Box3> boxes(leaves.begin(), leaves.end());
  while (!boxes.empty()) {
    const std::size_t count = (boxes.size() + lanes - 1) / lanes;
    std::vector<BoxBlock>& blocks = tree.levels.emplace_back(count);
    std::vector<Box3> parents(count);
    parallel_for(context, count, 4096, "", [&](const WorkRange& range) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t child = i * lanes + lane;
          const Box3 box = child < boxes.size() ? boxes[child] : Box3{};
          for (std::size_t axis = 0; axis < 3; ++axis) {
            blocks[i].lower[axis][lane] = box.lower[axis];
            blocks[i].upper[axis][lane] = box.upper[axis];
          }
          parents[i].extend(box);
        }
      }
    });
    if (count == 1) break;
    boxes = std::move(parents);
  }
  return tree;
}

bool may_touch(const BoxTree& tree, const Box3& box) {
  bool touches = false;
  for_each_touching(tree, box, 0, [&](std::size_t) {
    touches = true;
    return false;
  });
  return touches;
}

}  // namespace blum
