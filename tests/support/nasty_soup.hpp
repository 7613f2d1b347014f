// Blum: triangles for which float32 is too imprecise, for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "blum/core/random.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::test {

/// Triangles of extreme shapes: needles, caps, duplicates, coplanar and coincident triangles, zero areas.
inline TriangleMesh nasty_soup(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  TriangleMesh mesh;
  const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3d a = random.in_cube();
    const Vec3d b = a + random.in_ball() * 0.4;
    const double thin = std::pow(10.0, -random.uniform(1.0, 10.0));
    switch (k % 7) {
      case 0:
        add(a, b, a + random.in_ball() * 0.3);
        break;
      case 1:
        add(a, b, b + random.in_ball() * thin);
        break;  // needle
      case 2:
        add(a, b, (a + b) * 0.5 + random.in_ball() * thin);
        break;  // cap
      case 3:
        add({a.x, a.y, 0.5}, {b.x, b.y, 0.5}, {random.uniform(), random.uniform(), 0.5});
        break;  // coplanar
      case 4:
        add(a, b, a);
        break;  // no area
      case 5:
        mesh.triangles.push_back(mesh.triangles[random.below(mesh.triangles.size())]);
        break;  // duplicate
      default: {
        const Triangle t = mesh.triangles[random.below(mesh.triangles.size())];  // coincident, other vertices
        add(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      }
    }
  }
  return mesh;
}

}  // namespace blum::test
