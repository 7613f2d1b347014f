#include "medial_axis/thin_voxels.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/voxel_border.hpp"

namespace blum {
namespace {

using Place = std::array<std::int64_t, 3>;

constexpr std::uint32_t middle = 1U << 13U;
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

/// Remembers which neighbourhoods are simple: few of all that there are turn up.
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
  static constexpr std::uint32_t known = 1U << 31U;  // tells a key from an empty slot
  std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(std::size_t{1} << bits, 0);
};

/// A voxel in line, shallowest first; among equally deep ones, the first.
struct Waiting {
  float depth;
  std::uint32_t voxel;
  [[nodiscard]] friend bool operator>(const Waiting& a, const Waiting& b) {
    return a.depth != b.depth ? a.depth > b.depth : a.voxel > b.voxel;
  }
};

/// Voxels by rising depth, where those put in line are never before the one last taken.
class Line {
 public:
  explicit Line(double step) : per_step_(1 / step) {}
  void push(const Waiting& voxel) {
    const auto step = static_cast<std::size_t>(std::clamp(voxel.depth * per_step_, 0.0, 1e6));
    if (step >= steps_.size()) steps_.resize(step + 1);
    steps_[step].push_back(voxel);
    if (step == first_ && is_heap_) std::push_heap(steps_[step].begin(), steps_[step].end(), std::greater<>());
  }
  /// Moves the next voxel to `next`; false where there is none.
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
        step_(std::min({solid.grid.spacing.x, solid.grid.spacing.y, solid.grid.spacing.z}) / 16) {
    for (std::size_t n = 0; n < 27; ++n) {
      const auto at = static_cast<std::int64_t>(n);
      offset_[n] = (at / 9 - 1) * size_[0] * size_[1] + (at / 3 % 3 - 1) * size_[0] + at % 3 - 1;
    }
  }

  VoxelSet thin() {
    Line line(step_);
    is_in_line_ = VoxelSet(size_);
    kept_ = VoxelSet(size_);
    for (const std::uint32_t voxel : stuck()) {
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
      const Neighbourhood around = present_around(next.voxel, at);
      if (may_go(next.voxel, at, around, simple)) continue;
      kept_.insert(at[0], at[1], at[2]);
      for (std::size_t n = 0; n < 27; ++n) {
        const auto other = static_cast<std::uint32_t>(next.voxel + offset_[n]);
        if (!is_deeper(other, next.voxel)) continue;
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

  [[nodiscard]] bool is_deeper(std::uint32_t a, std::uint32_t b) const {
    return depth_[a] != depth_[b] ? depth_[a] > depth_[b] : a > b && depth_[a] > 0;
  }

  /// The voxels around one that are there at its turn: those not looked at yet, and those that stay.
  [[nodiscard]] Neighbourhood present_around(std::uint32_t voxel, const Place& at) const {
    Neighbourhood around = neighbourhood(kept_, at[0], at[1], at[2]);
    for (std::size_t n = 0; n < 27; ++n) {
      if (n == 13) continue;
      const auto other = static_cast<std::uint32_t>(voxel + offset_[n]);
      around |= static_cast<Neighbourhood>(is_deeper(other, voxel)) << n;
    }
    return around & ~middle;
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

  /// The voxels that stay, or whose turn tells, if all shallower ones go.
  std::vector<std::uint32_t> stuck() const {
    const auto layers = static_cast<std::size_t>(size_[2]);
    std::vector<std::vector<std::uint32_t>> found(layers);
    parallel_for(context_, layers, 1, "thinning", [&](const WorkRange& range) {
      SimpleCache simple;
      std::vector<Neighbourhood> deeper(static_cast<std::size_t>(size_[0]));
      for (std::size_t k = range.begin; k < range.end; ++k) {
        if (k == 0 || k + 1 == layers) continue;
        for (std::int64_t j = 1; j + 1 < size_[1]; ++j)
          add_stuck(j, static_cast<std::int64_t>(k), simple, deeper, found[k]);
      }
    });
    std::vector<std::uint32_t> all;
    for (const auto& layer : found) all.insert(all.end(), layer.begin(), layer.end());
    return all;
  }

  void add_stuck(std::int64_t j, std::int64_t k, SimpleCache& simple, std::vector<Neighbourhood>& deeper,
                 std::vector<std::uint32_t>& found) const {
    const auto row = voxels_.row(j, k);
    if (std::all_of(row.begin(), row.end(), [](std::uint64_t word) { return word == 0; })) return;
    const auto first = static_cast<std::size_t>((k * size_[1] + j) * size_[0]);
    find_deeper(first, deeper);
    for (std::size_t w = 0; w < row.size(); ++w) {
      for (std::uint64_t rest = row[w]; rest != 0; rest &= rest - 1) {
        const std::size_t i = 64 * w + static_cast<std::size_t>(std::countr_zero(rest));
        const Neighbourhood around = deeper[i];
        const auto voxel = static_cast<std::uint32_t>(first + i);
        if (!may_go(voxel, {static_cast<std::int64_t>(i), j, k}, around, simple)) found.push_back(voxel);
      }
    }
  }

  /// For the voxels of a row that starts at `first`, which ones around are deeper.
  void find_deeper(std::size_t first, std::vector<Neighbourhood>& deeper) const {
    const std::size_t length = deeper.size();
    const float* own = depth_.data() + first;
    std::fill(deeper.begin(), deeper.end(), 0);
    Neighbourhood* out = deeper.data();
    for (unsigned n = 0; n < 27; ++n) {
      if (n == 13) continue;
      const float* other = own + offset_[n];
      const Neighbourhood bit = 1U << n;
      // Linear indices rise with n, so that later ones win among equals.
      if (n < 13) {
        for (std::size_t i = 1; i + 1 < length; ++i) out[i] |= other[i] > own[i] ? bit : 0;
      } else {
        for (std::size_t i = 1; i + 1 < length; ++i) out[i] |= other[i] >= own[i] ? bit : 0;
      }
    }
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
  double step_;
  std::array<std::int64_t, 27> offset_{};
  VoxelSet is_in_line_;
  VoxelSet kept_;
};

}  // namespace

VoxelSet thin_voxels(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
                     const Importance& importance, const Context& context) {
  return Thinner(solid, attached, lattice, importance, context).thin();
}

}  // namespace blum
