// Blum: the Voronoi diagram inside a polyhedron as a certified complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// Part of the Voronoi diagram that a complex represents.
enum class VoronoiPart : std::uint8_t {
  all,          ///< Walls between regions, and the surface.
  walls,        ///< Walls without the surface.
  medial_axis,  ///< Walls whose points have two footprints. Walls between a face and its own reflex edge, or an edge
                ///< and its end, are left out. So are walls between edges that form one line.
};

template <>
struct Description<VoronoiPart> {
  static constexpr std::string_view name = "VoronoiPart";
  static constexpr std::array values{NamedValue{VoronoiPart::all, "all"}, NamedValue{VoronoiPart::walls, "walls"},
                                     NamedValue{VoronoiPart::medial_axis, "medial"}};
};

struct VoronoiOptions {
  /// Part of the diagram.
  VoronoiPart part = VoronoiPart::all;
  /// Cubes that meet the solid are at most the side of the box around it, divided by this, 1 to 1024.
  int resolution = 16;
  /// Largest diagonal of cubes that meet the solid, > 0, mesh units. The limit of `resolution` also applies.
  std::optional<double> tolerance = {};
  /// Largest number of times that a cube is split, 1 to 24.
  int depth = 24;
  /// Largest number of positions of the grid that are tried, 1 to 100. If few cubes fail, another position may pass.
  int grids = 4;
  /// Largest number of cubes, including those that are split, 1,000 to 100,000,000. Cubes that do not pass then are
  /// reported. Each takes about 10 kB.
  std::int64_t max_cubes = 1'000'000;
};

template <>
struct Description<VoronoiOptions> {
  static constexpr std::string_view name = "VoronoiOptions";
  static constexpr std::string_view doc = "Options of a Voronoi complex";
  static constexpr std::tuple members{
      Member{"part", &VoronoiOptions::part, "",
             "all: walls and surface; walls: without the surface; medial: only walls with two footprints"},
      Member{"resolution", &VoronoiOptions::resolution, "",
             "longest side of the box around the solid, divided by the largest side of cubes that meet the solid",
             Range::between(1, 1024)},
      Member{"tolerance", &VoronoiOptions::tolerance, "mesh units",
             "largest distance between the complex and the exact walls", Range::positive()},
      Member{"depth", &VoronoiOptions::depth, "", "largest number of splits of a cube", Range::between(1, 24)},
      Member{"grids", &VoronoiOptions::grids, "",
             "largest number of grid positions that are tried: if few cubes fail, others may pass",
             Range::between(1, 100)},
      Member{"max_cubes", &VoronoiOptions::max_cubes, "",
             "largest number of cubes, including split ones: about 10 kB each", Range::between(1000, 100'000'000)},
  };
};

/// Reason why a cube does not pass.
enum class VoronoiObstacle : std::uint8_t {
  none,
  square,        ///< The border of one of its squares does not determine the inside of the square.
  tunnel,        ///< The region of a site passes through it, or may.
  enclosed,      ///< The region of a site lies wholly inside it, or may.
  face_hole,     ///< A hole of a face lies in it, or next to it.
  handle,        ///< A component of the solid in it has a tunnel or a second boundary.
  joins,         ///< It is unknown which walls on its boundary are connected inside.
  contradiction  ///< Signs contradict each other.
};

template <>
struct Description<VoronoiObstacle> {
  static constexpr std::string_view name = "VoronoiObstacle";
  static constexpr std::array values{
      NamedValue{VoronoiObstacle::none, "none"},           NamedValue{VoronoiObstacle::square, "square"},
      NamedValue{VoronoiObstacle::tunnel, "tunnel"},       NamedValue{VoronoiObstacle::enclosed, "enclosed"},
      NamedValue{VoronoiObstacle::face_hole, "face hole"}, NamedValue{VoronoiObstacle::handle, "handle"},
      NamedValue{VoronoiObstacle::joins, "joins"},         NamedValue{VoronoiObstacle::contradiction, "contradiction"}};
};

/// Cube that does not pass, at the largest depth.
struct FailingVoronoiCell {
  Vec3d low{};   ///< Corner, mesh units.
  Vec3d high{};  ///< Opposite corner.
  VoronoiObstacle obstacle = VoronoiObstacle::none;
};

template <>
struct Description<FailingVoronoiCell> {
  static constexpr std::string_view name = "FailingVoronoiCell";
  static constexpr std::string_view doc = "Cube in which walls and surface are not known to be contractible";
  static constexpr std::tuple members{
      Member{"low", &FailingVoronoiCell::low, "mesh units", "corner of the cube"},
      Member{"high", &FailingVoronoiCell::high, "mesh units", "opposite corner"},
      Member{"obstacle", &FailingVoronoiCell::obstacle, "", "reason why it does not pass"},
  };
};

struct VoronoiReport {
  /// True if every cube passes, all signs agree, and the Betti numbers are the expected ones. Then the complex is
  /// proven to have the homology of the requested part of the exact diagram.
  bool certified = false;
  BettiNumbers expected{};  ///< For the part: from the numbers of the solid, of holes in faces, and of regions.
  BettiNumbers found{};     ///< Betti numbers of the complex.
  /// Bound on the Hausdorff distance of the complex and the exact part, if certified, mesh units. It is the largest
  /// diagonal of a cube that either of them meets.
  double hausdorff_bound = 0;
  std::size_t faces = 0;            ///< Faces among the sites.
  std::size_t reflex_edges = 0;     ///< Reflex edges among the sites.
  std::size_t reflex_vertices = 0;  ///< Reflex vertices among the sites.
  /// Reflex vertices whose cones are thinner than 1e-3 radians. Their regions, narrower than long by this factor, count
  /// as part of walls.
  std::size_t thin_vertices = 0;
  std::size_t grids = 0;              ///< Positions of the grid that were tried.
  std::size_t cubes = 0;              ///< Cubes that meet the solid, and are not split.
  std::size_t squares = 0;            ///< Squares, and parts of squares.
  std::size_t undecided_squares = 0;  ///< Squares of these whose borders do not determine the inside.
  std::size_t splits = 0;             ///< Cubes that were split because they did not pass.
  int depth = 0;                      ///< Number of splits that led to the smallest cube.
  bool stopped_at_max_cubes = false;  ///< True if VoronoiOptions::max_cubes prevented splits.
  double governors = 0;               ///< Mean number of labels that may be closest in a cube.
  std::size_t lines = 0;              ///< Parts of grid lines in the solid whose labels were found.
  std::size_t exact_lines = 0;        ///< Lines of these that doubles did not decide.
  std::size_t undecided_lines = 0;    ///< Lines of these that nothing decided.
  std::size_t contradictions = 0;     ///< Nodes with different sites on different lines.
  std::vector<FailingVoronoiCell> failing;
  std::vector<PhaseTime> phases;  ///< Seconds.
};

template <>
struct Description<VoronoiReport> {
  static constexpr std::string_view name = "VoronoiReport";
  static constexpr std::string_view doc = "Counts of a Voronoi complex, and the result of its certification";
  static constexpr std::tuple members{
      Member{"certified", &VoronoiReport::certified, "",
             "true if every cube passes and the Betti numbers are as expected: then the homology is proven"},
      Member{"expected_betti", &VoronoiReport::expected, "", "components, tunnels, voids of the requested part"},
      Member{"found_betti", &VoronoiReport::found, "", "components, tunnels, voids of the complex"},
      Member{"hausdorff_bound", &VoronoiReport::hausdorff_bound, "mesh units",
             "if certified: bound of the distance between the complex and the exact part"},
      Member{"faces", &VoronoiReport::faces, "", "faces among the sites: coplanar triangles that share edges are one"},
      Member{"reflex_edges", &VoronoiReport::reflex_edges, "", "reflex edges among the sites"},
      Member{"reflex_vertices", &VoronoiReport::reflex_vertices, "", "reflex vertices among the sites"},
      Member{"thin_vertices", &VoronoiReport::thin_vertices, "",
             "reflex vertices whose cones are thinner than 1e-3: their regions count as part of walls"},
      Member{"grids", &VoronoiReport::grids, "", "grid positions that were tried"},
      Member{"cubes", &VoronoiReport::cubes, "", "cubes that meet the solid and are not split"},
      Member{"squares", &VoronoiReport::squares, "", "squares and parts of squares"},
      Member{"undecided_squares", &VoronoiReport::undecided_squares, "",
             "those of these whose borders do not determine the inside"},
      Member{"splits", &VoronoiReport::splits, "", "cubes that were split because they did not pass"},
      Member{"depth", &VoronoiReport::depth, "", "number of splits of the smallest cube"},
      Member{"stopped_at_max_cubes", &VoronoiReport::stopped_at_max_cubes, "", "true if max_cubes prevented splits"},
      Member{"governors", &VoronoiReport::governors, "", "mean number of labels that may be closest in a cube"},
      Member{"lines", &VoronoiReport::lines, "", "parts of grid lines in the solid whose labels were found"},
      Member{"exact_lines", &VoronoiReport::exact_lines, "", "those of these that doubles did not decide"},
      Member{"undecided_lines", &VoronoiReport::undecided_lines, "", "those of these that nothing decided"},
      Member{"contradictions", &VoronoiReport::contradictions, "", "nodes with different sites on different lines"},
      Member{"failing", &VoronoiReport::failing, "", "cubes that do not pass at the largest depth"},
      Member{"seconds", &VoronoiReport::phases, "s", "wall-clock time of each phase"},
  };
};

/// Walls and surface of a Voronoi diagram.
struct VoronoiComplex {
  /// Triangles on walls between regions and on the surface.
  ///
  /// Vertices have the column `radius` (float64, mesh units), the distance from the closest site, 0 on the surface.
  /// `footprint_0` and `footprint_1` (3 x float64) are the closest points of the surface. If more than two exist, those
  /// with the largest angle are taken; if only one exists, both are the same. `site_0` and `site_1` (int32) are their
  /// sites in the SiteTable. `separation_angle` (float64, degrees) is the angle between the footprints.
  ///
  /// Triangles have `site_a` and `site_b` (int32), the regions on both sides, the smaller one first; -1 and a site on
  /// the surface. `separation_angle` (float32, degrees) is the angle at which the middle sees both. It is 0 below 1e-6,
  /// and on the surface. Corners run counterclockwise as seen from the region of site_b.
  ///
  /// Numbers of site_a and site_b count faces, by their smallest triangle, then reflex edges, then reflex vertices, as
  /// in polyhedron_sites().
  Complex complex;
  VoronoiReport report;
};

/// Computes the Voronoi diagram of the faces, reflex edges and reflex vertices of a polyhedron inside it, as a complex.
///
/// Let K be the union of the surface and the walls between regions of different sites. An octree in generic position
/// cuts space. On its edges, the order of roots gives the closest sites, or exact signs if doubles do not decide. Its
/// squares are split in two dimensions until their borders determine their inside. A cube passes if its boundary proves
/// that all components of K in it are acyclic; otherwise it is split.
///
/// Then K has the homology of the complex of pairs of a cell and a component of K in it. This complex is the result,
/// with a vertex for each component in a cube, in a square and on an edge. (Sud 2006, 5.3 and 5.4; theorem and proof:
/// docs/theory/voronoi.md.)
///
/// If the report says that it is not certified, parts of the complex may be missing or wrong.
///
/// @param solid  polyhedron whose bodies do not touch (Solid::problem()). Sites are those of its surface().mesh.
///               Coordinates there have magnitude 1e-45 to 1e45, or are 0, and are at most 1e8 times its size from the
///               origin. Triangles are used as given, so faces bent by rounding are several sites.
/// @throws InvalidMesh if the solid is not such a polyhedron; InvalidOption; Cancelled; OutOfMemory.
/// Cost: about 0.1 ms and 10 kB per cube on one core. 1,000 triangles take thousands to tens of thousands of cubes.
[[nodiscard]] VoronoiComplex voronoi_complex(const Solid& solid, const VoronoiOptions& options = {},
                                             const Context& context = {});

/// Computes the Voronoi diagram of the solid that a mesh bounds, found by Solid::of(). Triangles that face the wrong
/// way are reversed, which changes no number of a site.
/// @param mesh  without segments and points. It must not cross itself, because then the sites would not be its own:
///              pass its Solid instead.
/// @throws InvalidMesh also for these.
[[nodiscard]] VoronoiComplex voronoi_complex(const MeshView& mesh, const VoronoiOptions& options = {},
                                             const Context& context = {});

}  // namespace blum
