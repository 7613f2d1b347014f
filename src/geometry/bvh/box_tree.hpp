// Blum: trees of boxes with eight children per node. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/ray.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Eight boxes, stored axis by axis. An empty box (+inf, -inf) is infinitely far from every point and every box.
struct alignas(64) BoxBlock {
  double lower[3][lanes];
  double upper[3][lanes];
};

[[nodiscard]] inline Box3 box_at(const BoxBlock& block, std::size_t lane) {
  return {{block.lower[0][lane], block.lower[1][lane], block.lower[2][lane]},
          {block.upper[0][lane], block.upper[1][lane], block.upper[2][lane]}};
}

/// Computes the squared distances from a point to eight boxes. The distance is 0 if the point is in the box.
void squared_distances(const BoxBlock& block, const Vec3d& query, double (&out)[lanes]);

/// Returns a bit for each box of a block that touches `box`.
[[nodiscard]] unsigned touching(const BoxBlock& block, const Box3& box);

/// Complete tree over consecutive leaves. Block i of level k > 0 contains the boxes of blocks 8 i ... 8 i + 7 of level
/// k - 1. For k = 0 these are the boxes of leaves 8 i ... 8 i + 7. The last level has one block.
template <class Block>
struct BlockTree {
  std::vector<std::vector<Block>> levels;

  [[nodiscard]] bool is_empty() const { return levels.empty(); }
  [[nodiscard]] int top() const { return static_cast<int>(levels.size()) - 1; }
};

using BoxTree = BlockTree<BoxBlock>;

/// Builds a tree of boxes.
/// @param leaves  one box per leaf.
[[nodiscard]] BoxTree make_box_tree(std::span<const Box3> leaves, const Context& context);

/// Calls visit(leaf) for each leaf whose box touches `box`, until a call returns false. Allocates nothing.
/// @param first_leaf  leaves with a smaller index are skipped.
template <class Block, class Box, class Visit>
void for_each_touching(const BlockTree<Block>& tree, const Box& box, std::size_t first_leaf, const Visit& visit) {
  if (tree.is_empty()) return;
  struct Item {
    std::uint32_t block;
    std::int32_t level;  ///< -1 for a leaf
  };
  std::array<Item, 128> stack;  // the stack contains at most seven siblings from each of at most eleven levels
  std::size_t size = 0;
  stack[size++] = {0, tree.top()};
  while (size > 0) {
    const Item item = stack[--size];
    if (item.level < 0) {
      if (!visit(static_cast<std::size_t>(item.block))) return;
      continue;
    }
    const Block& block = tree.levels[static_cast<std::size_t>(item.level)][item.block];
    for (unsigned bits = touching(block, box); bits != 0; bits &= bits - 1) {
      const std::size_t child = item.block * lanes + static_cast<std::size_t>(std::countr_zero(bits));
      // A child at level k contains 8^k leaves.
      const std::size_t end = (child + 1) << (3 * static_cast<unsigned>(item.level));
      if (end > first_leaf) stack[size++] = {static_cast<std::uint32_t>(child), item.level - 1};
    }
  }
}

/// Node or leaf that a search still has to visit, with its distance as key.
struct PendingBox {
  double key = 0;
  std::uint32_t block = 0;
  std::int32_t level = 0;  ///< -1 for a leaf
};

/// Stack of a depth-first search. It contains at most seven siblings from each of at most eleven levels.
struct PendingBoxes {
  InlineList<PendingBox, 128> items;

  /// Pushes the children of a node with keys of at most `limit`. The child with the smallest key is on top of the
  /// stack.
  void push_children(const PendingBox& parent, const double (&keys)[lanes], double limit) {
    const std::size_t bottom = items.size();
    unsigned within = 0;  // computed without branches, which would often be mispredicted
    for (std::size_t lane = 0; lane < lanes; ++lane) within |= static_cast<unsigned>(keys[lane] <= limit) << lane;
    for (; within != 0; within &= within - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(within));
      const PendingBox child{keys[lane], static_cast<std::uint32_t>(parent.block * lanes + lane), parent.level - 1};
      std::size_t place = items.size();
      items.push_back(child);
      for (; place > bottom && items[place - 1].key < child.key; --place) items[place] = items[place - 1];
      items[place] = child;
    }
  }
};

/// Calls limit = visit(leaf) for the leaves whose boxes are within `limit` of a point. Among siblings, nearer ones are
/// visited first. Allocates nothing.
template <class Visit>
void visit_near(const BoxTree& tree, const Vec3d& point, double limit, const Visit& visit) {
  // The value must not be rounded to less than the square of the limit. The upper bound excludes empty boxes, which are
  // infinitely far away.
  const auto squared_limit = [&] {
    return limit < 0 ? -1 : std::min(limit * limit * (1 + 1e-14), std::numeric_limits<double>::max());
  };
  if (tree.is_empty()) return;
  PendingBoxes pending;
  pending.items.push_back({0.0, 0, tree.top()});
  double squared[lanes];
  while (!pending.items.empty()) {
    const PendingBox item = pending.items.pop_back();
    if (!(item.key <= squared_limit())) continue;
    if (item.level < 0) {
      limit = visit(static_cast<std::size_t>(item.block));
      continue;
    }
    squared_distances(tree.levels[static_cast<std::size_t>(item.level)][item.block], point, squared);
    pending.push_children(item, squared, squared_limit());
  }
}

/// Computes the t >= 0 at which a ray enters each of eight boxes; NaN if it misses the box. Rounding never makes a
/// result larger than the exact value.
/// @param inverse  reciprocals of the direction's components; 0 for components that are 0.
void entries(const BoxBlock& block, const Ray& ray, const Vec3d& inverse, double (&out)[lanes]);

/// Calls limit = visit(leaf) for the leaves whose boxes a ray meets between t = 0 and `limit`. Among siblings, nearer
/// ones are visited first. Allocates nothing.
template <class Visit>
void visit_along(const BoxTree& tree, const Ray& ray, double limit, const Visit& visit) {
  if (tree.is_empty()) return;
  Vec3d inverse;
  for (std::size_t axis = 0; axis < 3; ++axis) inverse[axis] = ray.direction[axis] == 0 ? 0 : 1 / ray.direction[axis];
  PendingBoxes pending;
  pending.items.push_back({0.0, 0, tree.top()});
  double keys[lanes];
  while (!pending.items.empty()) {
    const PendingBox item = pending.items.pop_back();
    if (!(item.key <= limit)) continue;
    if (item.level < 0) {
      limit = visit(static_cast<std::size_t>(item.block));
      continue;
    }
    entries(tree.levels[static_cast<std::size_t>(item.level)][item.block], ray, inverse, keys);
    pending.push_children(item, keys, limit);
  }
}

/// Returns true if `box` touches the box of some leaf. Allocates nothing.
[[nodiscard]] bool may_touch(const BoxTree& tree, const Box3& box);

}  // namespace blum
