// Blum: properties of a polyhedron that do not depend on a grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/part_cells.hpp"
#include "voronoi/site_labels.hpp"

namespace blum::voronoi {

/// The loops of edges that bound each face: one outer loop, and one for each hole. If a face touches itself at a
/// vertex, the loop continues along the same fan of triangles.
class FaceLoops {
 public:
  FaceLoops(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites);

  /// Returns the loops of a face, each as a list of vertices.
  [[nodiscard]] std::span<const std::vector<std::uint32_t>> of(std::uint32_t face) const {
    return std::span(loops_).subspan(first_[face], first_[face + 1] - first_[face]);
  }
  /// Returns the number of holes in all faces together.
  [[nodiscard]] std::size_t hole_count() const { return loops_.size() + 1 - first_.size(); }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::vector<std::uint32_t>> loops_;
};

/// A polyhedron with its sites, and the rule of the requested part of its diagram. The mesh and its table must outlive
/// this object, which cannot be copied or moved.
struct VoronoiSolid {
  VoronoiSolid(const MeshView& of, const SiteTable& table_of, VoronoiPart part, const Context& context = {})
      : VoronoiSolid(of, table_of, polyhedron_sites(of, table_of, context), part) {}
  /// @param sites_of  those of the mesh.
  VoronoiSolid(const MeshView& of, const SiteTable& table_of, PolyhedronSites sites_of, VoronoiPart part)
      : mesh(of),
        table(table_of),
        sites(std::move(sites_of)),
        exact(mesh, table, sites),
        labels(mesh, table, sites, exact),
        loops(mesh, table, sites),
        corners(part == VoronoiPart::medial_axis ? reflex_corners(mesh, table, sites, labels)
                                                 : std::vector<ReflexCorner>()),
        rule(part, sites, labels, corners) {
    triangle_of_face.resize(sites.face_count);
    for (std::uint32_t t = 0; t < sites.face_of.size(); ++t) triangle_of_face[sites.face_of[t]] = t;
  }
  VoronoiSolid(const VoronoiSolid&) = delete;
  VoronoiSolid& operator=(const VoronoiSolid&) = delete;
  VoronoiSolid(VoronoiSolid&&) = delete;
  VoronoiSolid& operator=(VoronoiSolid&&) = delete;
  ~VoronoiSolid() = default;

  const MeshView mesh;
  const SiteTable& table;
  const PolyhedronSites sites;
  const SiteLabels exact;
  const LabelGeometry labels;
  const FaceLoops loops;
  const std::vector<ReflexCorner> corners;  ///< for each vertex; empty except for a medial axis
  const PartRule rule;
  std::vector<std::uint32_t> triangle_of_face;  ///< for each face: the index of one of its triangles
};

}  // namespace blum::voronoi
