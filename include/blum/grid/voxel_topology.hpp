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

/// Betti numbers of the union of the closed voxels of a set: components (26-connected), tunnels, and voids (6-connected
/// components of the rest of space, the outer one left out).
/// Cost: O(words + runs of voxels along x); about 5 ms for 256^3.
/// @throws Cancelled.
[[nodiscard]] std::array<std::int64_t, 3> betti_numbers(const VoxelSet& voxels, const Context& context = {});

/// Adds the voids: the 6-connected components of the rest of space other than the outer one, which holds what lies
/// beyond the box. @return how many there were. @throws Cancelled.
std::int64_t fill_voids(VoxelSet& voxels, const Context& context = {});

/// Vertices - edges + squares - cubes of the union of the closed voxels, each cell once.
[[nodiscard]] std::int64_t euler_characteristic(const VoxelSet& voxels, const Context& context = {});

/// Both.
struct VoxelTopology {
  std::array<std::int64_t, 3> betti{};  ///< components (26-connected), tunnels, voids
  std::int64_t euler_characteristic = 0;
};
template <>
struct Description<VoxelTopology> {
  static constexpr std::string_view name = "VoxelTopology";
  static constexpr std::string_view doc = "The topology of the union of closed voxels";
  static constexpr std::tuple members{
      Member{"betti", &VoxelTopology::betti, "", "components (26-connected), tunnels, voids"},
      Member{"euler_characteristic", &VoxelTopology::euler_characteristic, "",
             "vertices - edges + squares - cubes, each once"}};
};
[[nodiscard]] VoxelTopology voxel_topology(const VoxelSet& voxels, const Context& context = {});

/// The 27 voxels around one, as bits: voxel (i + x, j + y, k + z) is bit 13 + x + 3 y + 9 z, for x, y, z in -1, 0, 1.
using Neighbourhood = std::uint32_t;

[[nodiscard]] Neighbourhood neighbourhood(const VoxelSet& voxels, std::int64_t i, std::int64_t j, std::int64_t k);

/// Whether adding or removing the voxel in the middle leaves the topology as it is (Bertrand, Malandain 1994: one
/// 26-component of other voxels around it, and one 6-component of the voxels that are not, through at most two steps).
/// The bit of the voxel itself is not looked at.
[[nodiscard]] bool is_simple(Neighbourhood around);

}  // namespace blum
