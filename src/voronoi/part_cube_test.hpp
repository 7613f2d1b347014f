// Blum: test that a part of the diagram in a cube is contractible. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "blum/core/union_find.hpp"
#include "voronoi/cube_test.hpp"
#include "voronoi/part_cells.hpp"
#include "voronoi/voronoi_solid.hpp"

namespace blum::voronoi {

/// Contents of a cube in which all components of walls and surface are acyclic (have the homology of a point).
struct CubeContents {
  const GridCube& cube;
  std::span<const SquareOfCube> squares;
  std::uint32_t component_count = 0;                        ///< number of components of walls and surface in the cube
  std::span<const std::uint32_t> vertices, edges;           ///< of the mesh, in the cube; ascending
  std::span<const std::array<std::uint32_t, 2>> piercings;  ///< (edge of the mesh, index of the square)
  std::size_t face_parts = 0;                               ///< number of connected parts of faces in the cube
  bool has_inner_face = false;                              ///< true if one of these parts does not reach the boundary
};

/// Decides if all components of the requested part of the diagram in a cube are acyclic, and which components on the
/// boundary they connect. They are acyclic if each dropped wall in the cube reaches the boundary. Their number is that
/// of all components of walls and surface, minus the Euler numbers of what is dropped (docs/theory/voronoi.md,
/// "Parts").
class PartOfCube {
 public:
  PartOfCube(const VoronoiSolid& solid, const CellTree& tree, const CubeContents& contents)
      : solid_(solid), tree_(tree), in_(contents) {}

  /// Returns the obstacle, if any. Otherwise fills in the components and returns `none`.
  [[nodiscard]] VoronoiObstacle find(CubeCells& out);

 private:
  using Pair = std::array<std::uint32_t, 2>;
  /// For each pair of sites: the squares in which a wall between them is dropped.
  using WallsOnBoundary = std::map<Pair, std::vector<std::uint32_t>>;

  void collect();
  [[nodiscard]] bool join_events();
  [[nodiscard]] VoronoiObstacle add_dropped_walls();
  [[nodiscard]] VoronoiObstacle add_edge_walls(const Pair& sites, const std::vector<std::uint32_t>& squares);
  [[nodiscard]] bool is_any_wall_inside() const;
  [[nodiscard]] VoronoiObstacle add_thin_regions();
  /// Euler number and number of connected parts of a thin region on the cube's boundary.
  struct ThinOnBoundary {
    std::int64_t euler = 0;
    std::int64_t parts = 0;
  };
  [[nodiscard]] ThinOnBoundary thin_on_boundary(std::uint32_t v) const;
  [[nodiscard]] bool may_end_inside(std::uint32_t v) const;
  void add_lines_and_points();
  void number_components(CubeCells& out);

  const VoronoiSolid& solid_;
  const CellTree& tree_;
  const CubeContents& in_;
  std::vector<PartSquare> parts_;
  std::vector<std::uint32_t> first_;  ///< for each square: index of its first component in joined_
  detail::UnionFind joined_;
  WallsOnBoundary walls_;
  std::map<Pair, std::vector<Pair>> events_of_walls_;  ///< by pair of sites: both squares of each dropped event
  std::set<Pair> corners_;                             ///< (face, vertex)
  std::set<std::uint32_t> thin_;                       ///< thin vertices whose regions meet edges of the grid
  std::int64_t euler_ = 0;                             ///< Euler number of all that is dropped in the cube
};

}  // namespace blum::voronoi
