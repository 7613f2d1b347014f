// Blum: polyhedra with their labels, to test with. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "support/mesh_places.hpp"
#include "voronoi/site_labels.hpp"

namespace blum::test {

/// A polyhedron with the data that its labels require.
struct LabelledSolid {
  explicit LabelledSolid(TriangleMesh given)
      : mesh(std::move(given)), table(mesh), sites(polyhedron_sites(mesh, table)), labels(mesh, table, sites) {}

  TriangleMesh mesh;
  SiteTable table;
  PolyhedronSites sites;
  voronoi::SiteLabels labels;
};

/// A box of side 4 with a void of side 2, whose edges and corners are sites.
inline TriangleMesh box_with_void() {
  TriangleMesh mesh = box_between({-2, -2, -2}, {2, 2, 2});
  TriangleMesh hole = box_between({-1, -1, -1}, {1, 1, 1});
  reverse_triangles(hole);
  append(mesh, hole);
  return mesh;
}

}  // namespace blum::test
