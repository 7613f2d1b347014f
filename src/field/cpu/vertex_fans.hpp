// Blum: cones of sixteen vertices at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "field/cpu/reach.hpp"

namespace blum::cpu {

/// Sixteen vertices with three to `most` edges each. A lane without a vertex has no edges.
struct alignas(64) VertexFans {
  static constexpr std::size_t most = 8;
  /// Vectors from the vertex along its edges, of any non-zero length. Entries beyond a lane's count repeat its first
  /// vector.
  std::array<SixteenVectors, most> along{};
  std::array<std::uint32_t, cluster_size> count{};
};

/// Cones {w : w . e <= 0 for all edge directions e}, one for each of the sixteen vertices.
struct alignas(64) VertexFanCones {
  static constexpr std::size_t most_rays = 8;
  /// Normalised vectors of `along`.
  std::array<SixteenVectors, VertexFans::most> direction;
  /// Per vertex: bit k is set if direction k bounds the cone.
  std::array<std::uint32_t, cluster_size> facets;
  /// Per vertex: number of extreme rays found, and the first most_rays of them.
  std::array<std::uint32_t, cluster_size> ray_count;
  std::array<std::array<Vec3f, most_rays>, cluster_size> rays;
  /// One bit per vertex, set if two directions are nearly parallel, so that a ray may be missing.
  std::uint32_t is_uncertain = 0;
};

/// Computes for sixteen vertices what kernels::VertexCone::find_facets computes for one. Results agree up to rounding.
void find_fan_cones(const VertexFans& fans, VertexFanCones& out);

}  // namespace blum::cpu
