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

/// Input of all tiles of a field, and the memory for their results. All tiles share one job.
struct FieldJob {
  const SiteRecords* sites = nullptr;
  const ClusterForest* forest = nullptr;
  FieldRequest request;
  Vec3d first_node;                                     ///< normalised
  Vec3d spacing;                                        ///< normalised
  float band = std::numeric_limits<float>::infinity();  ///< half-width, normalised
  float to_world = 1;                                   ///< Mesh units per normalised unit, a power of two.
  /// Unit pseudonormals of all vertices. Empty if the tiles do not compute signs.
  std::vector<Vec3f> vertex_sides;
  /// True to write results past the caches, for fields that do not fit in them.
  bool is_streamed = false;
  /// After a stop request, a tile leaves its remaining nodes unwritten.
  std::stop_token cancel;

  [[nodiscard]] bool has_sides() const { return !vertex_sides.empty(); }
  /// Returns the distance of nodes beyond the band.
  [[nodiscard]] float band_distance() const { return static_cast<float>(request.band); }
};

/// Box of nodes: its first node, and the number of nodes along each axis.
struct NodeBox {
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> count{};
};

/// Memory that a worker keeps from tile to tile, and the nodes left to exact queries.
class TileScratch {
 public:
  TileScratch();
  TileScratch(TileScratch&&) noexcept;
  TileScratch& operator=(TileScratch&&) noexcept;
  ~TileScratch();

  struct Impl;
  Impl& impl() { return *impl_; }

  /// Linear indices of nodes that no site claimed, or whose side cannot be decided in float32.
  std::vector<std::size_t> unsettled;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Returns the side, in nodes, of the tiles into which a grid is divided. compute_tile() should be called for tiles of
/// this size.
[[nodiscard]] int tile_size(const std::array<std::int64_t, 3>& grid_size);

/// Computes the distance and site of every node of a box, and its sign if job.has_sides(). The box has at most 64 nodes
/// per side. The indices of its first node must be multiples of 64 or 32 (the tile size).
void compute_tile(const FieldJob& job, const NodeBox& tile, TileScratch& scratch);

/// Returns the instruction sets of this machine that can run the kernel, best first. The names are Highway's (for
/// example "AVX2").
[[nodiscard]] std::vector<std::string> simd_targets();
/// Selects one of simd_targets() for all later calls of the kernel. An empty name restores the best one. For tests and
/// benchmarks.
void use_simd_target(std::string_view name);

}  // namespace blum::cpu
