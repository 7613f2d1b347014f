// Blum: solids for tests of the cellular model. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "solid/model/grid_planes.hpp"

namespace blum::test {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// A copy, rotated around three axes. The seed determines the angles.
[[nodiscard]] TriangleMesh turned(const TriangleMesh& mesh, std::uint64_t seed);
/// A copy with coordinates times a factor, rounded to whole numbers. It may cross itself.
[[nodiscard]] TriangleMesh rounded(const TriangleMesh& mesh, double factor);
/// A polyhedron around the origin whose vertices lie at random distances, 0.3 to 1.
[[nodiscard]] TriangleMesh random_star(Random& random, int frequency);

/// Boxes, wedges, shells, slits, pins, pinholes, notches and random stars, most of them rotated. Their details are thin
/// compared with the cells of any test grid.
[[nodiscard]] std::vector<NamedMesh> thin_solids();
/// Solids whose coordinates are whole numbers, -12 to 12.
[[nodiscard]] std::vector<NamedMesh> whole_solids();

/// Grid planes around a mesh, at multiples of a spacing from an origin, with spare cubes on each side.
[[nodiscard]] detail::GridPlanes planes_around(const TriangleMesh& mesh, const Vec3d& origin, double spacing,
                                               int spare = 1);

}  // namespace blum::test
