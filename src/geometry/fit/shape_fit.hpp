// Blum: least-squares fits of planes, spheres, cylinders and cones. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "blum/core/vec3.hpp"
#include "blum/geometry/surface_shape.hpp"

namespace blum::detail {

/// Position and unit normal of a flat face, as the start of a fit.
struct FacePlace {
  Vec3d middle;
  Vec3d normal;
  double weight = 0;
};

/// Plane, sphere, cylinder or cone with a side. Points on the positive side have positive distances.
struct ShapeModel {
  SurfaceKind kind = SurfaceKind::plane;
  Vec3d point;        ///< Point of a plane, centre of a sphere, or a point on the axis.
  Vec3d axis;         ///< Unit normal of a plane, or unit vector along the axis.
  double radius = 0;  ///< Radius of a sphere or cylinder. Radius of a cone at `point`.
  double slope = 0;   ///< Angle between the axis and the straight lines of a cone's surface, radians. If the angle is
                      ///< above 0, the radius grows along the axis.
  double side = 1;    ///< -1 if normals point to the axis or the centre.

  /// Returns the distance of a point, without `side`. For cones: the distance from the line in the same half-plane.
  [[nodiscard]] double distance(const Vec3d& p) const;
  /// Returns the unit normal at a point, with `side`; 0 on an axis, in a centre, and near the apex of a cone.
  [[nodiscard]] Vec3d normal(const Vec3d& p) const;
};

/// Returns the number of parameters of a shape.
[[nodiscard]] int parameters_of(SurfaceKind kind);

/// Returns the shape with the least sum of squared distances from the points, by the Gauss-Newton method. The normals
/// of faces give the start of the iteration. Coordinates should have a size near 1. Returns nullopt if the faces do not
/// determine a shape.
/// @param points     vertices of the faces.
/// @param tolerance  If a point stays farther from the shape than 10 times this distance, the result is nullopt, and
/// the
///                   search ends early. Parameters are exact within 0.001 times this distance, or within rounding.
/// Cost: O(n), about 5 passes over the points.
[[nodiscard]] std::optional<ShapeModel> fit_shape(SurfaceKind kind, std::span<const Vec3d> points,
                                                  std::span<const FacePlace> faces, double tolerance);

/// Does the same as fit_shape(), but starts from a known shape.
/// @param precision  The search ends when parameters change by less than this.
[[nodiscard]] std::optional<ShapeModel> refit_shape(const ShapeModel& near, std::span<const Vec3d> points,
                                                    double tolerance, double precision);

}  // namespace blum::detail
