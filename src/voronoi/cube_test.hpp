// Blum: whether walls and surface in a cube are contractible. SPDX-License-Identifier: Apache-2.0
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

/// A square without children on a cube's boundary, with what is in it.
struct SquareOfCube {
  CellId id = no_cell;
  std::uint32_t side = 0;  ///< 2 axis + 1 where it is the upper one
  SquareCells cells;
  std::uint32_t first_piece = 0, first_wall = 0, first_body = 0;
};

/// Whether a way against a normal leaves a cube through a side of it at once. @param side  as SquareOfCube has it.
[[nodiscard]] inline bool is_lower_side(std::uint32_t side, const Vec3d& normal) {
  return normal[side / 2] * (side % 2 == 1 ? 1 : -1) < -1e-15;
}

/// The components of walls and surface, or of the part of them that is asked for, in a cube that passes.
struct CubeCells {
  VoronoiObstacle obstacle = VoronoiObstacle::none;
  std::uint32_t component_count = 0;
  /// A square without children on the boundary.
  struct Square {
    CellId square = no_cell;
    std::vector<std::uint32_t> events;              ///< as in SquareCells
    std::vector<std::uint32_t> component_of_event;  ///< in the square; `outside` where it is on no kept wall
    std::vector<std::uint32_t> component;           ///< in the cube, of each component in the square
    std::vector<std::uint32_t> convex_edges;        ///< of the mesh that pierce it, where a part is asked for
  };
  std::vector<Square> squares;
  std::vector<std::uint32_t> vertices;  ///< of the mesh in the cube, where a part is asked for
};

/// A cube that does not pass, at the largest depth.
struct FailingCube {
  CellId cube = no_cell;
  VoronoiObstacle obstacle = VoronoiObstacle::none;
};

/// Numbers components in a cube by the sets of which those in its squares are.
class CubeNumbers {
 public:
  /// @param component_of_event  in the square, as CubeCells has it.  @param count  of components in the square, which
  /// are `joined` from `first` on.
  void add(const SquareOfCube& square, std::vector<std::uint32_t> component_of_event, std::uint32_t first,
           std::uint32_t count, detail::UnionFind& joined, CubeCells& out);

 private:
  std::map<std::uint32_t, std::uint32_t> number_;  ///< of sets
};

/// Decides by what is on a cube's boundary whether all components of walls and surface in it are acyclic: which they
/// are if and only if H0 and H1 of each region in the cube, relative to its part of the boundary, vanish (Lefschetz
/// duality). Regions retract to footprints in the cube, or to where the way to the footprint leaves it. The criteria
/// for faces, edges, vertices and the outside, and their proofs: docs/theory/voronoi.md.
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
