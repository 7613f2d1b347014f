// Blum: rays and their exact crossings with triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "blum/core/vec3.hpp"

namespace blum {

/// Points origin + t * direction for t >= 0.
struct Ray {
  Vec3d origin;
  Vec3d direction;  ///< of any length except 0
};

namespace detail {

/// A ray whose direction is scaled so that the magnitude of its largest component is 1 to 2, and the factor by which t
/// changes.
struct ScaledRay {
  Ray ray;
  double factor = 1;  ///< a power of two; the t of the scaled ray is `factor` times the t of the original ray
};
[[nodiscard]] ScaledRay scaled_direction(const Ray& ray);

/// Returns the sign (-1, 0, 1) of the determinant of direction, a - origin, b - origin. The sign is 1 if the ray's line
/// lies left of the directed edge from a to b, seen against the ray's direction. The sign is exact for coordinates that
/// are 0 or of magnitude 1e-80 to 1e100. A rounded determinant nearly always decides; otherwise, the determinant is
/// summed without error (Shewchuk 1997).
[[nodiscard]] int ray_side(const Ray& ray, const Vec3d& a, const Vec3d& b);

struct TriangleCrossing {
  double t = 0;                     ///< the crossing is at origin + t * direction; >= 0; rounded
  std::array<double, 3> weights{};  ///< barycentric weights of the corners; their sum is 1; rounded
  int side = 0;                     ///< 1 if the ray crosses towards the side that the triangle faces, -1 if it crosses
                                    ///< towards the opposite side
  bool on_border = false;           ///< true if the ray meets an edge or a corner; exact
};

/// Returns the crossing of a ray and a closed triangle. Returns nullopt if they do not cross, or if the ray lies in the
/// triangle's plane. The existence of a crossing, `side` and `on_border` are exact for coordinates in the range of
/// ray_side(). So a ray that meets an edge or a corner crosses exactly the triangles that share this edge or corner.
[[nodiscard]] std::optional<TriangleCrossing> crossing(const Ray& ray, const std::array<Vec3d, 3>& triangle);

}  // namespace detail
}  // namespace blum
