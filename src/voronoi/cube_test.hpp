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

/// A square without children on a cube's boundary, and its contents.
struct SquareOfCube {
  CellId id = no_cell;
  std::uint32_t side = 0;  ///< 2 * axis, + 1 for the upper side
  SquareCells cells;
  std::uint32_t first_piece = 0, first_wall = 0, first_body = 0;
};

/// Returns true if points of a cube's side that move against a normal leave the cube at once.
/// @param side  numbered as in SquareOfCube.
[[nodiscard]] inline bool is_lower_side(std::uint32_t side, const Vec3d& normal) {
  return normal[side / 2] * (side % 2 == 1 ? 1 : -1) < -1e-15;
}

/// Components of walls and surface in a passing cube, or of the requested part of the diagram.
struct CubeCells {
  VoronoiObstacle obstacle = VoronoiObstacle::none;
  std::uint32_t component_count = 0;
  /// A square without children on the cube's boundary.
  struct Square {
    CellId square = no_cell;
    std::vector<std::uint32_t> events;              ///< as in SquareCells
    std::vector<std::uint32_t> component_of_event;  ///< in the square; `outside` if the event is dropped
    std::vector<std::uint32_t> component;           ///< for each component in the square: its component in the cube
    std::vector<std::uint32_t> convex_edges;        ///< convex mesh edges that pierce the square; set only for a part
  };
  std::vector<Square> squares;
  std::vector<std::uint32_t> vertices;  ///< vertices of the mesh in the cube; set only for a part
};

/// A cube that does not pass and cannot be split further.
struct FailingCube {
  CellId cube = no_cell;
  VoronoiObstacle obstacle = VoronoiObstacle::none;
};

/// Numbers the components in a cube. Components of its squares get the same number if they are in the same set.
class CubeNumbers {
 public:
  /// @param component_of_event  component in the square, as in CubeCells.
  /// @param first  index of the square's first component in `joined`; the others follow.
  /// @param count  number of components in the square.
  void add(const SquareOfCube& square, std::vector<std::uint32_t> component_of_event, std::uint32_t first,
           std::uint32_t count, detail::UnionFind& joined, CubeCells& out);

 private:
  std::map<std::uint32_t, std::uint32_t> number_;  ///< by set
};

/// Decides from a cube's boundary if all components of walls and surface in the cube are acyclic (have the homology of
/// a point). They are if and only if H0 and H1 of each region in the cube, relative to its part of the boundary, vanish
/// (Lefschetz duality). Each point of a region moves straight to its footprint, or to the point where this segment
/// leaves the cube. So the region retracts to such points. For the criteria and proofs see docs/theory/voronoi.md.
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
