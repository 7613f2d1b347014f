// Blum: components, tunnels and voids of voxels, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::verifier {

/// The bodies of a union of closed voxels. Voxels that share a corner belong to one body. Bodies are numbered in the
/// order of their first voxels.
class VoxelBodies {
 public:
  /// @throws Cancelled.
  VoxelBodies(const VoxelSet& voxels, const Context& context);

  /// The range of voxels that contains a body; `lower` and `upper` are included.
  struct Extent {
    std::array<std::int64_t, 3> lower, upper;
  };

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(extents_.size()); }
  [[nodiscard]] const Extent& extent(std::uint32_t body) const { return extents_[body]; }
  /// Returns the body of a voxel, which must be in the set.
  [[nodiscard]] std::uint32_t of(std::int64_t i, std::int64_t j, std::int64_t k) const;

 private:
  /// Voxels `begin` to `end` - 1 of a row.
  struct Run {
    std::int32_t begin = 0, end = 0;
    std::uint32_t body = 0;
  };

  void find_runs(const VoxelSet& voxels, const Context& context);
  [[nodiscard]] std::size_t row(std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>(k * size_[1] + j);
  }

  std::array<std::int64_t, 3> size_{};
  std::vector<std::size_t> first_;  ///< for each row: index of its first run; then the number of runs
  std::vector<Run> runs_;
  std::vector<Extent> extents_;
};

/// Returns the Betti numbers of each body. The number of tunnels follows from the Euler number. A void is found by
/// flooding through faces, and belongs to the body around it.
/// @throws Cancelled. Memory: two more voxel sets.
[[nodiscard]] std::vector<BettiNumbers> voxel_betti_numbers(const VoxelSet& voxels, const VoxelBodies& bodies,
                                                            const Context& context);
/// Returns the Betti numbers of all bodies together.
[[nodiscard]] BettiNumbers voxel_betti_numbers(const VoxelSet& voxels, const Context& context);

}  // namespace blum::verifier
