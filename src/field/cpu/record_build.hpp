// Blum: builds the records of a cluster of sites. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "field/cpu/reach.hpp"
#include "field/cpu/site_records.hpp"
#include "field/kernels/site_shapes.hpp"

namespace blum::cpu {

/// Finds one cone that bounds the domains of all sites of a cluster. Each domain is given by the unit rays that span
/// it. A domain may also lie in the opposite cone.
class DirectionCone {
 public:
  /// @param rays  unit rays that span one site's domain. If empty, the domain is unbounded.
  void add(std::span<const Vec3f> rays) {
    if (rays.empty() || count_ + rays.size() > rays_.size()) is_bounded_ = false;
    if (!is_bounded_) return;
    for (const Vec3f& ray : rays) {
      axis_ += dot(axis_, ray) < 0 ? -ray : ray;
      domain_[count_] = domains_;
      rays_[count_++] = ray;
    }
    ++domains_;
  }

  struct Result {
    Vec3f axis{1, 0, 0};
    float cosine = 0;
    float sine = 1;
  };

  /// Returns the double cone. For every direction of every domain, the angle with the axis or its opposite has a cosine
  /// of at least `cosine`. A spherical cap smaller than a half-sphere is convex. So if all rays of a domain lie in one
  /// cap, the whole domain does. If rays of one domain lie on both sides of the axis, there is no such cap and the cone
  /// is not bounded.
  [[nodiscard]] Result finish() const {
    constexpr float margin = 2e-3F;
    const float size = length(axis_);
    if (!is_bounded_ || count_ == 0 || !(size > 1e-3F)) return {};
    const Vec3f axis = axis_ / size;
    float cosine = 1;
    bool is_positive = true;
    for (std::size_t k = 0; k < count_; ++k) {
      const float along = dot(axis, rays_[k]);
      if (k == 0 || domain_[k] != domain_[k - 1]) is_positive = along > 0;
      if (is_positive != (along > 0)) return {};
      cosine = std::min(cosine, std::abs(along));
    }
    cosine -= margin;
    if (!(cosine > 0.05F)) return {};
    return {axis, cosine, std::sqrt(1 - cosine * cosine)};
  }

 private:
  std::array<Vec3f, 8 * cluster_size> rays_{};
  std::array<std::size_t, 8 * cluster_size> domain_{};
  std::size_t count_ = 0;
  std::size_t domains_ = 0;
  Vec3f axis_{};
  bool is_bounded_ = true;
};

using kernels::negligible_length;
using kernels::store;
using kernels::unit;

/// Data of each triangle, written when its record is built. The data are read when the records of the triangle's edges
/// are built.
struct FaceFacts {
  /// Unit normals; zero for triangles too flat for a reliable normal.
  std::vector<Vec3d> normals;
  std::vector<std::uint8_t> is_sliver;
};

/// Input that the builders of all kinds share.
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

/// Cluster under construction.
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

/// Distance of a prefetch. Sites are stored along a curve, but the arrays they are built from are in the mesh's order.
/// So data are prefetched before their cluster is built: index arrays first (far), later the data at those indices
/// (near).
enum class Ahead : std::uint8_t { far, near };
inline void prefetch(const void* at) {
  __builtin_prefetch(at);
}
void prefetch_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead);
void prefetch_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                    Ahead ahead);
void prefetch_faces(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead);

/// The following functions build the records of up to sixteen sites and add them to a cluster. If a site cannot be
/// closest to any node, its record stays dead. Faces must be built before edges, which read the FaceFacts.
void build_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                    ClusterBuild& cluster);
void build_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster);
void build_faces(const RecordInput& input, FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster);
void build_slivers(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                   ClusterBuild& cluster);

}  // namespace blum::cpu
