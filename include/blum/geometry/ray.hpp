// Blum: rays, and where they cross triangles, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "blum/core/vec3.hpp"

namespace blum {

/// The points origin + t * direction for t >= 0.
struct Ray {
  Vec3d origin;
  Vec3d direction;  ///< of any length but 0
};

namespace detail {

/// The same ray with a direction whose largest component is 1 to 2, and by how much t grows.
struct ScaledRay {
  Ray ray;
  double factor = 1;  ///< a power of two: t there is t here times this
};
[[nodiscard]] ScaledRay scaled_direction(const Ray& ray);

/// The sign (-1, 0, 1) of the determinant of direction, a - origin, b - origin: 1 where the line of the ray passes the
/// directed edge from a to b on its left, seen against the direction. Exact for coordinates of magnitude 1e-80 to
/// 1e100, or 0: a filter answers nearly always, else the determinant is summed without error (Shewchuk 1997).
[[nodiscard]] int ray_side(const Ray& ray, const Vec3d& a, const Vec3d& b);

struct TriangleCrossing {
  double t = 0;                     ///< >= 0; rounded
  std::array<double, 3> weights{};  ///< of the corners at the point, their sum is 1; rounded
  int side = 0;            ///< 1 where the ray leaves through the side that the triangle faces, -1 where it enters
  bool on_border = false;  ///< exactly: the ray meets an edge or a corner
};

/// Where a ray crosses a closed triangle; nullopt where it does not, or runs in the triangle's plane. Whether it does,
/// its side and its border are exact for coordinates in the range of ray_side(): of the triangles around an edge or a
/// corner none is missed, and none is found that is not met.
[[nodiscard]] std::optional<TriangleCrossing> crossing(const Ray& ray, const std::array<Vec3d, 3>& triangle);

}  // namespace detail
}  // namespace blum
