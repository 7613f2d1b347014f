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

/// Definition of thickness at a point of a triangle. The triangle's normal points out of the solid.
enum class ThicknessKind : std::uint8_t {
  /// A ray starts at the point, in the direction opposite to the normal. The thickness is the distance to the first
  /// other triangle through which the ray leaves the solid. The thickness is infinite if the ray leaves the solid
  /// through no other triangle, because the mesh is open or faces inwards.
  ray,
  /// Let m be the normal, at the point, of the smooth surface that the mesh approximates. The thickness is the diameter
  /// of the largest ball that touches the surface at the point from inside. The centre of the ball lies in the
  /// direction opposite to m. The ball contains no point of a triangle whose normal differs from m by `separation` or
  /// more. The normal m is interpolated between normals at the three corners of the point's triangle. A corner's normal
  /// is the mean of the normals of triangles at the corner, weighted by their angles. The mean includes only triangles
  /// whose normal differs from the normal of the point's triangle by less than `separation`. The thickness is infinite
  /// if nothing limits the ball.
  ball
};

template <>
struct Description<ThicknessKind> {
  static constexpr std::string_view name = "ThicknessKind";
  static constexpr std::array values{NamedValue{ThicknessKind::ray, "ray"}, NamedValue{ThicknessKind::ball, "ball"}};
};

struct ThicknessOptions {
  ThicknessKind kind = ThicknessKind::ray;
  /// For balls: degrees, 0 to 180. A triangle does not limit a point's ball if its normal differs by less than this
  /// angle from the surface normal at the point. Triangles with a smaller difference are treated as parts of the same
  /// smooth surface. With 0, the ball touches the triangle itself, and lies inside the polyhedron. With 0, the ball
  /// also shrinks to nothing at each convex edge, even at edges that only approximate a smooth surface.
  double separation = 30;
};

template <>
struct Description<ThicknessOptions> {
  static constexpr std::string_view name = "ThicknessOptions";
  static constexpr std::string_view doc = "Options of thickness";
  static constexpr std::tuple members{
      Member{"kind", &ThicknessOptions::kind, "",
             "'ray': distance straight inwards to the far side; 'ball': diameter of the largest ball inside the solid "
             "that touches the surface at the point"},
      Member{"separation", &ThicknessOptions::separation, "degrees",
             "for balls: triangles are ignored if their normal differs from the surface normal at the point by less "
             "than this angle",
             Range::between(0, 180)},
  };
};

/// Thickness of a solid at a point of its surface.
struct Thickness {
  double thickness = 0;  ///< Mesh units; infinite if nothing lies on the far side.
  /// For rays, the point where the ray leaves the solid; for balls, the other point that the ball touches. The given
  /// point if nothing was found.
  Vec3d opposite;
  TriangleId triangle;  ///< triangle that contains `opposite`; none() if nothing was found
};

/// Computes the thickness of a solid at points of its surface.
///
/// @param solid   a mesh whose triangles face outwards. If the mesh is not closed, the thickness is infinite or wrong
///                at points opposite to a hole. Triangles without area have an infinite thickness, and limit no ball.
/// @param points  finite. Each point is replaced by the closest point of the surface. A point on an edge or vertex
///                belongs to the adjacent triangle with the smallest index. A point on the border of its triangle is
///                moved towards the triangle's centroid, by a ten-millionth of the distance.
/// @return        one entry per point, exact up to rounding. If a ball is wider than eight diagonals of the box around
///                the solid, the thickness is infinite. The result is the same for any number of threads.
/// @throws InvalidMesh, InvalidOption, Cancelled.
/// Cost: per point, on one core, about 1 us for a ray and 5 to 30 us for a ball. Balls that touch much of the surface
/// at once, as in spheres, take far longer.
/// Method: docs/theory/surface-maps.md. Balls shrink as in Ma, Bae, Choi, "3D medial axis point approximation using
/// nearest neighbors and the normal field" (2012).
[[nodiscard]] std::vector<Thickness> thickness(const MeshView& solid, std::span<const Vec3d> points,
                                               const ThicknessOptions& options = {}, const Context& context = {});

/// Computes the thickness at the centroid of each triangle of the solid.
[[nodiscard]] std::vector<Thickness> thickness(const MeshView& solid, const ThicknessOptions& options = {},
                                               const Context& context = {});

/// Computes the thickness as a texture over the surface. SurfaceMapOptions::sign is ignored.
[[nodiscard]] SurfaceMap thickness_map(const MeshView& solid, const SurfaceMapOptions& map = {},
                                       const ThicknessOptions& options = {}, const Context& context = {});

/// Returns a warning if the thickness is not meaningful everywhere on a mesh. The warning states that the mesh is open
/// (WarningCode::open_mesh), or that it does not face outwards everywhere (WarningCode::facing). Returns at most one
/// warning.
/// @param solid  must pass validate(solid).
/// Cost: that of orientation() and a table of sites.
[[nodiscard]] std::vector<Warning> thickness_warnings(const MeshView& solid, const Context& context = {});

}  // namespace blum
