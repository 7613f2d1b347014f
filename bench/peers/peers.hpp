// Blum: other programs that benchmarks compare Blum with; each is optional. SPDX-License-Identifier: Apache-2.0
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

/// What a peer computed: a field of triangles whose distance is NaN at nodes that were left out, the part of the nodes
/// that were not, and the seconds of one run, of which those for queries are scaled to all nodes.
struct PeerField {
  Field field;
  double fraction = 1;
  Times times;
  double build_wall = 0;  ///< of them, for building the hierarchy
  double build_cpu = 0;
};

/// About how many nodes a peer's queries are asked for (BLUM_BENCH_PEER_NODES, "all" for every node; default 2,200,000,
/// which is all of 128^3). Above, it works on bundles of rows spread evenly over the grid.
[[nodiscard]] double peer_nodes();

/// Every peer function returns nullopt where the peer was not installed when the benchmarks were configured.

/// Embree 3 point queries. Each starts from the distance to the triangle that the node before it found.
[[nodiscard]] std::optional<PeerField> embree_field(const MeshView& mesh, const GridSpec& grid, const Context& context);

/// Distances of scattered points by Embree 3 point queries, threaded; of runs in turn the median.
struct PeerPoints {
  std::vector<float> distance;
  Times times;  ///< without building
};
/// @param is_hinted  whether each search starts from the triangle that the point before found, within ranges of 512.
[[nodiscard]] std::optional<PeerPoints> embree_points(const MeshView& mesh, std::span<const Vec3d> points,
                                                      const Context& context, bool is_hinted = true);

/// CGAL's AABB tree over Simple_cartesian<double>, with the point that the node before found as the hint.
[[nodiscard]] std::optional<PeerField> cgal_field(const MeshView& mesh, const GridSpec& grid, const Context& context);

/// One fast winding number query (Barill 2018, accuracy 2) per node; -1 where it is above 1/2, else 1. The
/// hierarchical sum is Blum's own, asked once per node, which is what libigl does with its.
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
/// Renormalisation is off: it costs time and precision.
[[nodiscard]] std::optional<PeerBand> openvdb_band(const MeshView& mesh, const GridSpec& grid, double width,
                                                   bool is_signed, const Context& context);

/// CGAL's bounded_error_symmetric_Hausdorff_distance, one thread (its parallel version needs METIS).
struct PeerHausdorff {
  double distance = 0;
  Times times;  ///< with building
};
[[nodiscard]] std::optional<PeerHausdorff> cgal_hausdorff(const MeshView& a, const MeshView& b, double tolerance);

}  // namespace blum::bench
