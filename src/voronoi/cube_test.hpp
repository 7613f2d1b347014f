// Blum: whether walls and surface in a cube are contractible. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/voronoi/polyhedron_sites.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "voronoi/cell_tree.hpp"
#include "voronoi/face_loops.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/square_cells.hpp"
#include "voronoi/surface_in_cells.hpp"

namespace blum::voronoi {

/// The components of walls and surface in a cube that passes.
struct CubeCells {
  VoronoiObstacle obstacle = VoronoiObstacle::none;
  std::uint32_t component_count = 0;
  /// A square without children on the boundary.
  struct Square {
    CellId square = no_cell;
    std::vector<std::uint32_t> events;              ///< as in SquareCells
    std::vector<std::uint32_t> component_of_event;  ///< in the square
    std::vector<std::uint32_t> component;           ///< in the cube, of each component in the square
  };
  std::vector<Square> squares;
};

/// Decides by what is on a cube's boundary whether all components of walls and surface in it are acyclic: which they
/// are if and only if H0 and H1 of each region in the cube, relative to its part of the boundary, vanish (Lefschetz
/// duality). Regions retract to footprints in the cube, or to where the way to the footprint leaves it. The criteria
/// for faces, edges, vertices and the outside, and their proofs: docs/theory/voronoi.md.
class CubeTest {
 public:
  CubeTest(const MeshView& mesh, const PolyhedronSites& sites, const LabelGeometry& labels, const FaceLoops& loops,
           const SurfaceInCells& surface, const CellTree& tree)
      : mesh_(mesh), sites_(sites), labels_(labels), loops_(loops), surface_(surface), tree_(tree) {}

  [[nodiscard]] CubeCells run(const GridCube& cube) const;

 private:
  friend class CubeAnalysis;
  const MeshView mesh_;
  const PolyhedronSites& sites_;
  const LabelGeometry& labels_;
  const FaceLoops& loops_;
  const SurfaceInCells& surface_;
  const CellTree& tree_;
};

}  // namespace blum::voronoi
