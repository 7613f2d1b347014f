// Blum: test that the border of a square determines its contents. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "voronoi/cell_tree.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/part_cells.hpp"
#include "voronoi/surface_in_cells.hpp"
#include "voronoi/voronoi_solid.hpp"

namespace blum::voronoi {

/// Decides if a square is resolved. In a resolved square, the region of each site is connected and touches the border.
/// The surface consists of arcs that end on the border. Then the components of walls and surface in the square are
/// contractible, and the border determines them (SquareCells).
///
/// If a label is closest nowhere on the border, it must be proven to be closest nowhere in the square. For this,
/// polygons cover the part of the square in the label's domain. On each polygon, another label or a surface point is
/// closer everywhere. The region of a site with points on the border must be star-shaped about one of them. That is: on
/// each ray from this point, once another label is closer than the site, the site does not become closer again. This
/// needs no test for a vertex, whose region is convex. The test is one-sided: rounding may only cause an unnecessary
/// split.
class SquareTest {
 public:
  SquareTest(const LabelGeometry& labels, const SurfaceInCells& surface, const CellTree& tree)
      : labels_(labels), surface_(surface), tree_(tree) {}

  /// Returns true if the square is resolved. Then its state and chains are set.
  bool resolve(GridSquare& square) const;

  using Polygon = std::vector<Vec3d>;
  /// Returns a strip of a square that contains all points of the square where the given plane bounds the label's
  /// domain.
  [[nodiscard]] Polygon along_plane(LabelIndex label, const DomainPlane& plane, const GridSquare& square) const;
  /// Returns true if a label is proven to be closest nowhere in a polygon.
  [[nodiscard]] bool is_closest_nowhere(LabelIndex label, std::span<const LabelIndex> all, const Polygon& part) const;

 private:
  /// An arc of the border with one closest label. Positions are relative to the centre of the labels.
  struct BorderArc {
    LabelIndex label = outside;
    Vec3d low, high;
    double error = 0;
  };

  /// Additional ways to exclude a label where no other label is closer.
  struct Allowance {
    bool by_incident = false;             ///< exclude it in the domains of incident labels
    std::optional<std::uint32_t> vertex;  ///< exclude it near a point over this corner
  };

  [[nodiscard]] bool is_absent(LabelIndex label, std::span<const LabelIndex> all, const Polygon& whole) const;
  [[nodiscard]] bool is_over_one_vertex(std::span<const LabelIndex> present, const Polygon& whole) const;
  [[nodiscard]] bool is_near_corner(LabelIndex label, std::uint32_t v, const Polygon& whole) const;
  [[nodiscard]] std::vector<std::uint32_t> sites_of_one_run(const GridSquare& square) const;
  [[nodiscard]] std::vector<BorderArc> border(const GridSquare& square) const;
  [[nodiscard]] Polygon polygon(const GridSquare& square) const;
  [[nodiscard]] bool is_absent(LabelIndex label, std::span<const LabelIndex> all, Polygon part,
                               const Allowance& allowed, int depth) const;
  [[nodiscard]] std::vector<DomainPlane> attained_between(LabelIndex label, bool from_behind) const;
  [[nodiscard]] bool is_attained(LabelIndex label, bool from_behind, const Vec3d& q) const;
  [[nodiscard]] bool is_behind(LabelIndex label, const Vec3d& q) const;
  [[nodiscard]] bool is_at_corner(const Polygon& part, std::uint32_t v, std::span<const LabelIndex> all) const;
  [[nodiscard]] bool is_thin(LabelIndex label, Polygon part) const;
  [[nodiscard]] bool is_absent_outside(LabelIndex label, std::span<const DomainPlane> planes,
                                       std::span<const LabelIndex> all, Polygon part, const Allowance& allowed,
                                       int depth) const;
  [[nodiscard]] Polygon not_further(LabelIndex label, LabelIndex other, const std::optional<Bisector>& plane,
                                    const Polygon& part) const;
  [[nodiscard]] bool is_further(LabelIndex label, LabelIndex other, const std::optional<Bisector>& plane,
                                const Polygon& part) const;
  [[nodiscard]] bool is_star_shaped(std::uint32_t site, std::span<const BorderArc> arcs,
                                    std::span<const LabelIndex> others, const Polygon& square) const;
  [[nodiscard]] bool returns_nowhere(LabelIndex label, LabelIndex other, const Vec3d& from,
                                     const Polygon& domain) const;
  [[nodiscard]] Polygon in_domain(LabelIndex label, Polygon part) const;
  /// A site that is closest to points on the border of a square.
  struct SiteInSquare {
    LabelIndex on_border = outside;      ///< one of its labels that is closest on the border
    std::span<const LabelIndex> labels;  ///< labels of the site that may be closest in the square
    std::span<const LabelIndex> all;     ///< labels of all sites that may be closest in the square
  };
  [[nodiscard]] bool never_meet(const SiteInSquare& own, LabelIndex other, const Vec3d& from,
                                const Polygon& of_other) const;
  [[nodiscard]] bool stays_behind(LabelIndex label, LabelIndex other, const Vec3d& from, const Polygon& square) const;

  const LabelGeometry& labels_;
  const SurfaceInCells& surface_;
  const CellTree& tree_;
};

/// Decides if a square is resolved for the requested part of the diagram. It must be resolved for the whole diagram
/// (SquareTest). All dropped walls between its pieces must be known. No component of the part may lie strictly inside.
///
/// A dropped wall without an event on the border may lie between two pieces that touch the same component of walls.
/// Such a wall exists if a point with no closer third site is found on it. It does not exist if all its possible points
/// are proven to be closer to other labels. In all other cases the square is not resolved.
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

  /// Returns true if the square is resolved. Then its inner arcs are set.
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
  /// Returns the position of a vertex relative to the centre of the labels.
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
