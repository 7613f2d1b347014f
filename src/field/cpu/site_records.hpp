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

/// Records per cluster. Clusters are the leaves of the tree that tiles are culled with.
inline constexpr std::size_t cluster_size = 16;

/// Boxes as structure of arrays, in the normalised frame, rounded outwards. An empty box lies far away.
struct BoxArrays {
  std::array<Buffer<float>, 3> lower;
  std::array<Buffer<float>, 3> upper;
  Buffer<float> reach;  ///< the content of the box affects nothing further away than this
  std::size_t count = 0;

  void resize(std::size_t new_count);
};

/// Per cluster: the double cone about an axis that holds every direction in which its sites can be closest. A sine of
/// one and a cosine of zero make it the whole space.
struct ConeArrays {
  std::array<Buffer<float>, 3> axis;
  Buffer<float> cosine;
  Buffer<float> sine;

  void resize(std::size_t count);
};

/// Records of one kind in a spatially coherent order, and a box around each cluster of consecutive records. Sites that
/// can own no node keep their place, as records with id `dead_record`.
struct RecordSet {
  Buffer<Record> records;
  std::size_t count = 0;
  ConeArrays cluster_cones;
  BoxArrays cluster_boxes;  ///< with the largest reach of each cluster's sites
};

/// All records of a mesh.
struct SiteRecords {
  std::array<RecordSet, kind_count> kinds;
};

/// Builds the records of every site that can own a node. Vertices whose domain is only themselves get none. Nor do
/// edges or faces of negligible extent, for which their borders stand. Reuses the memory of `out`.
/// @param positions  of all vertices, in the normalised frame.
/// Cost: O(sites), threaded. Method: docs/theory/fields.md.
void build_site_records(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        std::span<const Vec3d> positions, const SiteOrder& order, const Context& context,
                        SiteRecords& out);

/// Sixteen-ary tree of boxes above the clusters of one kind. Boxes of levels[0] bound 16 clusters each; the last level
/// has at most 16 boxes.
struct ClusterTree {
  std::vector<BoxArrays> levels;
};

struct ClusterForest {
  std::array<ClusterTree, kind_count> trees;
};

/// Builds the trees above all clusters. Cost: O(clusters). Reuses the memory of `out`.
void build_cluster_forest(const SiteRecords& sites, const Context& context, ClusterForest& out);

}  // namespace blum::cpu
