// Blum: common parts of the generators. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

inline constexpr double pi = std::numbers::pi;

/// @throws InvalidOption "<what> must be <rule>, not <value>" unless `holds`.
void require(bool holds, const char* what, const char* rule, double value);
/// @throws InvalidOption unless the value is finite, above 0 and at most 1e100.
void require_positive(double value, const char* what);
/// @throws InvalidOption unless the value is at least `minimum`.
void require_at_least(double value, double minimum, const char* what);
/// @throws InvalidOption if `count` triangles, segments or points are more than 50 million.
void require_triangle_count(double count);

/// Adds two triangles for the quad with the corners a, b, c, d in counter-clockwise order.
void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

/// A ring of vertices of a surface. It is counter-clockwise around the direction from one ring to the next. All rings
/// of a surface have the same number of vertices. Two poles, at the first and the last ring, close the surface.
struct Ring {
  std::vector<Vec3d> points;
};
[[nodiscard]] TriangleMesh loft(const Vec3d& first_pole, std::span<const Ring> rings, const Vec3d& last_pole);

/// Returns a surface of rings without poles: the last ring is joined to the first.
[[nodiscard]] TriangleMesh closed_loft(std::span<const Ring> rings);

/// Rotates a profile of (radius, z) points around the z axis. z must rise along the profile. The surface is closed by
/// two points on the axis, at `first_z` and `last_z`.
[[nodiscard]] TriangleMesh revolve(std::span<const std::array<double, 2>> profile, double first_z, double last_z,
                                   int sides);

/// Returns an icosahedron whose edges are cut into `frequency` parts, with all vertices projected onto the unit sphere.
/// Triangles face outwards.
[[nodiscard]] TriangleMesh geodesic(int frequency);

/// Returns the corners of a regular polygon around the centre (x, y), counter-clockwise. The first corner is at the
/// angle `phase`, radians.
[[nodiscard]] std::vector<std::array<double, 2>> circle(double x, double y, double radius, int sides, double phase = 0);

}  // namespace blum::detail
