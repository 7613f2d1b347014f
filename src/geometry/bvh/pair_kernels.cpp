// Loops over the lanes of blocks of oriented boxes and triangles, for pairs of blocks or triangles. Compiled like
// lane_kernels.cpp.
#include <algorithm>
#include <cmath>
#include <cstddef>

#ifdef BLUM_HIGHWAY
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)  // would not make loops of doubles faster
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/bvh/pair_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#else
#define HWY_BEFORE_NAMESPACE() static_assert(true)
#define HWY_AFTER_NAMESPACE() static_assert(true)
#define HWY_NAMESPACE baseline
#define HWY_ONCE 1
#endif

#include "geometry/bvh/oriented_block.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::HWY_NAMESPACE {
namespace {

/// Returns the squared gap along a vector.
/// @param gap     gap, multiplied by the vector's length; not negative.
/// @param square  squared length of the vector.
inline double squared_share(double gap, double square) {
  // Evaluated in this order, because fourth powers of small lengths would lose digits.
  return gap / std::max(square, 1e-280) * gap;
}

/// Gaps of two boxes along several axes.
struct AxisGaps {
  double squared = 0;    ///< sum of the squared gaps; overlaps count as 0
  double most = -1e300;  ///< the largest gap, or minus the smallest overlap

  /// Adds the gap between the intervals [-half, half] and [center - reach, center + reach].
  void add(double center, double half, double reach) {
    const double gap = std::abs(center) - half - reach;
    most = std::max(most, gap);
    squared += std::max(gap, 0.0) * std::max(gap, 0.0);
  }
};

void squared_box_gaps(const OrientedBlock& block, const OrientedBox& box, double (&out)[lanes]) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = box.center.x - block.center[0][i];
    const double y = box.center.y - block.center[1][i];
    const double z = box.center.z - block.center[2][i];
    double reach[3] = {0, 0, 0};  // half-extents of the block's box along the axes of `box`
    double on_way = 0;            // sum of both half-extents along the line through both centers
    AxisGaps here;                // along the axes of the block's box
    for (std::size_t k = 0; k < 3; ++k) {
      const double ax = block.axes[k][0][i], ay = block.axes[k][1][i], az = block.axes[k][2][i];
      double other = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        const double cosine = std::abs(ax * box.axes[j].x + ay * box.axes[j].y + az * box.axes[j].z);
        other += cosine * box.half[j];
        reach[j] += cosine * block.half[k][i];
      }
      const double at = ax * x + ay * y + az * z;
      here.add(at, block.half[k][i], other);
      on_way += std::abs(at) * block.half[k][i];
    }
    AxisGaps there;
    for (std::size_t j = 0; j < 3; ++j) {
      const double at = box.axes[j].x * x + box.axes[j].y * y + box.axes[j].z * z;
      there.add(at, box.half[j], reach[j]);
      on_way += std::abs(at) * box.half[j];
    }
    const double square = x * x + y * y + z * z;
    const double between = std::max(square - on_way, 0.0);
    const double gap = std::max(std::max(here.squared, there.squared), squared_share(between, square));
    const double overlap = std::min(std::max(here.most, there.most), 0.0);
    out[i] = gap > 0 ? gap : -overlap * overlap;
  }
}

inline double least(double a, double b, double c) {
  return std::min(std::min(a, b), c);
}
inline double most(double a, double b, double c) {
  return std::max(std::max(a, b), c);
}
inline double gap_between(double low, double high, double other_low, double other_high) {
  return std::max(std::max(other_low - high, low - other_high), 0.0);
}

/// Adds the squared gaps along one axis between [low, high] and eight intervals. Each of these spans the coordinates a,
/// b and c of its lane.
inline void add_axis_gap(const double (&a)[lanes], const double (&b)[lanes], const double (&c)[lanes], double low,
                         double high, double (&sum)[lanes]) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const double gap = gap_between(least(a[i], b[i], c[i]), most(a[i], b[i], c[i]), low, high);
    sum[i] += gap * gap;
  }
}

void squared_triangle_gaps(const FlatTriangleBlock& block, const FlatTriangle& triangle, double (&out)[lanes]) {
  const Vec3d p = triangle.corners[0];
  const Vec3d q = triangle.corners[1];
  const Vec3d r = triangle.corners[2];
  const Vec3d n = triangle.normal;
  alignas(64) double boxes[lanes] = {};
  for (std::size_t x = 0; x < 3; ++x) {
    add_axis_gap(block.corner[0][x], block.corner[1][x], block.corner[2][x], least(p[x], q[x], r[x]),
                 most(p[x], q[x], r[x]), boxes);
  }
  const double height = n.x * p.x + n.y * p.y + n.z * p.z;
  const Vec3d middle{p.x + q.x + r.x, p.y + q.y + r.y, p.z + q.z + r.z};
  for (std::size_t i = 0; i < lanes; ++i) {
    const Vec3d a{block.corner[0][0][i], block.corner[0][1][i], block.corner[0][2][i]};
    const Vec3d b{block.corner[1][0][i], block.corner[1][1][i], block.corner[1][2][i]};
    const Vec3d c{block.corner[2][0][i], block.corner[2][1][i], block.corner[2][2][i]};
    const Vec3d m{block.normal[0][i], block.normal[1][i], block.normal[2][i]};
    const Vec3d way{middle.x - (a.x + b.x + c.x), middle.y - (a.y + b.y + c.y), middle.z - (a.z + b.z + c.z)};
    const double at_a = dot(n, a), at_b = dot(n, b), at_c = dot(n, c);
    const double from_other = gap_between(least(at_a, at_b, at_c), most(at_a, at_b, at_c), height, height);
    const double level = dot(m, a), at_p = dot(m, p), at_q = dot(m, q), at_r = dot(m, r);
    const double from_here = gap_between(least(at_p, at_q, at_r), most(at_p, at_q, at_r), level, level);
    const double between =
        std::max(least(dot(way, p), dot(way, q), dot(way, r)) - most(dot(way, a), dot(way, b), dot(way, c)), 0.0);
    const double on_way = squared_share(between, dot(way, way));
    out[i] = std::max(std::max(boxes[i], on_way), std::max(from_other * from_other, from_here * from_here));
  }
}

void squared_triangle_box_gaps(const FlatTriangleBlock& block, const OrientedBox& box, double (&out)[lanes]) {
  alignas(64) double sum[lanes] = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d axis = box.axes[k];
    const double middle = dot(axis, box.center);
    const double low = middle - box.half[k];
    const double high = middle + box.half[k];
    for (std::size_t i = 0; i < lanes; ++i) {
      const double a = axis.x * block.corner[0][0][i] + axis.y * block.corner[0][1][i] + axis.z * block.corner[0][2][i];
      const double b = axis.x * block.corner[1][0][i] + axis.y * block.corner[1][1][i] + axis.z * block.corner[1][2][i];
      const double c = axis.x * block.corner[2][0][i] + axis.y * block.corner[2][1][i] + axis.z * block.corner[2][2][i];
      const double gap = gap_between(least(a, b, c), most(a, b, c), low, high);
      sum[i] += gap * gap;
    }
  }
  for (std::size_t i = 0; i < lanes; ++i) out[i] = sum[i];
}

/// A triangle gets a normal only if (height / longest side)^2 exceeds this, with the height over the longest side.
/// Normals of flatter triangles are so inaccurate that their own corners would have different heights.
constexpr double least_flatness = 1e-4;
/// Squared lengths below this have lost digits.
constexpr double smallest_square = 1e-280;

void set_normals(FlatTriangleBlock& block, BlockShape& out) {
  alignas(64) double area[3][lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    const Vec3d a{block.corner[0][0][i], block.corner[0][1][i], block.corner[0][2][i]};
    const Vec3d b{block.corner[1][0][i], block.corner[1][1][i], block.corner[1][2][i]};
    const Vec3d c{block.corner[2][0][i], block.corner[2][1][i], block.corner[2][2][i]};
    const Vec3d u = b - a;
    const Vec3d v = c - a;
    const Vec3d w = c - b;
    const Vec3d n = cross(u, v);
    const double longest = most(dot(u, u), dot(v, v), dot(w, w));
    const double square = dot(n, n);
    const double least_square = std::max(least_flatness * longest * longest, smallest_square);
    const double inverse = square > least_square ? 1 / std::sqrt(square) : 0;
    area[0][i] = n.x;
    area[1][i] = n.y;
    area[2][i] = n.z;
    block.normal[0][i] = n.x * inverse;
    block.normal[1][i] = n.y * inverse;
    block.normal[2][i] = n.z * inverse;
  }
  // Soups have no consistent orientation. So normals are flipped to the side of the first normal.
  const Vec3d first{area[0][0], area[1][0], area[2][0]};
  alignas(64) double turned[3][lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    const double way = first.x * area[0][i] + first.y * area[1][i] + first.z * area[2][i] < 0 ? -1.0 : 1.0;
    for (std::size_t x = 0; x < 3; ++x) turned[x][i] = way * area[x][i];
  }
  for (std::size_t x = 0; x < 3; ++x) {
    const double(&t)[lanes] = turned[x];
    out.normal[x] = ((t[0] + t[1]) + (t[2] + t[3])) + ((t[4] + t[5]) + (t[6] + t[7]));
    alignas(64) double sum[lanes];
    for (std::size_t i = 0; i < lanes; ++i) {
      sum[i] = block.corner[0][x][i] + block.corner[1][x][i] + block.corner[2][x][i];
    }
    out.along[x] = ((sum[4] + sum[5]) + (sum[6] + sum[7])) - ((sum[0] + sum[1]) + (sum[2] + sum[3]));
  }
}

/// Computes the smallest lower end and the largest upper end of eight intervals.
inline void ends(const double (&low)[lanes], const double (&high)[lanes], double& least_of, double& most_of) {
  least_of = std::min(std::min(std::min(low[0], low[1]), std::min(low[2], low[3])),
                      std::min(std::min(low[4], low[5]), std::min(low[6], low[7])));
  most_of = std::max(std::max(std::max(high[0], high[1]), std::max(high[2], high[3])),
                     std::max(std::max(high[4], high[5]), std::max(high[6], high[7])));
}

void extent_along(const FlatTriangleBlock& block, const Vec3d& axis, double& low, double& high) {
  alignas(64) double least_of[lanes], most_of[lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    const double a = axis.x * block.corner[0][0][i] + axis.y * block.corner[0][1][i] + axis.z * block.corner[0][2][i];
    const double b = axis.x * block.corner[1][0][i] + axis.y * block.corner[1][1][i] + axis.z * block.corner[1][2][i];
    const double c = axis.x * block.corner[2][0][i] + axis.y * block.corner[2][1][i] + axis.z * block.corner[2][2][i];
    least_of[i] = least(a, b, c);
    most_of[i] = most(a, b, c);
  }
  ends(least_of, most_of, low, high);
}

void extent_along_axes(const FlatTriangleBlock& block, Box3& out) {
  alignas(64) double least_of[lanes], most_of[lanes];
  for (std::size_t x = 0; x < 3; ++x) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const double a = block.corner[0][x][i], b = block.corner[1][x][i], c = block.corner[2][x][i];
      least_of[i] = least(a, b, c);
      most_of[i] = most(a, b, c);
    }
    ends(least_of, most_of, out.lower[x], out.upper[x]);
  }
}

}  // namespace
}  // namespace blum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "geometry/bvh/kernel_tables.hpp"

namespace blum {
namespace {

BLUM_KERNEL(squared_box_gaps);
BLUM_KERNEL(squared_triangle_gaps);
BLUM_KERNEL(squared_triangle_box_gaps);
BLUM_KERNEL(set_normals);
BLUM_KERNEL(extent_along);
BLUM_KERNEL(extent_along_axes);

}  // namespace

void squared_gaps(const OrientedBlock& block, const OrientedBox& box, double (&out)[lanes]) {
  best_squared_box_gaps(block, box, out);
}

void squared_gaps(const FlatTriangleBlock& block, const FlatTriangle& triangle, double (&out)[lanes]) {
  best_squared_triangle_gaps(block, triangle, out);
}

void squared_gaps(const FlatTriangleBlock& block, const OrientedBox& box, double (&out)[lanes]) {
  best_squared_triangle_box_gaps(block, box, out);
}

void set_normals(FlatTriangleBlock& block, BlockShape& out) {
  best_set_normals(block, out);
}

void extent_along_axes(const FlatTriangleBlock& block, Box3& out) {
  best_extent_along_axes(block, out);
}

void extent_along(const FlatTriangleBlock& block, const Vec3d& axis, double& low, double& high) {
  best_extent_along(block, axis, low, high);
}

}  // namespace blum
#endif  // HWY_ONCE
