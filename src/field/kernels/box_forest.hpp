// Blum: hierarchies of boxes over records, on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "field/kernels/record.hpp"

namespace blum::kernels {

enum Kind : std::uint8_t { vertex_kind, edge_kind, face_kind };
inline constexpr std::uint32_t kind_count = 3;

/// Box in the normalised frame, rounded outwards. An empty box is placed far away.
struct alignas(32) ReachBox {
  Vec3f lower{far_away, far_away, far_away};
  float reach = 0;  ///< sites in the box cannot be closest to any point further away than this
  Vec3f upper{far_away, far_away, far_away};
  float unused = 0;

  BLUM_HD void set(const Vec3d& low, const Vec3d& high, float reach_of_content) {
    constexpr float rounding = 2e-7F;
    lower = to_float(low) - Vec3f{rounding, rounding, rounding};
    upper = to_float(high) + Vec3f{rounding, rounding, rounding};
    reach = reach_of_content;
  }
  [[nodiscard]] BLUM_HD bool is_empty() const { return lower.x >= far_away; }
};

/// Computes the bounding box of each warp_size consecutive boxes.
struct BoundBoxes {
  const ReachBox* children;
  std::size_t child_count;
  ReachBox* parents;

  BLUM_HD void operator()(std::size_t parent) const {
    const std::size_t first = parent * warp_size;
    const std::size_t last = smaller(first + warp_size, child_count);
    ReachBox box;
    for (std::size_t k = first; k < last; ++k) {
      const ReachBox& child = children[k];
      if (child.is_empty()) continue;
      box.lower = box.is_empty() ? child.lower : min(box.lower, child.lower);
      box.upper = box.upper.x >= far_away ? child.upper : max(box.upper, child.upper);
      box.reach = larger(box.reach, child.reach);
    }
    parents[parent] = box;
  }
};

/// Tree above records of one kind. Each box of level 0 bounds a cluster of warp_size records. Each box of level l + 1
/// bounds warp_size boxes of level l. The last level has at most warp_size boxes.
struct Tree {
  static constexpr std::uint32_t most_levels = 7;

  const Record* records = nullptr;
  std::uint32_t record_count = 0;
  std::uint32_t levels = 0;  ///< 0 if there are no records
  std::array<const ReachBox*, most_levels> boxes{};
  std::array<std::uint32_t, most_levels> box_count{};
};

struct Forest {
  std::array<Tree, kind_count> trees;
};

/// Entry of a search: a cluster of records, or a box whose children are still to be searched. The root is the parent of
/// all boxes of the last level.
struct Entry {
  std::uint32_t code;

  static constexpr int level_bits = 4;
  static constexpr int index_bits = 26;

  BLUM_HD static constexpr Entry make(std::uint32_t kind, std::uint32_t level, std::uint32_t index) {
    return {(kind << (level_bits + index_bits)) | (level << index_bits) | index};
  }
  [[nodiscard]] BLUM_HD constexpr std::uint32_t kind() const { return code >> (level_bits + index_bits); }
  /// Returns 0 for a cluster of records. For a result l > 0, the children are boxes of level l - 1.
  [[nodiscard]] BLUM_HD constexpr std::uint32_t level() const {
    return (code >> index_bits) & ((1U << level_bits) - 1U);
  }
  [[nodiscard]] BLUM_HD constexpr std::uint32_t index() const { return code & ((1U << index_bits) - 1U); }
};

template <class Device>
struct RecordSet {
  typename Device::template Array<Record> records;
  typename Device::template Array<ReachBox> site_boxes;
  std::array<typename Device::template Array<ReachBox>, Tree::most_levels> boxes;
};

/// Builds the tree above records. Their boxes must be set. Cost: O(records).
template <class Device>
Tree build_tree(Device& device, RecordSet<Device>& set) {
  Tree tree;
  tree.records = set.records.data();
  tree.record_count = static_cast<std::uint32_t>(set.records.size());
  const auto* children = &set.site_boxes;
  while (children->size() > (tree.levels == 0 ? 0 : warp_size)) {
    auto& parents = set.boxes[tree.levels];
    parents.resize((children->size() + warp_size - 1) / warp_size);
    device.for_each(parents.size(), BoundBoxes{children->data(), children->size(), parents.data()});
    tree.boxes[tree.levels] = parents.data();
    tree.box_count[tree.levels] = static_cast<std::uint32_t>(parents.size());
    ++tree.levels;
    children = &parents;
  }
  return tree;
}

}  // namespace blum::kernels
