// Blum: how thick solids are. SPDX-License-Identifier: Apache-2.0
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

/// What thickness means at a point of a triangle, whose normal points out of the solid.
enum class ThicknessKind : std::uint8_t {
  ray,  ///< from the point against the normal: how far it is to the first other triangle through which one leaves the
        ///< solid. Infinite where there is none: the mesh is open, or faces inwards
  ball  ///< diameter of the largest ball that touches the surface at the point, from inside, and holds no point of a
        ///< triangle whose normal is turned by `separation` or more from the surface's there. That normal is of the
        ///< smooth surface that the mesh approximates: between those of the triangle's corners, each the mean of the
        ///< normals there that are turned by less than `separation` from the triangle's, by angle. Infinite where there
        ///< is none
};

template <>
struct Description<ThicknessKind> {
  static constexpr std::string_view name = "ThicknessKind";
  static constexpr std::array values{NamedValue{ThicknessKind::ray, "ray"}, NamedValue{ThicknessKind::ball, "ball"}};
};

struct ThicknessOptions {
  ThicknessKind kind = ThicknessKind::ray;
  /// Of balls, degrees, 0 to 180: triangles that are turned by less do not end them, and count as parts of the same
  /// smooth surface. With 0 the ball touches the triangle itself, lies inside of the polyhedron, and shrinks to nothing
  /// at each convex edge, also those that only approximate a smooth surface.
  double separation = 30;
};

template <>
struct Description<ThicknessOptions> {
  static constexpr std::string_view name = "ThicknessOptions";
  static constexpr std::string_view doc = "What thickness means";
  static constexpr std::tuple members{
      Member{"kind", &ThicknessOptions::kind, "",
             "'ray': straight inwards to the far side; 'ball': diameter of the largest ball inside that touches"},
      Member{"separation", &ThicknessOptions::separation, "degrees",
             "of balls: triangles that are turned by less do not end them", Range::between(0, 180)},
  };
};

/// How thick a solid is at a point of its surface.
struct Thickness {
  double thickness = 0;  ///< mesh units; infinite where there is nothing on the far side
  Vec3d opposite;        ///< where the ray leaves, or the ball touches; the point itself where there is nothing
  TriangleId triangle;   ///< that `opposite` lies on; none() where there is nothing
};

/// How thick a solid is at points of its surface.
///
/// @param solid   a mesh whose triangles face outwards; closed, where all of it is to have a thickness. Triangles
///                without area have none (infinite), and end no ball.
/// @param points  finite; each stands for the point of the surface that is closest to it and, on edges and at vertices,
///                for the smallest triangle there. Where a point lies on the border of its triangle, a place next to it
///                inside is taken, a ten-millionth of the triangle's size away.
/// @return        one entry per point; exact but for rounding. Of balls infinite beyond eight diagonals of the solid.
/// The same for any number of threads.
/// @throws InvalidMesh, InvalidOption, Cancelled. Cost: about 1 us (ray) and 5 to 30 us (ball) per point and core;
/// balls that touch much of the surface at once, as of spheres, take far more.
/// Method: docs/theory/surface-maps.md; balls shrink as in Ma, Bae, Choi, "3D medial axis point approximation using
/// nearest neighbors and the normal field" (2012).
[[nodiscard]] std::vector<Thickness> thickness(const MeshView& solid, std::span<const Vec3d> points,
                                               const ThicknessOptions& options = {}, const Context& context = {});

/// The same at the centroid of each triangle of the solid.
[[nodiscard]] std::vector<Thickness> thickness(const MeshView& solid, const ThicknessOptions& options = {},
                                               const Context& context = {});

/// The same as a texture over the surface. Of the map's options, `sign` is not looked at.
[[nodiscard]] SurfaceMap thickness_map(const MeshView& solid, const SurfaceMapOptions& map = {},
                                       const ThicknessOptions& options = {}, const Context& context = {});

/// What keeps all of a mesh from having a thickness, or a meaningful one: that it is open (WarningCode::open_mesh), or
/// does not face outwards everywhere (WarningCode::facing). At most one.
/// @param solid  must pass validate(solid). Cost: that of orientation() and a table of sites.
[[nodiscard]] std::vector<Warning> thickness_warnings(const MeshView& solid, const Context& context = {});

}  // namespace blum
