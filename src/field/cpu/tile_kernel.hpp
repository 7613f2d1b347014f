// Blum: computes one tile of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "field/cpu/site_records.hpp"
#include "field/field_request.hpp"

namespace blum::cpu {

/// Input of all tiles of a field, and the output of their results. It is the same for all of them.
struct FieldJob {
  const SiteRecords* sites = nullptr;
  const ClusterForest* forest = nullptr;
  FieldRequest request;
  Vec3d first_node;                                     ///< normalised
  Vec3d spacing;                                        ///< normalised
  float band = std::numeric_limits<float>::infinity();  ///< half-width, normalised
  float to_world = 1;                                   ///< Mesh units per normalised unit, a power of two.
  /// Unit pseudonormals of all vertices; empty if the field gets no sign from them.
  std::vector<Vec3f> vertex_sides;
  /// True to write past the caches: for fields that do not fit them.
  bool is_streamed = false;
  /// A tile that sees a request to stop leaves the rest of its nodes unwritten.
  std::stop_token cancel;

  [[nodiscard]] bool has_sides() const { return !vertex_sides.empty(); }
  /// Returns the distance of nodes beyond the band.
  [[nodiscard]] float band_distance() const { return static_cast<float>(request.band); }
};

/// Box of nodes: the first one, and the number along each axis.
struct NodeBox {
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> count{};
};

/// Memory that a worker keeps from tile to tile, and the nodes that the tile kernel leaves to exact queries.
class TileScratch {
 public:
  TileScratch();
  TileScratch(TileScratch&&) noexcept;
  TileScratch& operator=(TileScratch&&) noexcept;
  ~TileScratch();

  struct Impl;
  Impl& impl() { return *impl_; }

  /// Linear indices of nodes that no site claimed, or whose side is too close to call in float32.
  std::vector<std::size_t> unsettled;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Returns the number of nodes along a side of the largest tiles. One call of compute_tile should get such a tile.
[[nodiscard]] int tile_size(const std::array<std::int64_t, 3>& grid_size);

/// Computes distance, site and (with sides) sign of every node of a box. The box's sides are at most 64, and its first
/// node lies at multiples of 64 or 32.
void compute_tile(const FieldJob& job, const NodeBox& tile, TileScratch& scratch);

/// Returns the instruction sets with which this machine can run the kernel, best first, by Highway's names (for example
/// "AVX2").
[[nodiscard]] std::vector<std::string> simd_targets();
/// Makes the kernel use one of simd_targets() from now on. An empty name restores the best one. For tests and
/// benchmarks.
void use_simd_target(std::string_view name);

}  // namespace blum::cpu
