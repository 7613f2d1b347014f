#include "medial_axis/cells/thin_voxels.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/cells/thinning_order.hpp"
#include "medial_axis/cells/voxel_border.hpp"

namespace blum::detail {
namespace {

using Place = std::array<std::int64_t, 3>;

constexpr std::size_t steps_between_looks = std::size_t{1} << 16U;

/// The cells at a lattice node that a voxel ahead of it (0), or behind it (1), along each axis has: bits by axes.
constexpr std::uint8_t cells_towards(unsigned behind) {
  std::uint8_t bits = 0;
  for (unsigned axes = 0; axes < 8; ++axes) {
    if ((axes & behind) == 0) bits |= static_cast<std::uint8_t>(1U << axes);
  }
  return bits;
}

/// The neighbours that have the cell of a voxel that spans `axes` from its corner `corner` (bits x, y, z: far side).
constexpr auto make_sharers() {
  std::array<std::array<Neighbourhood, 8>, 8> table{};
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (unsigned axes = 0; axes < 8; ++axes) {
      if ((axes & corner) == 0) table[corner][axes] = sharers_of_place[place_on_border(corner, axes)];
    }
  }
  return table;
}
constexpr auto sharers_of = make_sharers();

class Thinner {
 public:
  Thinner(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
          const Importance& importance, const Context& context)
      : attached_(attached),
        voxels_(attached.voxels()),
        size_(voxels_.size()),
        lattice_(lattice),
        importance_(importance),
        context_(context),
        own_depth_(is_depth_enough(solid, voxels_, context) ? Buffer<float>() : depth_of(solid, voxels_)),
        depth_(own_depth_.empty() ? solid.depth.span() : own_depth_.span()),
        order_(depth_, size_),
        step_(std::min({solid.grid.spacing.x, solid.grid.spacing.y, solid.grid.spacing.z}) / 16) {}

  VoxelSet thin() {
    Line line(step_);
    is_in_line_ = VoxelSet(size_);
    kept_ = VoxelSet(size_);
    const auto stuck = order_.stuck(
        voxels_,
        [this](std::uint32_t voxel, const Place& at, Neighbourhood around, SimpleCache& simple) {
          return may_go(voxel, at, around, simple);
        },
        context_);
    for (const std::uint32_t voxel : stuck) {
      const Place at = voxels_.place(voxel);
      is_in_line_.insert(at[0], at[1], at[2]);
      line.push({depth_[voxel], voxel});
    }
    SimpleCache simple;
    Waiting next{};
    std::size_t steps = 0;
    while (line.pop(next)) {
      if (++steps % steps_between_looks == 0) throw_if_cancelled(context_);
      const Place at = voxels_.place(next.voxel);
      const Neighbourhood around = order_.present_around(next.voxel, kept_);
      if (may_go(next.voxel, at, around, simple)) continue;
      kept_.insert(at[0], at[1], at[2]);
      for (std::size_t n = 0; n < 27; ++n) {
        const std::uint32_t other = order_.neighbour(next.voxel, n);
        if (!order_.is_deeper(other, next.voxel)) continue;
        const Place there = voxels_.place(other);
        if (is_in_line_.contains(there[0], there[1], there[2])) continue;
        is_in_line_.insert(there[0], there[1], there[2]);
        line.push({depth_[other], other});
      }
    }
    return std::move(kept_);
  }

 private:
  /// Whether the depths are above zero for the voxels, and only for these: not where some are extra cells of the model.
  static bool is_depth_enough(const VoxelSolid& solid, const VoxelSet& voxels, const Context& context) {
    const auto layers = static_cast<std::size_t>(solid.grid.size[2]);
    std::vector<std::uint8_t> is_enough(layers, 1);
    parallel_for(context, layers, 1, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        std::size_t at = solid.grid.index(0, 0, static_cast<std::int64_t>(k));
        for (std::int64_t j = 0; j < solid.grid.size[1]; ++j) {
          const auto row = voxels.row(j, static_cast<std::int64_t>(k));
          for (std::int64_t i = 0; i < solid.grid.size[0]; ++i, ++at) {
            const bool is_in = (row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1U) != 0;
            if (is_in != (solid.depth[at] > 0)) is_enough[k] = 0;
          }
        }
      }
    });
    return std::all_of(is_enough.begin(), is_enough.end(), [](std::uint8_t is) { return is != 0; });
  }

  /// Depths that are above zero for the voxels, and only for these.
  static Buffer<float> depth_of(const VoxelSolid& solid, const VoxelSet& voxels) {
    Buffer<float> depth = solid.depth.clone();
    std::size_t at = 0;
    for (std::int64_t k = 0; k < solid.grid.size[2]; ++k) {
      for (std::int64_t j = 0; j < solid.grid.size[1]; ++j) {
        const auto row = voxels.row(j, k);
        for (std::int64_t i = 0; i < solid.grid.size[0]; ++i, ++at) {
          const bool is_in = (row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1U) != 0;
          depth[at] = is_in ? std::max(depth[at], std::numeric_limits<float>::min()) : 0;
        }
      }
    }
    return depth;
  }

  /// Whether a voxel is simple among those around, and none of its cells is needed.
  [[nodiscard]] bool may_go(std::uint32_t voxel, const Place& at, Neighbourhood around, SimpleCache& simple) const {
    if (attached_.contain(at[0], at[1], at[2])) return attached_.may_go(voxel, around);
    return simple.is_simple(around) && !is_needed(at, around);
  }

  /// Whether some cell of a voxel has importance, and is no other voxel's of those around.
  [[nodiscard]] bool is_needed(const Place& at, Neighbourhood around) const {
    const std::size_t node = lattice_.node(at[0], at[1], at[2]);
    for (unsigned corner = 0; corner < 8; ++corner) {
      const std::size_t n =
          node + (corner & 1U) + (corner >> 1U & 1U) * lattice_.stride(1) + (corner >> 2U) * lattice_.stride(2);
      unsigned cells = importance_.cells_at(n) & towards_[corner];
      for (; cells != 0; cells &= cells - 1) {
        if ((sharers_of[corner][static_cast<unsigned>(std::countr_zero(cells))] & around) == 0) return true;
      }
    }
    return false;
  }

  static constexpr std::array<std::uint8_t, 8> towards_{cells_towards(0), cells_towards(1), cells_towards(2),
                                                        cells_towards(3), cells_towards(4), cells_towards(5),
                                                        cells_towards(6), cells_towards(7)};

  const AttachedVoxels& attached_;
  const VoxelSet& voxels_;
  Place size_;
  const CellLattice& lattice_;
  const Importance& importance_;
  const Context& context_;
  Buffer<float> own_depth_;
  std::span<const float> depth_;
  DepthOrder order_;
  double step_;
  VoxelSet is_in_line_;
  VoxelSet kept_;
};

}  // namespace

VoxelSet thin_voxels(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
                     const Importance& importance, const Context& context) {
  return Thinner(solid, attached, lattice, importance, context).thin();
}

}  // namespace blum::detail
