#include "geometry/bvh/box_tree.hpp"

#include "blum/core/parallel.hpp"

namespace blum {

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
