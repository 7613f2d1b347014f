// Blum: what is seen from a far point, exactly, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "blum/core/vec3.hpp"

namespace blum::verifier {

/// A point far outside of a solid. From it every segment hangs a curtain: the triangle that it makes with the point.
/// The curtains of a closed path are a surface that the path bounds, so that crossings with it count linking.
class Apex {
 public:
  /// @param box  of all that is looked at.  @param attempt  which of a fixed sequence of directions.
  Apex(const Box3& box, std::uint32_t attempt);

  /// Where a point is seen, and how far away: boxes of these around the ends of two segments must meet for one to cross
  /// the curtain of the other one, but for rounding.
  [[nodiscard]] Vec3d seen(const Vec3d& p) const;
  /// How far boxes may be off by rounding.
  [[nodiscard]] double rounding() const { return 1e-9 * size_; }

  /// How often the way from a to b crosses the curtain of the segment from u to v: 1 or -1 by the side that it comes
  /// from, or 0; nullopt where it meets the border of the curtain, or runs in its plane.
  [[nodiscard]] std::optional<int> crossing(const Vec3d& u, const Vec3d& v, const Vec3d& a, const Vec3d& b) const;

  /// The same for the way from a point to the apex, and the triangle a, b, c.
  [[nodiscard]] std::optional<int> crossing_above(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) const;

 private:
  Vec3d apex_;
  Vec3d along_, across_, up_;
  double size_ = 1;
};

}  // namespace blum::verifier
