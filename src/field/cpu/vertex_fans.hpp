// Blum: the cones of sixteen vertices at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "field/cpu/reach.hpp"

namespace blum::cpu {

/// Sixteen vertices with three to `most` edges each; a lane without a vertex has none.
struct alignas(64) VertexFans {
  static constexpr std::size_t most = 8;
  /// From the vertex along its edges, of any length but zero. Those beyond a lane's count repeat its first.
  std::array<SixteenVectors, most> along{};
  std::array<std::uint32_t, cluster_size> count{};
};

/// The cones {w : w . e <= 0 for all edge directions e} of the sixteen.
struct alignas(64) VertexFanCones {
  static constexpr std::size_t most_rays = 8;
  /// `along`, made unit vectors.
  std::array<SixteenVectors, VertexFans::most> direction;
  /// Bit k: direction k bounds the cone.
  std::array<std::uint32_t, cluster_size> facets;
  /// Extreme rays found (those beyond most_rays are not kept), and the rays.
  std::array<std::uint32_t, cluster_size> ray_count;
  std::array<std::array<Vec3f, most_rays>, cluster_size> rays;
  /// Bit per lane: two directions are nearly parallel, so a ray may be missing.
  std::uint32_t is_uncertain = 0;
};

/// What kernels::VertexCone::find_facets does for one vertex, for sixteen, up to rounding.
void find_fan_cones(const VertexFans& fans, VertexFanCones& out);

}  // namespace blum::cpu
