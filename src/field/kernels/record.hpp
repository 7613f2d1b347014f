// Blum: records of sites for the kernels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "field/kernels/host_device.hpp"

namespace blum::kernels {

/// One site with its domain, in one cache line. All lengths are in the normalised frame. The meaning of the columns
/// depends on the kind (see the structs below).
struct alignas(64) Record {
  std::array<float, 15> column{};
  std::uint32_t id = 0;  ///< SiteId of the site
};
static_assert(sizeof(Record) == 64);

/// Vertex p: its position, and up to four directions e along edges. The domain consists of the points q with (q - p) .
/// e <= 0 for all of them. Unused directions are 0.
struct VertexColumns {
  static constexpr int position = 0;   // 3 columns
  static constexpr int direction = 3;  // 4 x 3 columns
};

/// Edge: midpoint m, unit direction t, half-length, and an orthonormal frame (t, b, n = t x b). `b` leads from the edge
/// into its first face. That face bounds the domain by (q - m) . b <= first_limit (a huge limit without a face). The
/// second face bounds it by second_b * [(q - m) . b] + second_n * [(q - m) . n] <= 0 (both factors 0 without a second
/// face). `side` is not 0 if the orientations of both faces agree. It is +1 if n points out of a closed solid there, -1
/// if into it; see edge_side(). Beyond the distance `reach` from the site, some surface point is always closer.
struct EdgeColumns {
  static constexpr int midpoint = 0;  // 3 columns
  static constexpr int tangent = 3;   // 3 columns
  static constexpr int half_length = 6;
  static constexpr int binormal = 7;  // 3 columns
  static constexpr int second_b = 10;
  static constexpr int second_n = 11;
  static constexpr int first_limit = 12;
  static constexpr int side = 13;
  static constexpr int reach = 14;
};

/// Face: anchor, unit normal, and the negated gradients of the barycentric coordinates u and v of the two other
/// corners. The anchor is the corner opposite the longest edge, so that flat triangles do not amplify errors. Points of
/// the face satisfy -u < 0, -v < 0, u + v < 1.
struct FaceColumns {
  static constexpr int anchor = 0;   // 3 columns
  static constexpr int normal = 3;   // 3 columns
  static constexpr int minus_u = 6;  // 3 columns
  static constexpr int minus_v = 9;  // 3 columns
  static constexpr int reach_above = 12;
  static constexpr int reach_below = 13;
  static constexpr int is_sliver = 14;  ///< if not 0, the columns are SliverColumns (device only)
};

/// Sliver: a face too flat for barycentric coordinates in float32. Stores its three corners. A sliver is evaluated in
/// double, as a triangle with its border.
struct SliverColumns {
  static constexpr int corners = 0;  // 3 x 3 columns
};

inline constexpr std::uint32_t dead_record = 0xffffffff;

/// Distance that is larger than all others: content this far away has no effect.
inline constexpr float far_away = 1e18F;

/// Bound on the rounding of normalised positions and of affine functions of them. The planes of vertices and of the
/// sides of edges are moved outwards by it, which is harmless. So no node falls between two domains.
inline constexpr float plane_slack = 1e-6F;

BLUM_HD inline Vec3f vec_at(const Record& record, int column) {
  const auto at = static_cast<std::size_t>(column);
  return {record.column[at], record.column[at + 1], record.column[at + 2]};
}
BLUM_HD inline float value_at(const Record& record, int column) {
  return record.column[static_cast<std::size_t>(column)];
}
BLUM_HD inline void store(Record& record, int column, const Vec3f& v) {
  const auto at = static_cast<std::size_t>(column);
  record.column[at] = v.x;
  record.column[at + 1] = v.y;
  record.column[at + 2] = v.z;
}
BLUM_HD inline void store(Record& record, int column, const Vec3d& v) {
  store(record, column, to_float(v));
}
BLUM_HD inline void store(Record& record, int column, double x) {
  record.column[static_cast<std::size_t>(column)] = static_cast<float>(x);
}

}  // namespace blum::kernels
