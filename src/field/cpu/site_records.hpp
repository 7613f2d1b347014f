// Blum: records of sites for the kernels, and hierarchies of their boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/kernels/record.hpp"

namespace blum::cpu {

using kernels::dead_record;
using kernels::EdgeColumns;
using kernels::FaceColumns;
using kernels::far_away;
using kernels::plane_slack;
using kernels::Record;
using kernels::SliverColumns;
using kernels::VertexColumns;

enum Kind : std::uint8_t { vertex_kind, edge_kind, face_kind, sliver_kind };
inline constexpr std::size_t kind_count = 4;

/// Number of records per cluster. Clusters are the leaves of the tree that is used to cull sites for a tile.
inline constexpr std::size_t cluster_size = 16;

/// Boxes as a structure of arrays, in the normalised frame, rounded outwards. An empty box is placed far away.
struct BoxArrays {
  std::array<Buffer<float>, 3> lower;
  std::array<Buffer<float>, 3> upper;
  Buffer<float> reach;  ///< sites in the box cannot be closest to any point further away than this
  std::size_t count = 0;

  void resize(std::size_t new_count);
};

/// Double cone of each cluster, about an axis. The cone contains every direction, from any site of the cluster, in
/// which this site can be closest. If the sine is one and the cosine zero, the cone is the whole space.
struct ConeArrays {
  std::array<Buffer<float>, 3> axis;
  Buffer<float> cosine;
  Buffer<float> sine;

  void resize(std::size_t count);
};

/// Records of one kind in a spatially coherent order, and a box around each cluster of consecutive records. A site that
/// cannot be closest to any node keeps its position, as a record with the id `dead_record`.
struct RecordSet {
  Buffer<Record> records;
  std::size_t count = 0;
  ConeArrays cluster_cones;
  BoxArrays cluster_boxes;  ///< `reach` is the largest reach of each cluster's sites
};

/// All records of a mesh.
struct SiteRecords {
  std::array<RecordSet, kind_count> kinds;
};

/// Builds the records of every site that can be closest to a node. A vertex whose domain is only the vertex itself gets
/// no record. Edges and faces of negligible extent get no record, either; their borders represent them. Reuses the
/// memory of `out`.
/// @param positions  of all vertices, in the normalised frame.
/// Cost: O(sites), threaded. Method: docs/theory/fields.md.
void build_site_records(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        std::span<const Vec3d> positions, const SiteOrder& order, const Context& context,
                        SiteRecords& out);

/// 16-ary tree of boxes above the clusters of one kind. Each box of levels[0] bounds 16 clusters, each box of a higher
/// level 16 boxes. The last level has at most 16 boxes.
struct ClusterTree {
  std::vector<BoxArrays> levels;
};

struct ClusterForest {
  std::array<ClusterTree, kind_count> trees;
};

/// Builds the trees for all kinds. Cost: O(clusters). Reuses the memory of `out`.
void build_cluster_forest(const SiteRecords& sites, const Context& context, ClusterForest& out);

}  // namespace blum::cpu
