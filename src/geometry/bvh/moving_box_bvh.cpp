#include "blum/geometry/moving_box_bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/space_order.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/bvh/moving_block.hpp"

namespace blum {
namespace {

constexpr std::size_t build_grain = 256;

MovingBlock empty_block() {
  MovingBlock block;
  std::fill_n(&block.lower[0][0][0], 6 * lanes, std::numeric_limits<float>::infinity());
  std::fill_n(&block.upper[0][0][0], 6 * lanes, -std::numeric_limits<float>::infinity());
  return block;
}

void set(MovingBlock& block, std::size_t lane, const MovingBoxF& box) {
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block.lower[side][axis][lane] = box.lower[side][axis];
      block.upper[side][axis][lane] = box.upper[side][axis];
    }
  }
}

MovingBoxF box_at(const MovingBlock& block, std::size_t lane) {
  MovingBoxF box;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[side][axis] = block.lower[side][axis][lane];
      box.upper[side][axis] = block.upper[side][axis][lane];
    }
  }
  return box;
}

MovingBoxF around(const MovingBlock& block) {
  MovingBoxF box;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[side][axis] = *std::min_element(block.lower[side][axis], block.lower[side][axis] + lanes);
      box.upper[side][axis] = *std::max_element(block.upper[side][axis], block.upper[side][axis] + lanes);
    }
  }
  return box;
}

float most_magnitude(const MovingBoxF& box) {
  float most = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      most = std::max({most, std::abs(box.lower[side][axis]), std::abs(box.upper[side][axis])});
    }
  }
  return most;
}

/// Returns a lower bound of the times at which one side of a box passes a side of another box. The gaps are the heights
/// of the first side above the second at the start and at the end, less rounding. At most one gap is positive.
float passing_time(float start_gap, float end_gap) {
  return start_gap > 0 && end_gap < start_gap ? start_gap / (start_gap - end_gap) : 0;
}

/// Returns a lower bound of the times at which a box touches a box of a block.
/// @param rounding  bound on the rounding errors of gaps.
double touch_time(const MovingBlock& block, std::size_t lane, const MovingBoxF& box, float rounding) {
  float time = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    time = std::max({time,
                     passing_time(block.lower[0][axis][lane] - box.upper[0][axis] - rounding,
                                  block.lower[1][axis][lane] - box.upper[1][axis] - rounding),
                     passing_time(box.lower[0][axis] - block.upper[0][axis][lane] - rounding,
                                  box.lower[1][axis] - block.upper[1][axis][lane] - rounding)});
  }
  // Gaps already allow for rounding; this margin allows for rounding of the quotient.
  constexpr double margin = 1 - 0x1p-20;
  return margin * static_cast<double>(time);
}

/// Computes lower bounds of the times at which a box touches eight boxes. The bounds are infinite for boxes that the
/// given box does not touch.
void touch_times(const MovingBlock& block, const MovingBoxF& box, float rounding, double (&out)[lanes]) {
  std::fill_n(out, lanes, std::numeric_limits<double>::infinity());
  for (unsigned bits = touching(block, box); bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    out[lane] = touch_time(block, lane, box, rounding);
  }
}

/// Maps coordinates to magnitudes of at most 1, in single precision, preserving order. Boxes from other trees may have
/// larger coordinates. Infinite values are clamped to finite ones, because infinite coordinates mark empty boxes.
struct Frame {
  Vec3d middle;
  double scale = 1;

  [[nodiscard]] float of(double x, std::size_t axis) const {
    constexpr double most = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp((x - middle[axis]) * scale, -most, most));
  }
  [[nodiscard]] MovingBoxF of(const MovingBox& box) const {
    MovingBoxF out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.lower[0][axis] = of(box.start.lower[axis], axis);
      out.upper[0][axis] = of(box.start.upper[axis], axis);
      out.lower[1][axis] = of(box.end.lower[axis], axis);
      out.upper[1][axis] = of(box.end.upper[axis], axis);
    }
    return out;
  }
};

}  // namespace

struct MovingBoxBvh::Data {
  std::vector<MovingBox> boxes;      ///< in order of rank (position in spatial order)
  std::vector<std::uint32_t> order;  ///< index of the box at each rank
  Frame frame;
  std::vector<MovingBlock> blocks;  ///< boxes in order of rank
  BlockTree<MovingBlock> tree;      ///< its leaves are `blocks`

  void build(const Context& context) {
    blocks.assign((boxes.size() + lanes - 1) / lanes, empty_block());
    parallel_for(context, blocks.size(), build_grain, "", [&](const WorkRange& range) {
      for (std::size_t rank = range.begin * lanes; rank < std::min(range.end * lanes, boxes.size()); ++rank) {
        set(blocks[rank / lanes], rank % lanes, frame.of(boxes[rank]));
      }
    });
    const std::vector<MovingBlock>* below = &blocks;
    do {
      std::vector<MovingBlock> above((below->size() + lanes - 1) / lanes, empty_block());
      for (std::size_t k = 0; k < below->size(); ++k) set(above[k / lanes], k % lanes, around((*below)[k]));
      below = &tree.levels.emplace_back(std::move(above));
    } while (below->size() > 1);
  }
};

MovingBoxBvh::MovingBoxBvh(std::span<const MovingBox> boxes, const Context& context) : data_(std::make_unique<Data>()) {
  if (boxes.empty()) return;
  Box3 all;
  for (const MovingBox& box : boxes) {
    all.extend(box.start);
    all.extend(box.end);
  }
  const Vec3d half = all.upper * 0.5 - all.lower * 0.5;
  const double largest = std::max({half.x, half.y, half.z});
  int exponent = 0;
  if (largest > 0) std::frexp(largest, &exponent);
  data_->frame = {all.lower * 0.5 + all.upper * 0.5, std::ldexp(1.0, -std::clamp(exponent, -1000, 1000))};
  const Frame& frame = data_->frame;
  const auto middle = [&](std::size_t k) {
    const MovingBox& box = boxes[k];
    return ((box.start.lower - frame.middle) + (box.start.upper - frame.middle) + (box.end.lower - frame.middle) +
            (box.end.upper - frame.middle)) *
           frame.scale;
  };
  data_->order = space_order(boxes.size(), middle, context);
  data_->boxes.reserve(boxes.size());
  for (const std::uint32_t index : data_->order) data_->boxes.push_back(boxes[index]);
  data_->build(context);
}

MovingBoxBvh::MovingBoxBvh(MovingBoxBvh&&) noexcept = default;
MovingBoxBvh& MovingBoxBvh::operator=(MovingBoxBvh&&) noexcept = default;
MovingBoxBvh::~MovingBoxBvh() = default;

std::size_t MovingBoxBvh::size() const {
  return data_->order.size();
}

std::size_t MovingBoxBvh::block_count() const {
  return (size() + lanes - 1) / lanes;
}

void MovingBoxBvh::for_each_pair(std::size_t block, const MovingBoxBvh& other,
                                 FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const {
  if (other.size() == 0) return;
  const std::size_t end = std::min((block + 1) * lanes, size());
  for (std::size_t rank = block * lanes; rank < end; ++rank) {
    const MovingBoxF box = other.data_->frame.of(data_->boxes[rank]);
    for_each_touching(other.data_->tree, box, 0, [&](std::size_t there) {
      for (unsigned bits = touching(other.data_->blocks[there], box); bits != 0; bits &= bits - 1) {
        const std::size_t other_rank = there * lanes + static_cast<std::size_t>(std::countr_zero(bits));
        visit(data_->order[rank], other.data_->order[other_rank]);
      }
      return true;
    });
  }
}

void MovingBoxBvh::for_each_self_pair(std::size_t block, FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const {
  const MovingBlock& here = data_->blocks[block];
  const MovingBoxF box = around(here);
  for_each_touching(data_->tree, box, block, [&](std::size_t there) {
    const MovingBlock& blocks = data_->blocks[there];
    for (unsigned rows = touching(here, around(blocks)); rows != 0; rows &= rows - 1) {
      const auto row = static_cast<std::size_t>(std::countr_zero(rows));
      unsigned columns = touching(blocks, box_at(here, row));
      if (there == block) columns &= ~0U << (row + 1);  // each pair only once
      for (; columns != 0; columns &= columns - 1) {
        const auto column = static_cast<std::size_t>(std::countr_zero(columns));
        visit(data_->order[block * lanes + row], data_->order[there * lanes + column]);
      }
    }
    return true;
  });
}

void MovingBoxBvh::visit_until(const MovingBox& box, double limit, FunctionRef<double(std::uint32_t)> visit) const {
  if (size() == 0) return;
  const MovingBoxF own = data_->frame.of(box);
  // A gap at one end has errors of two coordinates and of two differences. Each is at most 2^-23 of the largest
  // magnitude. Magnitudes of the boxes of this hierarchy are at most 1.
  const float rounding = 0x1p-20F * std::max(1.0F, most_magnitude(own));
  const BlockTree<MovingBlock>& tree = data_->tree;
  PendingBoxes pending;
  pending.items.push_back({0.0, 0, tree.top()});
  double times[lanes];
  while (!pending.items.empty()) {
    const PendingBox item = pending.items.pop_back();
    if (!(item.key <= limit)) continue;
    const bool is_leaf = item.level < 0;
    const MovingBlock& block =
        is_leaf ? data_->blocks[item.block] : tree.levels[static_cast<std::size_t>(item.level)][item.block];
    touch_times(block, own, rounding, times);
    if (!is_leaf) {
      pending.push_children(item, times, std::min(limit, 1.0));
      continue;
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (times[lane] <= std::min(limit, 1.0)) limit = visit(data_->order[item.block * lanes + lane]);
    }
  }
}

}  // namespace blum
