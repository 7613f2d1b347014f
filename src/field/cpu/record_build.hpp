// Blum: how the records of a cluster of sites are built. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "field/cpu/direction_cone.hpp"
#include "field/cpu/reach.hpp"
#include "field/cpu/site_records.hpp"
#include "field/kernels/site_shapes.hpp"

namespace blum::cpu {

using kernels::negligible_length;
using kernels::store;
using kernels::unit;

/// What is learned of each triangle when its record is built, and read when those of its edges are.
struct FaceFacts {
  /// Unit normals; zero for triangles too flat to trust one.
  std::vector<Vec3d> normals;
  std::vector<std::uint8_t> is_sliver;
};

/// What the builders of all kinds share.
struct RecordInput {
  const MeshView& mesh;
  const SiteTable& sites;
  const Adjacency& adjacency;
  std::span<const Vec3d> positions;

  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t triangle) const {
    const Triangle& t = mesh.triangles[triangle];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }
};

/// A cluster while it is built.
struct ClusterBuild {
  Box3 box;
  ReachInput reach;
  DirectionCone directions;

  void set_corner(std::size_t lane, std::size_t which, const Vec3d& p) { set(reach.corner[which], lane, p); }
  void set_direction(std::size_t lane, std::size_t which, const Vec3d& w) { set(reach.direction[which], lane, w); }

 private:
  static void set(SixteenVectors& v, std::size_t lane, const Vec3d& value) {
    for (std::size_t axis = 0; axis < 3; ++axis) v[axis][lane] = static_cast<float>(value[axis]);
  }
};

/// Sites are stored along a curve, but the arrays they are built from are in the mesh's order: what a cluster reads is
/// asked for in time. Far ahead, that is what names other things; nearer, the things named.
enum class Ahead : std::uint8_t { far, near };
inline void prefetch(const void* at) {
  __builtin_prefetch(at);
}
void prefetch_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead);
void prefetch_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                    Ahead ahead);
void prefetch_faces(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead);

/// Build the records of up to sixteen sites and add them to their cluster; a site that can own no node leaves its
/// record dead. Faces come before edges, which read what faces write of themselves.
void build_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                    ClusterBuild& cluster);
void build_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster);
void build_faces(const RecordInput& input, FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster);
void build_slivers(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                   ClusterBuild& cluster);

}  // namespace blum::cpu
