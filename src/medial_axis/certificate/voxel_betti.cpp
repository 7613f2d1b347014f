#include "medial_axis/certificate/voxel_betti.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace blum::verifier {
namespace {

/// Voxels begin to end - 1 of a row.
struct Run {
  std::int64_t j = 0, k = 0, begin = 0, end = 0;
};

/// What is left of a set, taken away run by run.
class Flood {
 public:
  Flood(VoxelSet voxels, const Context& context) : rest_(std::move(voxels)), context_(context) {}

  /// Takes everything away, and counts its components. @param over_corners  else over faces.
  std::int64_t count_components(bool over_corners) {
    std::int64_t count = 0;
    for (std::int64_t k = 0; k < rest_.size()[2]; ++k) {
      for (std::int64_t j = 0; j < rest_.size()[1]; ++j) {
        for (std::int64_t i = next(j, k, 0); i < rest_.size()[0]; i = next(j, k, i)) {
          ++count;
          flood_from(taken_at(i, j, k), over_corners);
        }
      }
    }
    return count;
  }

 private:
  void flood_from(const Run& first, bool over_corners) {
    std::vector<Run> stack{first};
    while (!stack.empty()) {
      if (++steps_ % 16384 == 0) throw_if_cancelled(context_);
      const Run run = stack.back();
      stack.pop_back();
      for (std::int64_t dk = -1; dk <= 1; ++dk) {
        for (std::int64_t dj = -1; dj <= 1; ++dj) {
          if (!over_corners && dj != 0 && dk != 0) continue;
          const std::int64_t reach = over_corners ? 1 : 0;
          take_row(run.j + dj, run.k + dk, run.begin - reach, run.end + reach, stack);
        }
      }
    }
  }

  /// Takes the runs of a row that reach into a range.
  void take_row(std::int64_t j, std::int64_t k, std::int64_t begin, std::int64_t end, std::vector<Run>& stack) {
    if (j < 0 || k < 0 || j >= rest_.size()[1] || k >= rest_.size()[2]) return;
    begin = std::max<std::int64_t>(begin, 0);
    end = std::min(end, rest_.size()[0]);
    for (std::int64_t i = next(j, k, begin); i < end; i = next(j, k, i)) stack.push_back(taken_at(i, j, k));
  }

  /// Takes the run around a voxel.
  Run taken_at(std::int64_t i, std::int64_t j, std::int64_t k) {
    Run run{j, k, i, i};
    while (rest_.contains(run.begin - 1, j, k)) rest_.erase(--run.begin, j, k);
    while (rest_.contains(run.end, j, k)) rest_.erase(run.end++, j, k);
    return run;
  }

  /// The first voxel of a row from i on; the row's end where there is none.
  [[nodiscard]] std::int64_t next(std::int64_t j, std::int64_t k, std::int64_t i) const {
    const auto row = std::as_const(rest_).row(j, k);
    for (auto w = static_cast<std::size_t>(i / 64); w < row.size(); ++w) {
      std::uint64_t bits = row[w];
      if (w == static_cast<std::size_t>(i / 64)) bits &= ~std::uint64_t{0} << (i % 64);
      if (bits != 0) return static_cast<std::int64_t>(64 * w) + std::countr_zero(bits);
    }
    return rest_.size()[0];
  }

  VoxelSet rest_;
  const Context& context_;
  std::size_t steps_ = 0;
};

/// The voxels of a row, none where there is no such row.
std::uint64_t word_of(const VoxelSet& voxels, std::int64_t j, std::int64_t k, std::size_t w) {
  if (j < 0 || k < 0 || j >= voxels.size()[1] || k >= voxels.size()[2]) return 0;
  return voxels.row(j, k)[w];
}

/// All voxels that are not in a set, in its box and one voxel beyond it.
VoxelSet surroundings(const VoxelSet& voxels, const Context& context) {
  const auto& size = voxels.size();
  VoxelSet rest({size[0] + 2, size[1] + 2, size[2] + 2});
  for (std::int64_t k = 0; k < rest.size()[2]; ++k) {
    throw_if_cancelled(context);
    for (std::int64_t j = 0; j < rest.size()[1]; ++j) {
      std::int64_t left = rest.size()[0];
      std::uint64_t carry = 0;
      for (std::size_t w = 0; left > 0; ++w, left -= 64) {
        const std::uint64_t bits = w < voxels.words_per_row() ? word_of(voxels, j - 1, k - 1, w) : 0;
        const std::uint64_t in_box = left < 64 ? (std::uint64_t{1} << left) - 1 : ~std::uint64_t{0};
        rest.row(j, k)[w] = ~(bits << 1U | carry) & in_box;  // one voxel further along x
        carry = bits >> 63U;
      }
    }
  }
  return rest;
}

/// Cells of one kind: those that have the length of a voxel along some axes, and none along the others. A cell is there
/// where any voxel around it is.
std::int64_t count_cells(const VoxelSet& voxels, bool long_x, bool long_y, bool long_z, const Context& context) {
  std::int64_t count = 0;
  for (std::int64_t k = 0; k <= voxels.size()[2]; ++k) {
    throw_if_cancelled(context);
    for (std::int64_t j = 0; j <= voxels.size()[1]; ++j) {
      std::uint64_t carry = 0;
      for (std::size_t w = 0; w < voxels.words_per_row(); ++w) {
        std::uint64_t bits = word_of(voxels, j, k, w);
        if (!long_y) bits |= word_of(voxels, j - 1, k, w);
        if (!long_z) bits |= word_of(voxels, j, k - 1, w);
        if (!long_y && !long_z) bits |= word_of(voxels, j - 1, k - 1, w);
        count += std::popcount(long_x ? bits : bits | bits << 1U | carry);
        carry = bits >> 63U;
      }
    }
  }
  return count;
}

}  // namespace

BettiNumbers voxel_betti_numbers(const VoxelSet& voxels, const Context& context) {
  const std::int64_t components = Flood(voxels, context).count_components(true);
  const std::int64_t voids = Flood(surroundings(voxels, context), context).count_components(false) - 1;
  std::int64_t euler = 0;
  for (unsigned axes = 0; axes < 8; ++axes) {
    const std::int64_t cells = count_cells(voxels, (axes & 1U) != 0, (axes & 2U) != 0, (axes & 4U) != 0, context);
    euler += std::popcount(axes) % 2 == 0 ? cells : -cells;
  }
  return {components, components + voids - euler, voids};
}

}  // namespace blum::verifier
