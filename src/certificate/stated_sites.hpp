// Blum: sites of polyhedra by the numbers in files of Voronoi diagrams, for the verifier.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/shells.hpp"
#include "certificate/surface_walls.hpp"

namespace blum::verifier {

/// Sites of a polyhedron by their numbers in the columns `site_a` and `site_b`. Faces come first, in the order of their
/// smallest triangles. Triangles in one plane that share edges form a face. Reflex edges follow, in the order of the
/// SiteTable, then reflex vertices.
///
/// Diagrams of rounded meshes join faces, and use the smallest number for all of them. So a number of a face stands for
/// the whole flat part of the surface around it (SurfaceWalls). A number of a reflex edge also stands for the sites
/// that contain one of its ends. The numbers of reflex vertices stand for any site.
class StatedSites {
 public:
  /// The arguments must outlive this object.
  StatedSites(const MeshView& mesh, const SiteTable& sites, const ClosedShells& shells, const SurfaceWalls& walls);

  /// Returns true if the site with a number may contain the point of the surface that lies on a site of the SiteTable.
  [[nodiscard]] bool may_contain(std::int64_t number, SiteId site) const;

 private:
  /// Calls visit(t) for the triangles that contain a site, until it returns true. Returns true if it did.
  template <class Visit>
  [[nodiscard]] bool any_triangle(SiteId site, const Visit& visit) const;

  const SiteTable& sites_;
  const SurfaceWalls& walls_;
  std::vector<std::uint32_t> first_of_face_;                ///< smallest triangle of each face
  std::vector<std::array<std::uint32_t, 2>> reflex_edges_;  ///< their ends
  std::vector<std::size_t> first_of_vertex_;                ///< ranges of at_vertices_
  std::vector<std::uint32_t> at_vertices_;                  ///< triangles of each vertex
};

}  // namespace blum::verifier
