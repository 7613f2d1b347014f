// Blum: order and tests for thinning voxels by depth. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/grid/voxel_topology.hpp"

namespace blum::detail {

/// Cache of the results of is_simple() for neighbourhoods. Few of the 2^26 possible neighbourhoods occur.
class SimpleCache {
 public:
  [[nodiscard]] bool is_simple(Neighbourhood around) {
    const std::uint32_t key = (around & ~middle) | known;
    std::uint32_t& slot = slots_[(key * 0x9e3779b1U) >> (32U - bits)];
    if ((slot & ~middle) != key) slot = key | (blum::is_simple(around) ? middle : 0);
    return (slot & middle) != 0;
  }

 private:
  static constexpr unsigned bits = 14;
  static constexpr std::uint32_t middle = 1U << 13U;
  static constexpr std::uint32_t known = 1U << 31U;  // distinguishes a key from an empty slot
  std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(std::size_t{1} << bits, 0);
};

/// Voxel that waits for its turn. The order is by depth, shallowest first, then by index.
struct Waiting {
  float depth;
  std::uint32_t voxel;
  [[nodiscard]] friend bool operator>(const Waiting& a, const Waiting& b) {
    return a.depth != b.depth ? a.depth > b.depth : a.voxel > b.voxel;
  }
};

/// Queue of voxels by ascending depth. A pushed voxel must not precede the voxel that was popped last.
class Line {
 public:
  explicit Line(double step) : per_step_(1 / step) {}
  void push(const Waiting& voxel) {
    const auto step = static_cast<std::size_t>(std::clamp(voxel.depth * per_step_, 0.0, 1e6));
    if (step >= steps_.size()) steps_.resize(step + 1);
    steps_[step].push_back(voxel);
    if (step == first_ && is_heap_) std::push_heap(steps_[step].begin(), steps_[step].end(), std::greater<>());
  }
  /// Moves the next voxel to `next`. Returns false if the queue is empty.
  bool pop(Waiting& next) {
    while (first_ < steps_.size() && steps_[first_].empty()) {
      steps_[first_].shrink_to_fit();
      ++first_;
      is_heap_ = false;
    }
    if (first_ == steps_.size()) return false;
    std::vector<Waiting>& step = steps_[first_];
    if (!is_heap_) std::make_heap(step.begin(), step.end(), std::greater<>());
    is_heap_ = true;
    std::pop_heap(step.begin(), step.end(), std::greater<>());
    next = step.back();
    step.pop_back();
    return true;
  }

 private:
  double per_step_;
  std::vector<std::vector<Waiting>> steps_;
  std::size_t first_ = 0;
  bool is_heap_ = false;
};

/// Order in which voxels are examined: by depth, then by index.
class DepthOrder {
 public:
  /// @param depth  above zero for the voxels to be thinned and for no others. No voxel to be thinned lies in the
  /// outermost layer of the box.
  DepthOrder(std::span<const float> depth, const std::array<std::int64_t, 3>& size) : depth_(depth), size_(size) {
    for (std::size_t n = 0; n < 27; ++n) {
      const auto at = static_cast<std::int64_t>(n);
      offset_[n] = (at / 9 - 1) * size[0] * size[1] + (at / 3 % 3 - 1) * size[0] + at % 3 - 1;
    }
  }

  [[nodiscard]] float depth(std::uint32_t voxel) const { return depth_[voxel]; }
  /// Returns the linear index of the neighbour that a bit of Neighbourhood represents.
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t voxel, std::size_t bit) const {
    return static_cast<std::uint32_t>(voxel + offset_[bit]);
  }
  [[nodiscard]] bool is_deeper(std::uint32_t a, std::uint32_t b) const {
    return depth_[a] != depth_[b] ? depth_[a] > depth_[b] : a > b && depth_[a] > 0;
  }
  /// Returns the neighbours that are present when a voxel is examined: all deeper neighbours, and the other neighbours
  /// that are in `kept`.
  [[nodiscard]] Neighbourhood present_around(std::uint32_t voxel, const VoxelSet& kept) const {
    const auto at = kept.place(voxel);
    Neighbourhood around = neighbourhood(kept, at[0], at[1], at[2]);
    for (std::size_t n = 0; n < 27; ++n) {
      if (n != 13) around |= static_cast<Neighbourhood>(is_deeper(neighbour(voxel, n), voxel)) << n;
    }
    return around & ~(1U << 13U);
  }

  /// Returns the voxels that may not be removed if all their shallower neighbours are removed. Each voxel is examined
  /// with only its deeper neighbours present, so the voxels can be examined in parallel.
  /// @param may_go  (voxel, place, neighbourhood, SimpleCache) -> bool; called by several threads.
  template <class Judge>
  [[nodiscard]] std::vector<std::uint32_t> stuck(const VoxelSet& voxels, const Judge& may_go,
                                                 const Context& context) const {
    const auto layers = static_cast<std::size_t>(size_[2]);
    std::vector<std::vector<std::uint32_t>> found(layers);
    parallel_for(context, layers, 1, "thinning", [&](const WorkRange& range) {
      SimpleCache simple;
      std::vector<Neighbourhood> deeper(static_cast<std::size_t>(size_[0]));
      for (std::size_t k = range.begin; k < range.end; ++k) {
        if (k == 0 || k + 1 == layers) continue;
        for (std::int64_t j = 1; j + 1 < size_[1]; ++j) {
          const auto row = voxels.row(j, static_cast<std::int64_t>(k));
          if (std::all_of(row.begin(), row.end(), [](std::uint64_t word) { return word == 0; })) continue;
          const std::size_t first = (k * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(j)) *
                                    static_cast<std::size_t>(size_[0]);
          find_deeper(first, deeper);
          for (std::size_t w = 0; w < row.size(); ++w) {
            for (std::uint64_t rest = row[w]; rest != 0; rest &= rest - 1) {
              const std::size_t i = 64 * w + static_cast<std::size_t>(std::countr_zero(rest));
              const auto voxel = static_cast<std::uint32_t>(first + i);
              const std::array<std::int64_t, 3> at{static_cast<std::int64_t>(i), j, static_cast<std::int64_t>(k)};
              if (!may_go(voxel, at, deeper[i], simple)) found[k].push_back(voxel);
            }
          }
        }
      }
    });
    std::vector<std::uint32_t> all;
    for (const auto& layer : found) all.insert(all.end(), layer.begin(), layer.end());
    return all;
  }

 private:
  /// Finds the deeper neighbours of each voxel of a row that starts at `first`.
  void find_deeper(std::size_t first, std::vector<Neighbourhood>& deeper) const {
    const std::size_t length = deeper.size();
    const float* own = depth_.data() + first;
    std::fill(deeper.begin(), deeper.end(), 0);
    Neighbourhood* out = deeper.data();
    for (unsigned n = 0; n < 27; ++n) {
      if (n == 13) continue;
      const float* other = own + offset_[n];
      const Neighbourhood bit = 1U << n;
      // Linear indices ascend with n. If two voxels are equally deep, the voxel with the larger index is treated as
      // deeper.
      if (n < 13) {
        for (std::size_t i = 1; i + 1 < length; ++i) out[i] |= other[i] > own[i] ? bit : 0;
      } else {
        for (std::size_t i = 1; i + 1 < length; ++i) out[i] |= other[i] >= own[i] ? bit : 0;
      }
    }
  }

  std::span<const float> depth_;
  std::array<std::int64_t, 3> size_;
  std::array<std::int64_t, 27> offset_{};
};

}  // namespace blum::detail
