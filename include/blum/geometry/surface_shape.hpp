// Blum: planes, cylinders, cones and spheres that fit parts of a surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

enum class SurfaceKind : std::uint8_t { plane, sphere, cylinder, cone };

template <>
struct Description<SurfaceKind> {
  static constexpr std::string_view name = "SurfaceKind";
  static constexpr std::array values{NamedValue{SurfaceKind::plane, "plane"}, NamedValue{SurfaceKind::sphere, "sphere"},
                                     NamedValue{SurfaceKind::cylinder, "cylinder"},
                                     NamedValue{SurfaceKind::cone, "cone"}};
};

/// Plane, sphere, cylinder or cone that fits a part of a surface.
struct SurfaceShape {
  SurfaceKind kind = SurfaceKind::plane;
  /// Mesh units. Plane: centroid of the part's vertices. Sphere: centre. Cylinder: the point of the axis that is
  /// closest to the centroid of the part's vertices. Cone: apex.
  Vec3d point;
  /// Unit vector. Plane: normal that points out of the solid. Cylinder: direction of the axis, with an arbitrary sign.
  /// Cone: direction of the axis from the apex towards the part. Sphere: 0.
  Vec3d axis;
  double radius = 0;      ///< Mesh units. Radius of a sphere or cylinder; 0 for planes and cones.
  double half_angle = 0;  ///< Degrees. Angle between the axis and the lines of a cone; otherwise 0.
  bool concave = false;   ///< True if the solid is on the outer side of a sphere, cylinder or cone, as around a hole.
  double deviation = 0;   ///< Mesh units. Largest distance between the shape and vertices of the part.
};

template <>
struct Description<SurfaceShape> {
  static constexpr std::string_view name = "SurfaceShape";
  static constexpr std::string_view doc = "Plane, sphere, cylinder or cone that fits a part of a surface";
  static constexpr std::tuple members{
      Member{"kind", &SurfaceShape::kind, "", "plane, sphere, cylinder or cone"},
      Member{"point", &SurfaceShape::point, "mesh units",
             "plane: centroid of the vertices; sphere: centre; cylinder: point on the axis; cone: apex"},
      Member{"axis", &SurfaceShape::axis, "",
             "unit vector; plane: outer normal; cylinder: axis; cone: axis from the apex; sphere: 0"},
      Member{"radius", &SurfaceShape::radius, "mesh units", "radius of a sphere or cylinder, otherwise 0"},
      Member{"half_angle", &SurfaceShape::half_angle, "degrees", "angle between axis and lines of a cone, otherwise 0"},
      Member{"concave", &SurfaceShape::concave, "", "true if the solid is on the outer side, as around a hole"},
      Member{"deviation", &SurfaceShape::deviation, "mesh units",
             "largest distance between the shape and vertices of the part"},
  };
};

}  // namespace blum
