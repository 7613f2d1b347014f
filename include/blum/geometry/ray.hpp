// Blum: rays and their exact crossings with triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "blum/core/vec3.hpp"

namespace blum {

/// Points origin + t * direction for t >= 0.
struct Ray {
  Vec3d origin;
  Vec3d direction;  ///< of any length but 0
};

namespace detail {

/// A ray with its direction scaled so that its largest component is 1 to 2, and the scale of t.
struct ScaledRay {
  Ray ray;
  double factor = 1;  ///< a power of two: t of the scaled ray is t of the original ray times this
};
[[nodiscard]] ScaledRay scaled_direction(const Ray& ray);

/// Returns the sign (-1, 0, 1) of the determinant of direction, a - origin, b - origin. It is 1 if the ray's line
/// passes the directed edge from a to b on its left, seen against the direction. It is exact for coordinates that are 0
/// or of magnitude 1e-80 to 1e100. A filter nearly always answers; else the determinant is summed without error
/// (Shewchuk 1997).
[[nodiscard]] int ray_side(const Ray& ray, const Vec3d& a, const Vec3d& b);

struct TriangleCrossing {
  double t = 0;                     ///< >= 0; rounded
  std::array<double, 3> weights{};  ///< of the corners at the point; their sum is 1; rounded
  int side = 0;                     ///< 1 if the ray leaves through the side that the triangle faces, -1 if it enters
  bool on_border = false;           ///< exact: the ray meets an edge or a corner
};

/// Returns the crossing of a ray and a closed triangle. nullopt if there is none, or if the ray runs in the triangle's
/// plane. Existence, side and border are exact for coordinates in the range of ray_side(). So around an edge or a
/// corner, exactly the triangles that the ray meets are found.
[[nodiscard]] std::optional<TriangleCrossing> crossing(const Ray& ray, const std::array<Vec3d, 3>& triangle);

}  // namespace detail
}  // namespace blum
