// Blum: crossings of the rows of a grid with triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/grid/grid_spec.hpp"
#include "field/kernels/host_device.hpp"

// Arithmetic of SignScan (field/sign/scan.hpp) and of its counterpart on devices. SignScan explains why it is exact. No
// multiplication is fused with an addition: triangles that share an edge must get bitwise equal points where a slice
// cuts it. On the host, files that include this header are compiled without contraction.
namespace blum::kernels {

/// Converts positions to node units: multiples of the grid's spacings, relative to node (0, 0, 0).
struct NodeUnits {
  Vec3d origin;
  Mat3 inverse;
  bool is_mirrored = false;

  NodeUnits() = default;
  explicit NodeUnits(const GridSpec& grid) : origin(grid.origin) {
    // The inverse is used, not the transpose, because the direction is orthonormal only up to 1e-6.
    const Vec3d* axis = grid.direction.columns;
    const double determinant = dot(axis[0], cross(axis[1], axis[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      inverse.columns[k] = cross(axis[(k + 1) % 3], axis[(k + 2) % 3]) / (determinant * grid.spacing[k]);
    }
    is_mirrored = determinant < 0;
  }
  [[nodiscard]] BLUM_HD Vec3d position(const Vec3d& world) const { return inverse.transposed_times(world - origin); }
};

/// Range of integers k in [0, size) with from <= k < to. For each slice (or row) in this range, one end is at or below
/// the slice, and the other end is above it.
template <class Index>
struct Cuts {
  Index begin, end;

  BLUM_HD Cuts(double from, double to, Index size)
      : begin(clamped_to(ceil(from), size)), end(clamped_to(ceil(to), size)) {}

 private:
  /// Returns 0 if the value is NaN, which is possible because very small spacings overflow.
  BLUM_HD static Index clamped_to(double value, Index size) {
    if (!(value > 0)) return 0;
    return value < static_cast<double>(size) ? static_cast<Index>(value) : size;
  }
};

/// Point in the plane of a slice.
struct SlicePoint {
  double x, y;
};

/// Returns the point where an edge meets a slice. The point is computed from the lower to the upper end, so that all
/// triangles at the edge find the same point.
BLUM_HD inline SlicePoint edge_point(const Vec3d& lower, const Vec3d& upper, double z) {
  const double t = (z - lower.z) / (upper.z - lower.z);
  return {lower.x + rounded_product(t, upper.x - lower.x), lower.y + rounded_product(t, upper.y - lower.y)};
}

/// Triangle with its corners in node units.
struct PlacedTriangle {
  Vec3d a, b, c;

  /// Returns the slices that cut the triangle.
  template <class Index>
  [[nodiscard]] BLUM_HD Cuts<Index> slices(Index size) const {
    return {smaller(smaller(a.z, b.z), c.z), larger(larger(a.z, b.z), c.z), size};
  }
  /// Returns the rows that may cross the triangle in any slice.
  template <class Index>
  [[nodiscard]] BLUM_HD Cuts<Index> rows(Index size) const {
    return {smaller(smaller(a.y, b.y), c.y), larger(larger(a.y, b.y), c.y), size};
  }
};

/// Line segment in which a slice cuts a triangle. `goes_in` is true if the rows that cross it enter the solid there.
struct SliceCut {
  SlicePoint p, q;
  bool goes_in;

  /// @param z  a slice that cuts the triangle.
  BLUM_HD SliceCut(const PlacedTriangle& t, double z, bool is_mirrored) {
    const bool above_a = t.a.z > z, above_b = t.b.z > z, above_c = t.c.z > z;
    // The corner that is alone on its side of the slice comes first.
    const bool a_first = above_b == above_c;
    const bool b_first = !a_first && above_c == above_a;
    const Vec3d& alone = a_first ? t.a : b_first ? t.b : t.c;
    const Vec3d& next = a_first ? t.b : b_first ? t.c : t.a;
    const Vec3d& last = a_first ? t.c : b_first ? t.a : t.b;
    const bool is_above = alone.z > z;
    p = is_above ? edge_point(next, alone, z) : edge_point(alone, next, z);
    q = is_above ? edge_point(last, alone, z) : edge_point(alone, last, z);
    // If the first corner is above the slice and q is at larger y than p, the triangle faces towards +x. So its rows
    // leave the solid.
    goes_in = (q.y > p.y) != (is_above != is_mirrored);
  }

  /// Returns the rows that cross this segment.
  template <class Index>
  [[nodiscard]] BLUM_HD Cuts<Index> rows(Index size) const {
    return {smaller(p.y, q.y), larger(p.y, q.y), size};
  }
  /// Returns the index of the first node of a row behind its crossing. The index is a whole number and may lie outside
  /// of the grid.
  [[nodiscard]] BLUM_HD double node_behind(double row) const {
    const double t = (row - p.y) / (q.y - p.y);
    return floor(p.x + rounded_product(t, q.x - p.x)) + 1;
  }
};

}  // namespace blum::kernels
