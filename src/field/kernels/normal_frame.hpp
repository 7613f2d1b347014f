// Blum: the normalised frame, in whose coordinates fields are computed. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/core/error.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/kernels/host_device.hpp"

namespace blum::kernels {

/// Map from world coordinates to the normalised frame, in which float32 is accurate. The grid's axes become x, y, z.
/// The box around mesh and grid is centred on the origin, and its diagonal is longer than 1/2 and at most 1. The scale
/// is a power of two, so scaling is exact.
struct NormalFrame {
  enum class Fault : std::uint8_t { none, too_large, too_small };  // too_large also if a vertex is not finite

  Mat3 direction;
  Vec3d center;      ///< of the box around mesh and grid, in the grid's axes
  double scale = 1;  ///< normalised = world * scale
  Vec3d first_node;  ///< normalised position of node (0, 0, 0)
  Vec3d spacing;     ///< normalised
  Fault fault = Fault::none;

  [[nodiscard]] BLUM_HD Vec3d to_normal(const Vec3d& world) const {
    return (direction.transposed_times(world) - center) * scale;
  }
  /// Returns the normalised coordinate of the nodes with this index along an axis. An index that ends in 1/2 is the
  /// middle between two nodes.
  [[nodiscard]] BLUM_HD double at(int axis, double index) const {
    const auto a = static_cast<std::size_t>(axis);
    return first_node[a] + spacing[a] * index;
  }
};

/// Lower and upper corner of a box.
struct Bounds {
  Vec3d lower{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3d upper{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  BLUM_HD void extend(const Vec3d& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  /// Extends the box by p. If p is not finite, the box becomes infinite, because no later comparison would reveal NaN.
  BLUM_HD void extend_if_finite(const Vec3d& p) {
    if (dot(p, p) < HUGE_VAL) {
      extend(p);
    } else {
      lower = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
      upper = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    }
  }
};

/// Returns the normalised frame of a mesh and a grid.
/// @param box  around the mesh, in the grid's axes.
BLUM_HD inline NormalFrame make_normal_frame(Bounds box, const GridSpec& grid) {
  NormalFrame frame;
  frame.direction = grid.direction;
  const Vec3d first = grid.direction.transposed_times(grid.origin);
  const Vec3d last = first + Vec3d{static_cast<double>(grid.size[0] - 1) * grid.spacing.x,
                                   static_cast<double>(grid.size[1] - 1) * grid.spacing.y,
                                   static_cast<double>(grid.size[2] - 1) * grid.spacing.z};
  box.extend(first);
  box.extend(last);
  const Vec3d size = box.upper - box.lower;  // kept as a vector: the squares of the diagonal may underflow
  const double diagonal = norm(size);
  if (!(diagonal < 1e37)) frame.fault = NormalFrame::Fault::too_large;
  if (larger(larger(size.x, size.y), size.z) > 0 && diagonal < 1e-36) frame.fault = NormalFrame::Fault::too_small;
  int exponent = 0;
  if (diagonal > 0 && frame.fault == NormalFrame::Fault::none) (void)frexp(diagonal, &exponent);
  frame.scale = ldexp(1.0, -exponent);
  frame.center = (box.lower + box.upper) * 0.5;
  frame.first_node = (first - frame.center) * frame.scale;
  frame.spacing = grid.spacing * frame.scale;
  return frame;
}

/// Throws if a frame is faulty.
/// @throws InvalidGrid if mesh and grid are too large or too small for 32-bit distances.
inline void throw_if_faulty(const NormalFrame& frame) {
  if (frame.fault == NormalFrame::Fault::too_large) {
    throw InvalidGrid("mesh and grid span more than 1e37, too far for 32-bit distances: scale them down");
  }
  if (frame.fault == NormalFrame::Fault::too_small) {
    throw InvalidGrid("mesh and grid span less than 1e-36, too little for 32-bit distances: scale them up");
  }
}

}  // namespace blum::kernels
