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

/// Decides whether a square is resolved. In a resolved square, the region of each site is connected and touches the
/// border. The surface consists of arcs that end on the border. Then the components of walls and surface in the square
/// are contractible, and its border determines them (SquareCells).
///
/// A label that is closest nowhere on the border must be proven absent. To this end, the part of the square in its
/// domain is covered by pieces. Each piece lies in the domain of another label that is closer all over the piece. A
/// site on the border must be star-shaped about a point of the border, as seen by each of the other labels. That is:
/// along each ray, once another label is closer, the site stays behind. The region of a vertex is convex.
/// The test is one-sided: rounding only leads to another split.
class SquareTest {
 public:
  SquareTest(const LabelGeometry& labels, const SurfaceInCells& surface, const CellTree& tree)
      : labels_(labels), surface_(surface), tree_(tree) {}

  /// Returns true if the square is resolved, and then sets its chains.
  bool resolve(GridSquare& square) const;

  using Polygon = std::vector<Vec3d>;
  /// Returns a strip of a square that contains the places where a plane of a label's domain bounds that domain.
  [[nodiscard]] Polygon along_plane(LabelIndex label, const DomainPlane& plane, const GridSquare& square) const;
  /// Returns true if a label is proven to be closest nowhere in a part of a square.
  [[nodiscard]] bool is_closest_nowhere(LabelIndex label, std::span<const LabelIndex> all, const Polygon& part) const;

 private:
  /// An arc of the border, relative to the centre of the labels.
  struct BorderArc {
    LabelIndex label = outside;
    Vec3d low, high;
    double error = 0;
  };

  /// Means to exclude a label, in addition to labels that are closer.
  struct Allowance {
    bool by_incident = false;             ///< the domain of an incident label, which shares only its border
    std::optional<std::uint32_t> vertex;  ///< a corner of it, if the rest lies next to a point over that corner
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
  /// A site on the border of a square.
  struct SiteInSquare {
    LabelIndex on_border = outside;      ///< one of its labels
    std::span<const LabelIndex> labels;  ///< its own labels that may be in the square
    std::span<const LabelIndex> all;     ///< labels of all sites
  };
  [[nodiscard]] bool never_meet(const SiteInSquare& own, LabelIndex other, const Vec3d& from,
                                const Polygon& of_other) const;
  [[nodiscard]] bool stays_behind(LabelIndex label, LabelIndex other, const Vec3d& from, const Polygon& square) const;

  const LabelGeometry& labels_;
  const SurfaceInCells& surface_;
  const CellTree& tree_;
};

/// Decides whether a square is resolved for a part of the diagram. Then it is resolved for all of the diagram
/// (SquareTest). The dropped walls between its pieces are known, and no component of the part lies strictly inside.
///
/// A dropped wall that the border does not show may lie between pieces that touch one component of walls. Then a point
/// of it must be found at which nothing else is as close. Or its place must be proven to be closest to other labels.
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

  /// Returns true if the square is resolved, and then sets its inner arcs.
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
  /// Returns a vertex relative to the centre of the labels.
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
