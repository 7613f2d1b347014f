// Blum: optional other programs that benchmarks compare with Blum. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "support/measure.hpp"

namespace blum::bench {

/// Result of a peer: a field with closest triangles, the computed fraction of the nodes, and the seconds of one run.
/// The distance is NaN at other nodes. Times of queries are scaled to all nodes.
struct PeerField {
  Field field;
  double fraction = 1;
  Times times;
  double build_wall = 0;  ///< the part of times for building the hierarchy
  double build_cpu = 0;
};

/// The approximate number of nodes that a peer computes: BLUM_BENCH_PEER_NODES, "all" for every node. The default is
/// 2,200,000, which covers 128^3. On larger grids, a peer computes bundles of rows, spread evenly over the grid.
[[nodiscard]] double peer_nodes();

/// Functions that return an optional return nullopt if the peer was not installed when the benchmarks were configured.

/// Embree 3 point queries. Each starts from the distance to the triangle found for the previous node.
[[nodiscard]] std::optional<PeerField> embree_field(const MeshView& mesh, const GridSpec& grid, const Context& context);

/// Distances of scattered points by Embree 3 point queries, with several threads. Times are medians.
struct PeerPoints {
  std::vector<float> distance;
  Times times;  ///< without the build
};
/// @param is_hinted  true if each search starts from the triangle found for the previous point, in ranges of 512.
[[nodiscard]] std::optional<PeerPoints> embree_points(const MeshView& mesh, std::span<const Vec3d> points,
                                                      const Context& context, bool is_hinted = true);

/// CGAL's AABB tree over Simple_cartesian<double>. The hint is the point found for the previous node.
[[nodiscard]] std::optional<PeerField> cgal_field(const MeshView& mesh, const GridSpec& grid, const Context& context);

/// One fast winding number query (Barill 2018, accuracy 2) per node: -1 if it is above 1/2, else 1. The hierarchical
/// sum is Blum's own, evaluated once per node. libigl uses its sum in the same way.
[[nodiscard]] PeerField winding_queries(const MeshView& mesh, const GridSpec& grid, const Context& context);

struct BandSample {
  std::array<std::int64_t, 3> node{};
  double distance = 0;
};
struct PeerBand {
  Times times;
  double active_nodes = 0;
  std::vector<BandSample> samples;  ///< spread over the active nodes
};
/// OpenVDB's meshToVolume with the grid of closest polygons, `width` voxels on both sides. It writes a sparse grid.
/// Renormalisation is off because it costs time and precision.
[[nodiscard]] std::optional<PeerBand> openvdb_band(const MeshView& mesh, const GridSpec& grid, double width,
                                                   bool is_signed, const Context& context);

/// CGAL's bounded_error_symmetric_Hausdorff_distance, one thread (its parallel version needs METIS).
struct PeerHausdorff {
  double distance = 0;
  Times times;  ///< including the build
};
[[nodiscard]] std::optional<PeerHausdorff> cgal_hausdorff(const MeshView& a, const MeshView& b, double tolerance);

}  // namespace blum::bench
