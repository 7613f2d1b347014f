// Blum: the border loops of a polyhedron's faces. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"

namespace blum::voronoi {

/// The loops of edges that bound each face: one, and one more for each hole. Where a face touches itself in a vertex,
/// loops follow the triangles around it.
class FaceLoops {
 public:
  FaceLoops(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites);

  /// The loops of a face: vertices.
  [[nodiscard]] std::span<const std::vector<std::uint32_t>> of(std::uint32_t face) const {
    return std::span(loops_).subspan(first_[face], first_[face + 1] - first_[face]);
  }
  /// Holes of all faces.
  [[nodiscard]] std::size_t hole_count() const { return loops_.size() + 1 - first_.size(); }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::vector<std::uint32_t>> loops_;
};

}  // namespace blum::voronoi
