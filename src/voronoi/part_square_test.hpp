// Blum: whether the border of a square tells a part of the diagram in it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "voronoi/part_cells.hpp"
#include "voronoi/square_test.hpp"
#include "voronoi/surface_chains.hpp"
#include "voronoi/voronoi_solid.hpp"

namespace blum::voronoi {

/// Decides whether a square is resolved for a part of the diagram: all of the diagram is (SquareTest), it is known
/// which pieces have dropped walls in common, and no component of the part lies strictly inside.
///
/// A dropped wall that the border does not show may lie between pieces that touch one component of walls: then some
/// point of it must be found at which nothing else is as close, or its place proven to be closest to other labels.
class PartSquareTest {
 public:
  PartSquareTest(const VoronoiSolid& solid, const SquareTest& test, const SurfaceInCells& surface, const CellTree& tree)
      : mesh_(solid.mesh),
        test_(test),
        rule_(solid.rule),
        labels_(solid.labels),
        surface_(surface),
        sites_(solid.sites),
        tree_(tree) {}

  /// Whether it is resolved; then its inner arcs are set.
  bool resolve(GridSquare& square) const;

 private:
  enum class Answer : std::uint8_t { no, yes, unknown };

  void add_surface(const SurfaceChains& chains, GridSquare& square) const;
  [[nodiscard]] bool add_walls(const SquareCells& cells, GridSquare& square) const;
  [[nodiscard]] Answer have_wall(std::uint32_t low, std::uint32_t high, const GridSquare& square) const;
  [[nodiscard]] std::optional<DomainPlane> plane_between(LabelIndex edge, std::uint32_t other,
                                                         const std::optional<std::uint32_t>& vertex) const;
  [[nodiscard]] bool is_closest_on(const std::vector<Vec3d>& strip, LabelIndex label, std::uint32_t beside,
                                   const GridSquare& square) const;
  /// Relative to the centre of the labels.
  [[nodiscard]] Vec3d place_of(std::uint32_t v) const { return mesh_.vertices[v] - labels_.centre(); }
  [[nodiscard]] bool have_wall_at_vertex(const Vec3d& v, const std::array<Vec3d, 2>& rays,
                                         const GridSquare& square) const;
  [[nodiscard]] bool is_closest(LabelIndex label, std::uint32_t beside, const Vec3d& q, const GridSquare& square) const;

  const MeshView mesh_;
  const SquareTest& test_;
  const PartRule& rule_;
  const LabelGeometry& labels_;
  const SurfaceInCells& surface_;
  const PolyhedronSites& sites_;
  const CellTree& tree_;
};

}  // namespace blum::voronoi
