// Blum: test that walls and surface in a cube are contractible. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "blum/core/union_find.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "voronoi/cell_tree.hpp"
#include "voronoi/square_cells.hpp"
#include "voronoi/surface_in_cells.hpp"
#include "voronoi/voronoi_solid.hpp"

namespace blum::voronoi {

/// A square without children on a cube's boundary, with its contents.
struct SquareOfCube {
  CellId id = no_cell;
  std::uint32_t side = 0;  ///< 2 axis, plus 1 for the upper side
  SquareCells cells;
  std::uint32_t first_piece = 0, first_wall = 0, first_body = 0;
};

/// Returns true if a way against a normal leaves a cube at once through a side.
/// @param side  as in SquareOfCube.
[[nodiscard]] inline bool is_lower_side(std::uint32_t side, const Vec3d& normal) {
  return normal[side / 2] * (side % 2 == 1 ? 1 : -1) < -1e-15;
}

/// Components of walls and surface in a passing cube, or of the requested part of them.
struct CubeCells {
  VoronoiObstacle obstacle = VoronoiObstacle::none;
  std::uint32_t component_count = 0;
  /// A square without children on the boundary.
  struct Square {
    CellId square = no_cell;
    std::vector<std::uint32_t> events;              ///< as in SquareCells
    std::vector<std::uint32_t> component_of_event;  ///< in the square; `outside` if it is on no kept wall
    std::vector<std::uint32_t> component;           ///< in the cube, for each component in the square
    std::vector<std::uint32_t> convex_edges;        ///< convex edges of the mesh that pierce it; set only for a part
  };
  std::vector<Square> squares;
  std::vector<std::uint32_t> vertices;  ///< vertices of the mesh in the cube; set only for a part
};

/// A cube of the largest depth that does not pass.
struct FailingCube {
  CellId cube = no_cell;
  VoronoiObstacle obstacle = VoronoiObstacle::none;
};

/// Numbers the components in a cube. Components in its squares that are in one set get one number.
class CubeNumbers {
 public:
  /// @param component_of_event  in the square, as in CubeCells.
  /// @param first  number of the first component of the square in `joined`; the others follow.
  /// @param count  number of components in the square.
  void add(const SquareOfCube& square, std::vector<std::uint32_t> component_of_event, std::uint32_t first,
           std::uint32_t count, detail::UnionFind& joined, CubeCells& out);

 private:
  std::map<std::uint32_t, std::uint32_t> number_;  ///< of each set
};

/// Decides from a cube's boundary whether all components of walls and surface in it are acyclic. They are if and only
/// if H0 and H1 of each region in the cube, relative to its part of the boundary, vanish (Lefschetz duality). Regions
/// retract to footprints in the cube, or to the points where the way to the footprint leaves it. The criteria for
/// faces, edges, vertices and the outside, and their proofs: docs/theory/voronoi.md.
class CubeTest {
 public:
  CubeTest(const VoronoiSolid& solid, const SurfaceInCells& surface, const CellTree& tree)
      : solid_(solid),
        mesh_(solid.mesh),
        sites_(solid.sites),
        labels_(solid.labels),
        loops_(solid.loops),
        surface_(surface),
        tree_(tree) {}

  [[nodiscard]] CubeCells run(const GridCube& cube) const;

 private:
  friend class CubeAnalysis;
  const VoronoiSolid& solid_;
  const MeshView mesh_;
  const PolyhedronSites& sites_;
  const LabelGeometry& labels_;
  const FaceLoops& loops_;
  const SurfaceInCells& surface_;
  const CellTree& tree_;
};

}  // namespace blum::voronoi
