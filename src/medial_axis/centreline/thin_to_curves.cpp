#include "medial_axis/centreline/thin_to_curves.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/cells/thinning_order.hpp"

namespace blum::centrelines {
namespace {

using detail::DepthOrder;
using detail::Line;
using detail::SimpleCache;
using detail::Waiting;

constexpr Neighbourhood middle = 1U << 13U;
constexpr std::size_t steps_between_looks = std::size_t{1} << 16U;

bool is_end(Neighbourhood around) {
  return std::popcount(around & ~middle) == 1;
}

bool may_go(Neighbourhood around, SimpleCache& simple) {
  return !is_end(around) && simple.is_simple(around);
}

class Thinner {
 public:
  Thinner(const VoxelSet& voxels, std::span<const float> depth, const Vec3d& spacing, const Context& context)
      : voxels_(voxels),
        order_(depth, voxels.size()),
        step_(std::min({spacing.x, spacing.y, spacing.z}) / 16),
        context_(context),
        kept_(voxels.size()) {}

  VoxelSet thin() {
    look_at_each_once();
    look_again();
    return std::move(kept_);
  }

 private:
  void look_at_each_once() {
    Line line(step_);
    VoxelSet is_in_line(voxels_.size());
    const auto push = [&](std::uint32_t voxel) {
      const auto at = voxels_.place(voxel);
      if (is_in_line.contains(at[0], at[1], at[2])) return;
      is_in_line.insert(at[0], at[1], at[2]);
      line.push({order_.depth(voxel), voxel});
    };
    const auto stuck = order_.stuck(
        voxels_,
        [](std::uint32_t, const std::array<std::int64_t, 3>&, Neighbourhood around, SimpleCache& simple) {
          return may_go(around, simple);
        },
        context_);
    for (const std::uint32_t voxel : stuck) push(voxel);
    SimpleCache simple;
    Waiting next{};
    std::size_t steps = 0;
    while (line.pop(next)) {
      if (++steps % steps_between_looks == 0) throw_if_cancelled(context_);
      if (may_go(order_.present_around(next.voxel, kept_), simple)) continue;
      const auto at = voxels_.place(next.voxel);
      kept_.insert(at[0], at[1], at[2]);
      left_.push_back(next);
      for (std::size_t n = 0; n < 27; ++n) {
        const std::uint32_t other = order_.neighbour(next.voxel, n);
        if (order_.is_deeper(other, next.voxel)) push(other);
      }
    }
  }

  /// Examines the kept voxels again, until none may be removed. When they were first examined, all their deeper
  /// neighbours were present.
  void look_again() {
    SimpleCache simple;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> line(std::greater<>(), std::move(left_));
    std::size_t steps = 0;
    while (!line.empty()) {
      if (++steps % steps_between_looks == 0) throw_if_cancelled(context_);
      const Waiting next = line.top();
      line.pop();
      const auto at = voxels_.place(next.voxel);
      if (!kept_.contains(at[0], at[1], at[2])) continue;
      const Neighbourhood around = neighbourhood(kept_, at[0], at[1], at[2]);
      if (!may_go(around, simple)) continue;
      kept_.erase(at[0], at[1], at[2]);
      for (Neighbourhood rest = around & ~middle; rest != 0; rest &= rest - 1) {
        const std::uint32_t other = order_.neighbour(next.voxel, static_cast<std::size_t>(std::countr_zero(rest)));
        line.push({order_.depth(other), other});
      }
    }
  }

  const VoxelSet& voxels_;
  DepthOrder order_;
  double step_;
  const Context& context_;
  VoxelSet kept_;
  std::vector<Waiting> left_;  ///< the voxels of `kept_`
};

}  // namespace

VoxelSet thin_to_curves(const VoxelSet& voxels, std::span<const float> depth, const Vec3d& spacing,
                        const Context& context) {
  return Thinner(voxels, depth, spacing, context).thin();
}

}  // namespace blum::centrelines
