// Blum: sites as the kernels see them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "field/cpu/adjacency.hpp"

namespace blum::cpu {

/// One site with its domain, in one cache line; all lengths in the normalised frame. What the columns mean depends on
/// the kind (see the structs below).
struct alignas(64) Record {
  std::array<float, 15> column{};
  std::uint32_t id = 0;  ///< SiteId
};
static_assert(sizeof(Record) == 64);

/// Vertex: its position and up to four directions e of the edges that bound its domain, (q - p) . e <= 0. Unused: 0.
struct VertexColumns {
  static constexpr int position = 0;   // 3
  static constexpr int direction = 3;  // 4 x 3
};

/// Edge: midpoint m, unit direction t, half-length, and an orthonormal frame (t, b, n = t x b). b leaves the edge
/// into its first face, whose half-space is (q - m) . b <= first_limit (+huge where there is no face); the second
/// face's is second_b * [(q - m) . b] + second_n * [(q - m) . n] <= 0 (both 0 where there is none). side is +-1
/// where both faces agree that their side of n points out of (or into) a closed solid, see edge_side(); else 0. The
/// site is beaten everywhere further than reach from it.
struct EdgeColumns {
  static constexpr int midpoint = 0;  // 3
  static constexpr int tangent = 3;   // 3
  static constexpr int half_length = 6;
  static constexpr int binormal = 7;  // 3
  static constexpr int second_b = 10;
  static constexpr int second_n = 11;
  static constexpr int first_limit = 12;
  static constexpr int side = 13;
  static constexpr int reach = 14;
};

/// Face: anchor (the corner opposite the longest edge, so that slivers do not amplify errors), unit normal, and the
/// negated gradients of the barycentric coordinates u and v of the two other corners: the face is -u, -v < 0, u + v
/// < 1.
struct FaceColumns {
  static constexpr int anchor = 0;   // 3
  static constexpr int normal = 3;   // 3
  static constexpr int minus_u = 6;  // 3
  static constexpr int minus_v = 9;  // 3
  static constexpr int reach_above = 12;
  static constexpr int reach_below = 13;
};

/// A face too flat for float32 barycentrics: its three corners. Evaluated as a closed triangle in double.
struct SliverColumns {
  static constexpr int corners = 0;  // 3 x 3
};

enum Kind : std::uint8_t { vertex_kind, edge_kind, face_kind, sliver_kind };
inline constexpr std::size_t kind_count = 4;

/// Records per cluster: the leaves of the tree that tiles are culled with.
inline constexpr std::size_t cluster_size = 16;

/// Boxes as structure of arrays, in the normalised frame, rounded outwards; a box around nothing lies far away.
struct BoxArrays {
  std::array<Buffer<float>, 3> lower;
  std::array<Buffer<float>, 3> upper;
  Buffer<float> reach;  ///< what lies in the box matters to nothing further away than this
  std::size_t count = 0;

  void resize(std::size_t new_count);
};
inline constexpr float far_away = 1e18F;

/// For each cluster, the double cone about an axis that holds every direction in which its sites can be closest. A sine
/// of one and a cosine of zero make it the whole space.
struct ConeArrays {
  std::array<Buffer<float>, 3> axis;
  Buffer<float> cosine;
  Buffer<float> sine;

  void resize(std::size_t count);
};

/// The records of one kind in a spatially coherent order, and a box around each cluster of consecutive records. Sites
/// that can own no node keep their place, as records with id `dead_record`.
struct RecordSet {
  Buffer<Record> records;
  std::size_t count = 0;
  ConeArrays cluster_cones;
  BoxArrays cluster_boxes;  ///< with the largest reach of each cluster's sites
};
inline constexpr std::uint32_t dead_record = 0xffffffff;

/// All records of a mesh.
struct SiteRecords {
  std::array<RecordSet, kind_count> kinds;
};

/// Rounding of normalised positions and of affine functions of them stays below this; planes are widened by it where
/// widening is harmless (vertices, sides of edges), so that no node falls between two domains.
inline constexpr float plane_slack = 1e-6F;

/// Builds the records of every site that can own a node: no vertices whose domain is only themselves, no edges or faces
/// of negligible extent (their borders stand for them). Reuses the memory of `out`.
/// @param positions  of all vertices, in the normalised frame.
/// Cost: O(sites), threaded. Method: docs/theory/fields.md.
void build_site_records(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        std::span<const Vec3d> positions, const SiteOrder& order, const Context& context,
                        SiteRecords& out);

}  // namespace blum::cpu
