// Blum: thickness of solids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/surface_map/surface_distance_map.hpp"

namespace blum {

/// Definition of thickness at a point of a triangle, whose normal points out of the solid.
enum class ThicknessKind : std::uint8_t {
  ray,  ///< Distance from the point against the normal to the first other triangle through which the ray leaves the
        ///< solid. Infinite if there is none: the mesh is open, or faces inwards.
  ball  ///< Diameter of the largest ball that touches the surface at the point, from inside. It contains no point of a
        ///< triangle whose normal differs from the surface's there by `separation` or more. That normal is the one of
        ///< the smooth surface that the mesh approximates. It lies between those of the triangle's corners. A corner's
        ///< normal is the mean, by angle, of the normals there that differ from the triangle's by less than
        ///< `separation`. Infinite if there is no such ball.
};

template <>
struct Description<ThicknessKind> {
  static constexpr std::string_view name = "ThicknessKind";
  static constexpr std::array values{NamedValue{ThicknessKind::ray, "ray"}, NamedValue{ThicknessKind::ball, "ball"}};
};

struct ThicknessOptions {
  ThicknessKind kind = ThicknessKind::ray;
  /// For balls, degrees, 0 to 180. Triangles whose normals differ by less do not limit a ball, and count as parts of
  /// the same smooth surface. With 0 the ball touches the triangle itself and lies inside of the polyhedron. It shrinks
  /// to nothing at each convex edge, also those that only approximate a smooth surface.
  double separation = 30;
};

template <>
struct Description<ThicknessOptions> {
  static constexpr std::string_view name = "ThicknessOptions";
  static constexpr std::string_view doc = "Options of thickness";
  static constexpr std::tuple members{
      Member{"kind", &ThicknessOptions::kind, "",
             "'ray': distance straight inwards to the far side; 'ball': diameter of the largest inner ball that "
             "touches the point"},
      Member{"separation", &ThicknessOptions::separation, "degrees",
             "for balls: largest angle between normals of triangles that do not limit the ball",
             Range::between(0, 180)},
  };
};

/// Thickness of a solid at a point of its surface.
struct Thickness {
  double thickness = 0;  ///< mesh units; infinite if nothing lies on the far side
  Vec3d opposite;        ///< where the ray leaves, or the ball touches; the point itself if nothing was found
  TriangleId triangle;   ///< triangle that contains `opposite`; none() if nothing was found
};

/// Computes the thickness of a solid at points of its surface.
///
/// @param solid   a mesh whose triangles face outwards. It must be closed for all of it to have a thickness. Triangles
///                without area have none (infinite), and limit no ball.
/// @param points  finite. Each stands for the point of the surface that is closest to it and, on edges and at vertices,
///                for the smallest triangle there. A point on the border of its triangle is moved inside, by a
///                ten-millionth of the way to the triangle's centroid.
/// @return        one entry per point; exact within rounding. For balls, infinite beyond eight diagonals of the solid.
///                The same for any number of threads.
/// @throws InvalidMesh, InvalidOption, Cancelled.
/// Cost: about 1 us (ray) and 5 to 30 us (ball) per point and core. Balls that touch much of the surface at once, as in
/// spheres, take far more.
/// Method: docs/theory/surface-maps.md. Balls shrink as in Ma, Bae, Choi, "3D medial axis point approximation using
/// nearest neighbors and the normal field" (2012).
[[nodiscard]] std::vector<Thickness> thickness(const MeshView& solid, std::span<const Vec3d> points,
                                               const ThicknessOptions& options = {}, const Context& context = {});

/// Computes the thickness at the centroid of each triangle of the solid.
[[nodiscard]] std::vector<Thickness> thickness(const MeshView& solid, const ThicknessOptions& options = {},
                                               const Context& context = {});

/// Computes the thickness as a texture over the surface. The map's option `sign` is ignored.
[[nodiscard]] SurfaceMap thickness_map(const MeshView& solid, const SurfaceMapOptions& map = {},
                                       const ThicknessOptions& options = {}, const Context& context = {});

/// Returns a warning if not all of a mesh has a meaningful thickness. Either it is open (WarningCode::open_mesh), or it
/// does not face outwards everywhere (WarningCode::facing). Returns at most one warning.
/// @param solid  must pass validate(solid).
/// Cost: that of orientation() and a table of sites.
[[nodiscard]] std::vector<Warning> thickness_warnings(const MeshView& solid, const Context& context = {});

}  // namespace blum
