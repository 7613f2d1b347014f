#include "certificate/voxel_betti.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <span>
#include <utility>

#include "blum/core/union_find.hpp"

namespace blum::verifier {
namespace {

/// Returns the index of the first bit of a row, at or after i, that equals `wanted`; `end` if there is none.
std::int64_t next_in(std::span<const std::uint64_t> row, std::int64_t i, std::int64_t end, bool wanted = true) {
  for (auto w = static_cast<std::size_t>(i / 64); w < row.size(); ++w) {
    std::uint64_t bits = wanted ? row[w] : ~row[w];
    if (w == static_cast<std::size_t>(i / 64)) bits &= ~std::uint64_t{0} << (i % 64);
    if (bits != 0) return std::min(end, static_cast<std::int64_t>(64 * w) + std::countr_zero(bits));
  }
  return end;
}

/// Voxels `begin` to `end` - 1 of row (j, k).
struct Stretch {
  std::int64_t j = 0, k = 0, begin = 0, end = 0;
};

/// The remaining voxels of a set, from which stretches are removed.
class Flood {
 public:
  Flood(VoxelSet voxels, const Context& context) : rest_(std::move(voxels)), context_(context) {}

  /// Removes all voxels. Calls found(i, j, k) for the first voxel of each part that is connected through faces.
  template <class Found>
  void take_all(const Found& found) {
    for (std::int64_t k = 0; k < rest_.size()[2]; ++k) {
      for (std::int64_t j = 0; j < rest_.size()[1]; ++j) {
        for (std::int64_t i = next(j, k, 0); i < rest_.size()[0]; i = next(j, k, i)) {
          found(i, j, k);
          flood_from(taken_at(i, j, k));
        }
      }
    }
  }

 private:
  void flood_from(const Stretch& first) {
    std::vector<Stretch> stack{first};
    while (!stack.empty()) {
      if (++steps_ % 16384 == 0) throw_if_cancelled(context_);
      const Stretch at = stack.back();
      stack.pop_back();
      for (const auto& [dj, dk] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        take_row(at.j + dj, at.k + dk, at.begin, at.end, stack);
      }
    }
  }

  /// Removes all stretches of a row that overlap a range, and adds them to `stack`.
  void take_row(std::int64_t j, std::int64_t k, std::int64_t begin, std::int64_t end, std::vector<Stretch>& stack) {
    if (j < 0 || k < 0 || j >= rest_.size()[1] || k >= rest_.size()[2]) return;
    for (std::int64_t i = next(j, k, begin); i < end; i = next(j, k, i)) stack.push_back(taken_at(i, j, k));
  }

  /// Removes and returns the stretch around a voxel.
  Stretch taken_at(std::int64_t i, std::int64_t j, std::int64_t k) {
    Stretch all{j, k, i, i};
    while (rest_.contains(all.begin - 1, j, k)) rest_.erase(--all.begin, j, k);
    while (rest_.contains(all.end, j, k)) rest_.erase(all.end++, j, k);
    return all;
  }

  /// Returns the first voxel of a row at or after i; the end of the row if there is none.
  [[nodiscard]] std::int64_t next(std::int64_t j, std::int64_t k, std::int64_t i) const {
    return next_in(std::as_const(rest_).row(j, k), i, rest_.size()[0]);
  }

  VoxelSet rest_;
  const Context& context_;
  std::size_t steps_ = 0;
};

/// Returns word w, of 64 voxels, of a row; 0 if the row does not exist.
std::uint64_t word_of(const VoxelSet& voxels, std::int64_t j, std::int64_t k, std::size_t w) {
  if (j < 0 || k < 0 || j >= voxels.size()[1] || k >= voxels.size()[2]) return 0;
  return voxels.row(j, k)[w];
}

/// Returns all voxels outside a set, in the box of the set enlarged by one voxel on each side.
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
        rest.row(j, k)[w] = ~(bits << 1U | carry) & in_box;  // shifted by one voxel along x
        carry = bits >> 63U;
      }
    }
  }
  return rest;
}

/// Returns eight times the contribution of a lattice vertex to the Euler number, for each set of the eight voxels
/// around it. Bits 0, 1 and 2 of a voxel's number are its sides along x, y and z. Each cell's contribution is shared
/// equally among its vertices.
std::array<std::int8_t, 256> shares_of_vertices() {
  std::array<std::int8_t, 256> shares{};
  for (unsigned around = 1; around < 256; ++around) {
    int share = 0;
    for (unsigned flat = 0; flat < 8; ++flat) {  // the axes along which a cell has no length
      for (unsigned side = 0; side < 8; ++side) {
        if ((side & flat) != 0) continue;
        bool is_there = false;
        for (unsigned voxel = 0; voxel < 8; ++voxel) {
          is_there = is_there || ((voxel & ~flat) == side && (around >> voxel & 1U) != 0);
        }
        const int size = 1 << std::popcount(flat);  // eighths: a voxel has 8 vertices, a square 4
        if (is_there) share += std::popcount(flat) % 2 == 1 ? size : -size;
      }
    }
    shares[around] = static_cast<std::int8_t>(share);
  }
  return shares;
}

/// Finds the voxels around the vertices of a lattice row from four rows of voxels, each also shifted by one voxel.
class VertexRow {
 public:
  VertexRow(const VoxelSet& voxels, std::int64_t j, std::int64_t k) : voxels_(voxels), j_(j), k_(k) {}

  /// Calls use(i, around) for the vertices whose eight voxels are neither all in the set nor all outside it.
  template <class Use>
  void for_each(const Use& use) {
    std::array<std::uint64_t, 4> carry{};
    for (std::size_t w = 0; w < voxels_.words_per_row(); ++w) {
      std::array<std::uint64_t, 8> bits{};
      std::uint64_t any = 0;
      std::uint64_t all = ~std::uint64_t{0};
      for (std::size_t r = 0; r < 4; ++r) {
        const auto row = static_cast<std::int64_t>(r);
        const std::uint64_t word = word_of(voxels_, j_ - 1 + row % 2, k_ - 1 + row / 2, w);
        bits[2 * r + 1] = word;
        bits[2 * r] = word << 1U | carry[r];
        carry[r] = word >> 63U;
        any |= bits[2 * r] | bits[2 * r + 1];
        all &= bits[2 * r] & bits[2 * r + 1];
      }
      for (std::uint64_t mixed = any & ~all; mixed != 0; mixed &= mixed - 1) {
        const int at = std::countr_zero(mixed);
        unsigned around = 0;
        for (unsigned voxel = 0; voxel < 8; ++voxel) around |= static_cast<unsigned>(bits[voxel] >> at & 1U) << voxel;
        use(static_cast<std::int64_t>(64 * w) + at, around);
      }
    }
  }

 private:
  const VoxelSet& voxels_;
  std::int64_t j_, k_;
};

/// Returns the Euler number of each body. All voxels of the set around a vertex belong to the same body.
std::vector<std::int64_t> euler_numbers(const VoxelSet& voxels, const VoxelBodies& bodies, const Context& context) {
  const std::array<std::int8_t, 256> shares = shares_of_vertices();
  std::vector<std::int64_t> eighths(bodies.count(), 0);
  for (std::int64_t k = 0; k <= voxels.size()[2]; ++k) {
    throw_if_cancelled(context);
    for (std::int64_t j = 0; j <= voxels.size()[1]; ++j) {
      VertexRow(voxels, j, k).for_each([&](std::int64_t i, unsigned around) {
        if (shares[around] == 0) return;
        const int voxel = std::countr_zero(around);
        eighths[bodies.of(i - 1 + (voxel & 1), j - 1 + (voxel >> 1 & 1), k - 1 + (voxel >> 2))] += shares[around];
      });
    }
  }
  for (std::int64_t& number : eighths) number /= 8;
  return eighths;
}

}  // namespace

VoxelBodies::VoxelBodies(const VoxelSet& voxels, const Context& context) : size_(voxels.size()) {
  find_runs(voxels, context);
  detail::UnionFind joined(runs_.size());
  for (std::int64_t k = 0; k < size_[2]; ++k) {
    throw_if_cancelled(context);
    for (std::int64_t j = 0; j < size_[1]; ++j) {
      for (const auto& [dj, dk] : {std::array{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
        if (j + dj < 0 || j + dj >= size_[1] || k + dk < 0) continue;
        std::size_t b = first_[row(j + dj, k + dk)];
        const std::size_t end = first_[row(j + dj, k + dk) + 1];
        for (std::size_t a = first_[row(j, k)]; a < first_[row(j, k) + 1]; ++a) {
          while (b < end && runs_[b].end < runs_[a].begin) ++b;
          for (std::size_t c = b; c < end && runs_[c].begin <= runs_[a].end; ++c) {
            joined.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(c));
          }
        }
      }
    }
  }
  for (std::int64_t k = 0; k < size_[2]; ++k) {
    for (std::int64_t j = 0; j < size_[1]; ++j) {
      for (std::size_t r = first_[row(j, k)]; r < first_[row(j, k) + 1]; ++r) {
        Run& run = runs_[r];
        const std::uint32_t root = joined.find(static_cast<std::uint32_t>(r));
        run.body = root == r ? count() : runs_[root].body;
        if (root == r) extents_.push_back({{run.begin, j, k}, {run.begin, j, k}});
        Extent& extent = extents_[run.body];
        const std::array<std::int64_t, 3> low{run.begin, j, k};
        const std::array<std::int64_t, 3> high{run.end - 1, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          extent.lower[axis] = std::min(extent.lower[axis], low[axis]);
          extent.upper[axis] = std::max(extent.upper[axis], high[axis]);
        }
      }
    }
  }
}

void VoxelBodies::find_runs(const VoxelSet& voxels, const Context& context) {
  for (std::int64_t k = 0; k < size_[2]; ++k) {
    throw_if_cancelled(context);
    for (std::int64_t j = 0; j < size_[1]; ++j) {
      first_.push_back(runs_.size());
      const auto bits = voxels.row(j, k);
      for (std::int64_t i = next_in(bits, 0, size_[0]); i < size_[0];) {
        const std::int64_t end = next_in(bits, i, size_[0], false);
        runs_.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(end), 0});
        i = next_in(bits, end, size_[0]);
      }
    }
  }
  first_.push_back(runs_.size());
}

std::uint32_t VoxelBodies::of(std::int64_t i, std::int64_t j, std::int64_t k) const {
  const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(first_[row(j, k)]);
  const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(first_[row(j, k) + 1]);
  return std::prev(std::upper_bound(begin, end, i, [](std::int64_t at, const Run& run) { return at < run.begin; }))
      ->body;
}

std::vector<BettiNumbers> voxel_betti_numbers(const VoxelSet& voxels, const VoxelBodies& bodies,
                                              const Context& context) {
  std::vector<BettiNumbers> betti(bodies.count(), {1, 0, 0});
  bool is_outside = true;
  Flood(surroundings(voxels, context), context).take_all([&](std::int64_t i, std::int64_t j, std::int64_t k) {
    // The first part found is the outside. The voxel below the first voxel of a void belongs to the body around it.
    if (!is_outside) ++betti[bodies.of(i - 1, j - 1, k - 2)][2];
    is_outside = false;
  });
  const std::vector<std::int64_t> euler = euler_numbers(voxels, bodies, context);
  for (std::size_t b = 0; b < betti.size(); ++b) betti[b][1] = betti[b][0] + betti[b][2] - euler[b];
  return betti;
}

BettiNumbers voxel_betti_numbers(const VoxelSet& voxels, const Context& context) {
  BettiNumbers sum{};
  for (const BettiNumbers& body : voxel_betti_numbers(voxels, VoxelBodies(voxels, context), context)) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += body[k];
  }
  return sum;
}

}  // namespace blum::verifier
