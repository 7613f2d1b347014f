// Blum: transformed meshes and query points for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"

namespace blum::test {

/// scale * mesh + offset.
inline TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3d& offset = {}) {
  for (Vec3d& v : mesh.vertices) v = v * scale + offset;
  return mesh;
}

/// A point rotated about two axes, by angles without symmetry.
inline Vec3d turned(const Vec3d& p) {
  constexpr double about_z = 0.3;
  constexpr double about_x = 0.5;
  const Vec3d q{std::cos(about_z) * p.x - std::sin(about_z) * p.y, std::sin(about_z) * p.x + std::cos(about_z) * p.y,
                p.z};
  return {q.x, std::cos(about_x) * q.y - std::sin(about_x) * q.z, std::sin(about_x) * q.y + std::cos(about_x) * q.z};
}

/// A mesh after the same rotation. Rounding bends faces of several triangles.
inline TriangleMesh turned(TriangleMesh mesh) {
  for (Vec3d& v : mesh.vertices) v = turned(v);
  return mesh;
}

/// A number rounded to single precision. Without `volatile`, GCC 12 drops the rounding of neighbouring numbers that are
/// stored where they came from (findings/rounding-vanishes.sh).
inline double in_single_precision(double value) {
  const volatile float rounded = static_cast<float>(value);
  return static_cast<double>(rounded);
}

/// A mesh with coordinates rounded to single precision, as in .stl files.
inline TriangleMesh in_single_precision(TriangleMesh mesh) {
  for (Vec3d& v : mesh.vertices) v = {in_single_precision(v.x), in_single_precision(v.y), in_single_precision(v.z)};
  return mesh;
}

/// A mesh in which each triangle has its own three vertices.
inline TriangleMesh unwelded(const MeshView& mesh) {
  TriangleMesh out;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (const std::uint32_t v : t) out.vertices.push_back(mesh.vertices[v]);
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

/// A unit square of n x n cells in the plane z = 0.
inline TriangleMesh flat_sheet(std::uint32_t n) {
  TriangleMesh out;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i)
      out.vertices.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n, 0});
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t corner = j * (n + 1) + i;
      out.triangles.push_back({corner, corner + 1, corner + n + 2});
      out.triangles.push_back({corner, corner + n + 2, corner + n + 1});
    }
  }
  return out;
}

/// Triangles of every awkward kind, with free segments and points.
inline TriangleMesh awkward_soup(std::size_t triangles, std::uint64_t seed) {
  TriangleMesh mesh = make_soup({.triangles = triangles, .awkward = 0.7, .seed = seed});
  append(mesh, make_segments({.segments = triangles / 8 + 1, .seed = seed + 1}));
  append(mesh, make_points({.points = triangles / 8 + 1, .seed = seed + 2}));
  return mesh;
}

/// Random points in the box of a shape and half its size beyond, and a few at its vertices and far away.
inline std::vector<Vec3d> places_around(const MeshView& mesh, std::size_t count, std::uint64_t seed) {
  const Box3 box = bounds(mesh);
  const double size = box.diagonal() > 0 ? box.diagonal() : 1.0;
  Random random(seed);
  std::vector<Vec3d> places;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d& vertex = mesh.vertices[mesh.triangles[random.below(mesh.triangles.size())][0]];
    switch (i % 8) {
      case 0:
        places.push_back(vertex);
        break;
      case 1:
        places.push_back(box.center() + random.in_ball() * (10 * size));
        break;
      case 2:
        places.push_back(vertex + random.in_ball() * (1e-3 * size));
        break;
      default:
        places.push_back(box.center() + random.in_ball() * size);
    }
  }
  return places;
}

/// A box between two corners, optionally reversed. Its triangles start with number `first`.
inline TriangleMesh box_between(const Vec3d& lower, const Vec3d& upper, bool is_reversed = false, int first = 0) {
  TriangleMesh mesh = make_box({});
  const Box3 box = bounds(mesh);
  for (Vec3d& v : mesh.vertices) {
    for (std::size_t a = 0; a < 3; ++a) {
      v[a] = lower[a] + (v[a] - box.lower[a]) / (box.upper[a] - box.lower[a]) * (upper[a] - lower[a]);
    }
  }
  if (is_reversed) mesh.triangles = reversed_triangles(mesh.triangles);
  std::rotate(mesh.triangles.begin(), mesh.triangles.begin() + first, mesh.triangles.end());
  return mesh;
}

}  // namespace blum::test
