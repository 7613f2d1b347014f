// Blum: the topology of sets of voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// Returns the Betti numbers of the union of the closed voxels of a set: components, tunnels and voids. Components are
/// 26-connected. Voids are the 6-connected components of the rest of space, without the outer one.
/// Cost: O(words + runs of voxels along x); about 5 ms for 256^3.
/// @throws Cancelled.
[[nodiscard]] std::array<std::int64_t, 3> betti_numbers(const VoxelSet& voxels, const Context& context = {});

/// Adds the voxels of the voids to the set. Voids are the 6-connected components of the rest of space, without the
/// outer one. The outer one contains all that lies beyond the box. @return  the number of voids. @throws Cancelled.
std::int64_t fill_voids(VoxelSet& voxels, const Context& context = {});

/// Returns vertices - edges + squares - cubes of the union of the closed voxels. Each cell counts once.
[[nodiscard]] std::int64_t euler_characteristic(const VoxelSet& voxels, const Context& context = {});

/// Betti numbers and Euler characteristic of a set of voxels.
struct VoxelTopology {
  std::array<std::int64_t, 3> betti{};  ///< components (26-connected), tunnels, voids
  std::int64_t euler_characteristic = 0;
};
template <>
struct Description<VoxelTopology> {
  static constexpr std::string_view name = "VoxelTopology";
  static constexpr std::string_view doc = "Topology of a union of closed voxels";
  static constexpr std::tuple members{
      Member{"betti", &VoxelTopology::betti, "", "components (26-connected), tunnels, voids"},
      Member{"euler_characteristic", &VoxelTopology::euler_characteristic, "",
             "vertices - edges + squares - cubes, each counted once"}};
};
[[nodiscard]] VoxelTopology voxel_topology(const VoxelSet& voxels, const Context& context = {});

/// 27 voxels around a voxel, as bits. Voxel (i + x, j + y, k + z) is bit 13 + x + 3 y + 9 z, for x, y, z in -1, 0, 1.
using Neighbourhood = std::uint32_t;

[[nodiscard]] Neighbourhood neighbourhood(const VoxelSet& voxels, std::int64_t i, std::int64_t j, std::int64_t k);

/// Returns true if adding or removing the middle voxel preserves the topology (Bertrand, Malandain 1994). That holds if
/// the other voxels of the set around it form one 26-component. The voxels outside the set must form one 6-component
/// around it, connected through at most two steps. The bit of the middle voxel is ignored.
[[nodiscard]] bool is_simple(Neighbourhood around);

}  // namespace blum
