// Blum: round rods along paths, for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::test {

/// A polyline: the middle of a rod.
using Path = std::vector<Vec3d>;

/// A closed rod with flat ends. Cross sections are regular polygons with corners at distance `radius` from the path.
/// Neighbouring cross sections are turned as little as possible.
/// @param radius  for each point of the path.
inline TriangleMesh rod_along(const Path& path, const std::vector<double>& radius, std::uint32_t sides) {
  TriangleMesh mesh;
  const std::size_t count = path.size();
  Vec3d u = cross(path[1] - path[0], Vec3d{0.3, 0.5, 0.8});
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d way = path[std::min(i + 1, count - 1)] - path[i > 0 ? i - 1 : 0];
    way = way / length(way);
    u = u - way * dot(u, way);
    u = u / length(u);
    const Vec3d v = cross(way, u);
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      mesh.vertices.push_back(path[i] + (u * std::cos(angle) + v * std::sin(angle)) * radius[i]);
    }
  }
  const auto at = [&](std::size_t i, std::uint32_t k) { return static_cast<std::uint32_t>(i * sides + k % sides); };
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(path.front());
  mesh.vertices.push_back(path.back());
  for (std::uint32_t k = 0; k < sides; ++k) {
    for (std::size_t i = 0; i + 1 < count; ++i) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
    mesh.triangles.push_back({first, at(0, k + 1), at(0, k)});
    mesh.triangles.push_back({first + 1, at(count - 1, k), at(count - 1, k + 1)});
  }
  return mesh;
}
inline TriangleMesh rod_along(const Path& path, double radius, std::uint32_t sides) {
  return rod_along(path, std::vector<double>(path.size(), radius), sides);
}

/// Two straight legs along z and x, of `length` and 0.7 times `length`, joined by a quarter circle.
inline Path l_shape(double length, double bend_radius) {
  Path path{{0, 0, 0}};
  constexpr int parts = 24;
  for (int n = 0; n <= parts; ++n) {
    const double angle = 0.5 * std::numbers::pi * n / parts;
    path.push_back({bend_radius * (1 - std::cos(angle)), 0, length + bend_radius * std::sin(angle)});
  }
  path.push_back({bend_radius + 0.7 * length, 0, length + bend_radius});
  return path;
}

/// A helix around the z axis with 40 points a turn.
inline Path helix(double radius, double pitch, int turns) {
  Path path;
  for (int n = 0; n <= 40 * turns; ++n) {
    const double angle = 2 * std::numbers::pi * n / 40;
    path.push_back({radius * std::cos(angle), radius * std::sin(angle), pitch * n / 40});
  }
  return path;
}

/// Points on a polyline, at most `step` apart, without its first and last part of length `without`.
inline std::vector<Vec3d> points_along(const Path& path, double step, double without = 0) {
  std::vector<double> arc{0};
  for (std::size_t i = 1; i < path.size(); ++i) arc.push_back(arc.back() + length(path[i] - path[i - 1]));
  std::vector<Vec3d> points;
  std::size_t i = 1;
  const double whole = arc.back() - 2 * without;
  const int count = static_cast<int>(whole / step) + 1;
  for (int n = 0; n <= count; ++n) {
    const double s = without + whole * n / count;
    while (i + 1 < path.size() && arc[i] < s) ++i;
    const double t = std::clamp((s - arc[i - 1]) / (arc[i] - arc[i - 1]), 0.0, 1.0);
    points.push_back(path[i - 1] + (path[i] - path[i - 1]) * t);
  }
  return points;
}

/// The polyline as a mesh of segments.
inline TriangleMesh as_segments(const Path& path) {
  TriangleMesh mesh;
  mesh.vertices = path;
  for (std::uint32_t v = 0; v + 1 < path.size(); ++v) mesh.segments.push_back({v, v + 1});
  return mesh;
}

}  // namespace blum::test
