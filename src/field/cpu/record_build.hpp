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

/// Collects the domains of a cluster's sites, each given by the unit rays that span it. Bounds them all, or their
/// opposites, by one cone.
class DirectionCone {
 public:
  /// @param rays  rays that span one site's domain; an empty span stands for a domain that may be anything.
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

  /// Returns the double cone. Every direction of every domain makes an angle with the axis, or with its opposite, whose
  /// cosine is at least `cosine`. A spherical cap of less than a half-sphere is convex, so a domain whose rays lie in
  /// one cap lies in it. Rays on both sides of the axis would not suffice.
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

/// Facts of each triangle, found when its record is built, and read for the records of its edges.
struct FaceFacts {
  /// Unit normals; zero for triangles too flat for a reliable one.
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

/// Cluster while it is built.
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

/// Sites are stored along a curve, but the arrays they are built from are in the mesh's order. So the data that a
/// cluster reads are prefetched. Far ahead, these are the data that name others; nearer, the data named.
enum class Ahead : std::uint8_t { far, near };
inline void prefetch(const void* at) {
  __builtin_prefetch(at);
}
void prefetch_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead);
void prefetch_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                    Ahead ahead);
void prefetch_faces(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead);

/// Build the records of up to sixteen sites and add them to their cluster. A site that can own no node leaves its
/// record dead. Faces come before edges, which read the facts that faces write.
void build_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                    ClusterBuild& cluster);
void build_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster);
void build_faces(const RecordInput& input, FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster);
void build_slivers(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                   ClusterBuild& cluster);

}  // namespace blum::cpu
