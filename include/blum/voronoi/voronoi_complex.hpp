// Blum: the Voronoi diagram inside a polyhedron as a certified complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
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
  medial_axis,  ///< Walls whose points have two footprints. Walls between a face and its own reflex edge, or between an
                ///< edge and its own end, are left out. Walls between two edges on one line are left out, too.
};

template <>
struct Description<VoronoiPart> {
  static constexpr std::string_view name = "VoronoiPart";
  static constexpr std::array values{NamedValue{VoronoiPart::all, "all"}, NamedValue{VoronoiPart::walls, "walls"},
                                     NamedValue{VoronoiPart::medial_axis, "medial"}};
};

/// Method that computes a Voronoi complex.
enum class VoronoiMethod : std::uint8_t {
  automatic,  ///< Planes if all bodies are convex, otherwise traced seams. Cubes if tracing fails or takes long. If a
              ///< tolerance is given, cubes instead of seams: only cubes bound the distance from the exact diagram.
  cubes,      ///< Cubes of an octree, each with a proof of its topology.
  traced,     ///< Planes if all bodies are convex, otherwise traced seams, which may take minutes. If tracing
              ///< fails, cubes.
};

template <>
struct Description<VoronoiMethod> {
  static constexpr std::string_view name = "VoronoiMethod";
  static constexpr std::array values{NamedValue{VoronoiMethod::automatic, "auto"},
                                     NamedValue{VoronoiMethod::cubes, "cubes"},
                                     NamedValue{VoronoiMethod::traced, "traced"}};
};

struct VoronoiOptions {
  /// Part of the diagram that the complex represents.
  VoronoiPart part = VoronoiPart::all;
  VoronoiMethod method = VoronoiMethod::automatic;
  /// Planes and traces: triangles form one face if their corners lie within this distance of one plane, >= 0, mesh
  /// units. For traces, twice this distance is allowed. Junctions and seams of planes within 8 times this distance are
  /// joined. With 0, the mesh is used as given. Default: 16 times the rounding error of the largest coordinate. The
  /// rounding error is 0 if the longest coordinate has up to 20 binary digits. For 21 to 24 digits, it is that of
  /// single precision. Cubes: ignored.
  std::optional<double> flatness = {};
  /// Limit for the side of cubes that meet the solid. The limit is the longest side of the solid's box, divided by this
  /// number, 1 to 1024. Chords of traced seams and walls are within 1/32 of this limit. Edges of traced medial axes are
  /// at most about as long as this limit. Planes: ignored.
  int resolution = 16;
  /// Largest diagonal of cubes that meet the solid, > 0, mesh units. The limit of `resolution` also applies. With a
  /// tolerance, VoronoiMethod::automatic traces no seams. Chords of traced seams are within half the tolerance.
  std::optional<double> tolerance = {};
  /// The options below apply only if cubes are used. To use cubes, set `method` or `tolerance`.
  /// Largest number of successive splits that lead to a cube, 1 to 24. More splits are made if `resolution` or
  /// `tolerance` requires them.
  int depth = 24;
  /// Largest number of positions of the grid that are tried, 1 to 100. If only a few cubes fail the test, all cubes may
  /// pass it at another position of the grid.
  int grids = 4;
  /// Largest number of cubes, including those that are split, 1,000 to 100,000,000. If this number is reached,
  /// splitting ends, and cubes that do not pass the test are reported. Each cube takes about 10 kB of memory.
  std::int64_t max_cubes = 1'000'000;
};

template <>
struct Description<VoronoiOptions> {
  static constexpr std::string_view name = "VoronoiOptions";
  static constexpr std::string_view doc = "Options of a Voronoi complex";
  static constexpr std::tuple members{
      Member{"part", &VoronoiOptions::part, "",
             "all: walls and surface; walls: without the surface; medial: only walls with two footprints"},
      Member{"method", &VoronoiOptions::method, "",
             "auto: planes if all bodies are convex, otherwise traced seams, cubes if these fail or take long; "
             "cubes: always; traced: even if it takes minutes"},
      Member{"flatness", &VoronoiOptions::flatness, "mesh units",
             "planes and traces: triangles within this distance of one plane are one face; default: the rounding of "
             "coordinates",
             Range::at_least(0)},
      Member{"resolution", &VoronoiOptions::resolution, "",
             "longest side of the box around the solid, divided by the largest side of cubes that meet the solid",
             Range::between(1, 1024)},
      Member{"tolerance", &VoronoiOptions::tolerance, "mesh units",
             "largest distance between the complex and the exact walls", Range::positive()},
      Member{"depth", &VoronoiOptions::depth, "", "largest number of splits of a cube", Range::between(1, 24)},
      Member{"grids", &VoronoiOptions::grids, "",
             "largest number of grid positions that are tried: if few cubes fail, another position may have none that "
             "fails",
             Range::between(1, 100)},
      Member{"max_cubes", &VoronoiOptions::max_cubes, "",
             "largest number of cubes, including split ones: about 10 kB each", Range::between(1000, 100'000'000)},
  };
};

/// Reason why a cube does not pass the test.
enum class VoronoiObstacle : std::uint8_t {
  none,
  square,        ///< The border of a square of the cube does not determine the diagram in the square.
  tunnel,        ///< The region of a site passes through the cube, or possibly passes through it.
  enclosed,      ///< The region of a site lies wholly inside the cube, or possibly lies inside it.
  face_hole,     ///< A hole of a face lies in the cube, or next to it.
  handle,        ///< A component of the solid in the cube has a tunnel, or more than one boundary component.
  joins,         ///< It is unknown which walls on the cube's boundary are connected inside the cube.
  contradiction  ///< Results for the cube's lines contradict each other.
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

/// Cube that does not pass the test, and was not split further.
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
      Member{"obstacle", &FailingVoronoiCell::obstacle, "", "reason why the cube does not pass"},
  };
};

/// Reason why a junction or a piece of a seam is not proven.
enum class VoronoiDoubt : std::uint8_t {
  close,       ///< Other sites are nearly as close as the closest sites, or sites meet at angles that are too small.
  degenerate,  ///< More sites are equally close than in general position, or the number of these sites is uncertain.
  seams        ///< The number of seams at the junction differs from that in general position.
};

template <>
struct Description<VoronoiDoubt> {
  static constexpr std::string_view name = "VoronoiDoubt";
  static constexpr std::array values{NamedValue{VoronoiDoubt::close, "close"},
                                     NamedValue{VoronoiDoubt::degenerate, "degenerate"},
                                     NamedValue{VoronoiDoubt::seams, "seams"}};
};

/// Junction, or piece of a seam, of a traced diagram that is not proven.
struct OpenVoronoiPlace {
  Vec3d position{};                  ///< Mesh units.
  double size = 0;                   ///< Size of the part that is not proven, mesh units.
  std::vector<std::uint32_t> sites;  ///< Closest sites, as in VoronoiComplex::complex, ascending.
  VoronoiDoubt doubt = VoronoiDoubt::close;
};

template <>
struct Description<OpenVoronoiPlace> {
  static constexpr std::string_view name = "OpenVoronoiPlace";
  static constexpr std::string_view doc = "Junction, or piece of a seam, that is not proven";
  static constexpr std::tuple members{
      Member{"position", &OpenVoronoiPlace::position, "mesh units", "of the place"},
      Member{"size", &OpenVoronoiPlace::size, "mesh units", "of the place"},
      Member{"sites", &OpenVoronoiPlace::sites, "", "numbers of the closest sites"},
      Member{"doubt", &OpenVoronoiPlace::doubt, "",
             "close: other sites are nearly as close; degenerate: more sites than in general position; seams: not the "
             "number of seams of general position"},
  };
};

struct VoronoiReport {
  /// True if every cube passes the test, no signs contradict each other, and the Betti numbers are the expected ones.
  /// If true, the complex provably has the homology of the requested part of the exact diagram. If the diagram is exact
  /// or traced, there are no cubes, and only the Betti numbers are checked.
  bool certified = false;
  /// True if all bodies are convex, and the method was not `cubes`. If true, each sheet, seam and junction is that of
  /// the exact diagram of the bodies' planes. See VoronoiReport::flatness and VoronoiReport::joined.
  bool exact = false;
  double flatness = 0;  ///< If exact or traced: bound on a corner's distance from its face's plane, mesh units.
  double joined = 0;    ///< If exact or traced: junctions and seams within this distance are joined, mesh units.
  /// If exact or traced: pairs of faces of polyhedron_sites(), ascending. The first face was joined to the second,
  /// which has a smaller number. Edges and vertices inside a joined face have no regions.
  std::vector<std::array<std::uint32_t, 2>> joined_faces;
  /// True if the seams were traced (VoronoiMethod::traced). If true, checks suggest that sheets, seams and junctions
  /// are those of the diagram within `joined`. All sheets are closed, and the Betti numbers are as expected.
  bool traced = false;
  /// If traced: bound, over all points of walls with two footprints, on the distance from the wall's sites minus that
  /// from the border. A wall of the exact diagram that the complex lacks cannot change distances by more.
  double label_error = 0;
  /// If traced: largest distance of chords from curved seams and walls, at their middles, and largest error of radii
  /// between vertices, mesh units.
  double chord = 0;
  /// True if traced, and all junctions and seams are proven. Then each sheet, seam and junction is that of the exact
  /// diagram of a polyhedron with flat faces. Its corners are within `moved` of the corners of the mesh.
  bool proven = false;
  /// If traced: largest displacement of a corner to make the faces flat, mesh units. 0 if the given faces are flat,
  /// except for rounding.
  double moved = 0;
  /// If traced: numbers of junctions inside the solid and of seams, in the whole diagram.
  std::size_t junctions = 0;
  std::size_t seams = 0;
  /// If traced: numbers of junctions and seams that are proven to exist as they were traced (see `proven`).
  std::size_t proven_junctions = 0;
  std::size_t proven_seams = 0;
  /// If traced: junctions that are not proven, and one unproven piece of each seam that is not proven. Also listed:
  /// reflex vertices that were left out, because their regions are thinner than 1e-7 of their lengths.
  std::vector<OpenVoronoiPlace> open;
  /// If tracing failed: the reason and the position, for each attempt. Some attempts join close junctions, others keep
  /// them apart.
  std::string trace_problem;
  BettiNumbers expected{};  ///< Betti numbers that the requested part of the exact diagram has.
  BettiNumbers found{};     ///< Betti numbers of the complex.
  /// If certified: upper bound on the Hausdorff distance between the complex and the requested part of the exact
  /// diagram, mesh units. The bound is the largest diagonal of a cube that the complex, or this part of the diagram,
  /// meets. If exact, the bound includes rounding and joined junctions. For exact complexes, the exact diagram is that
  /// of the planes, which are within `flatness` of the corners. If traced, the bound is unknown, and the value is 0.
  double hausdorff_bound = 0;
  std::size_t faces = 0;            ///< Faces among the sites.
  std::size_t reflex_edges = 0;     ///< Reflex edges among the sites.
  std::size_t reflex_vertices = 0;  ///< Reflex vertices among the sites.
  /// Reflex vertices whose dual cones (see polyhedron_sites()) are thinner than 1e-3 radians. The region of a thin
  /// vertex is a needle with a width below 1e-3 of its length. The complex represents the needle as part of walls.
  std::size_t thin_vertices = 0;
  std::size_t grids = 0;              ///< Number of positions of the grid that were tried.
  std::size_t cubes = 0;              ///< Number of cubes that meet the solid, and are not split.
  std::size_t squares = 0;            ///< Number of squares between cubes; a split square is counted as its parts.
  std::size_t undecided_squares = 0;  ///< Number of `squares` whose borders do not determine the diagram in them.
  std::size_t splits = 0;             ///< Number of cubes that were split because they did not pass.
  int depth = 0;                      ///< Number of successive splits that led to the smallest cube.
  bool stopped_at_max_cubes = false;  ///< True if VoronoiOptions::max_cubes prevented splits.
  /// Mean over all cubes of the number of triangles, reflex edges and reflex vertices that may be closest to a point of
  /// the cube.
  double governors = 0;
  std::size_t lines = 0;            ///< Segments of grid lines in the solid along which closest sites were searched.
  std::size_t exact_lines = 0;      ///< Number of `lines` that needed exact arithmetic.
  std::size_t undecided_lines = 0;  ///< Number of `lines` that exact signs did not decide either.
  std::size_t contradictions = 0;   ///< Grid nodes with different closest sites on different grid lines.
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
      Member{"exact", &VoronoiReport::exact, "",
             "true if each sheet, seam and junction is that of the exact diagram: all bodies are convex"},
      Member{"flatness", &VoronoiReport::flatness, "mesh units",
             "if exact or traced: bound on the distance of a triangle's corner from its face's plane"},
      Member{"joined", &VoronoiReport::joined, "mesh units",
             "if exact or traced: junctions and seams within this distance are one"},
      Member{"joined_faces", &VoronoiReport::joined_faces, "",
             "pairs of faces: the first one was joined to the second one, since rounding bends them"},
      Member{"traced", &VoronoiReport::traced, "",
             "true if the seams were traced: sheets, seams and junctions are those of the diagram within rounding"},
      Member{"label_error", &VoronoiReport::label_error, "mesh units",
             "if traced: points of walls are at most this much farther from the walls' sites than from the border"},
      Member{"chord", &VoronoiReport::chord, "mesh units",
             "if traced: largest distance of chords from curved seams and walls, at their middles"},
      Member{"proven", &VoronoiReport::proven, "",
             "true if traced, and each sheet, seam and junction is proven to be that of the exact diagram"},
      Member{"moved", &VoronoiReport::moved, "mesh units",
             "if traced: bound on the distance by which corners move so that faces are flat"},
      Member{"junctions", &VoronoiReport::junctions, "", "if traced: junctions of the whole diagram inside the solid"},
      Member{"seams", &VoronoiReport::seams, "", "if traced: seams of the whole diagram"},
      Member{"proven_junctions", &VoronoiReport::proven_junctions, "",
             "if traced: junctions that are proven to exist in the exact diagram"},
      Member{"proven_seams", &VoronoiReport::proven_seams, "",
             "if traced: seams that are proven to exist in the exact diagram"},
      Member{"open", &VoronoiReport::open, "", "if traced: junctions and pieces of seams that are not proven"},
      Member{"trace_problem", &VoronoiReport::trace_problem, "", "reason why tracing failed; empty if it did not"},
      Member{"expected_betti", &VoronoiReport::expected, "",
             "components, tunnels, voids of the requested part of the exact diagram"},
      Member{"found_betti", &VoronoiReport::found, "", "components, tunnels, voids of the complex"},
      Member{"hausdorff_bound", &VoronoiReport::hausdorff_bound, "mesh units",
             "if certified: upper bound on the distance between the complex and the requested part of the exact "
             "diagram"},
      Member{"faces", &VoronoiReport::faces, "",
             "faces among the sites: coplanar triangles that share edges count as one face"},
      Member{"reflex_edges", &VoronoiReport::reflex_edges, "", "reflex edges among the sites"},
      Member{"reflex_vertices", &VoronoiReport::reflex_vertices, "", "reflex vertices among the sites"},
      Member{"thin_vertices", &VoronoiReport::thin_vertices, "",
             "reflex vertices whose dual cones are thinner than 1e-3 radians: their regions count as part of walls"},
      Member{"grids", &VoronoiReport::grids, "", "grid positions that were tried"},
      Member{"cubes", &VoronoiReport::cubes, "", "cubes that meet the solid and are not split"},
      Member{"squares", &VoronoiReport::squares, "", "squares between cubes; of a split square, only the parts count"},
      Member{"undecided_squares", &VoronoiReport::undecided_squares, "",
             "number of squares between cubes whose borders do not determine the diagram in them"},
      Member{"splits", &VoronoiReport::splits, "", "cubes that were split because they did not pass"},
      Member{"depth", &VoronoiReport::depth, "", "number of successive splits that led to the smallest cube"},
      Member{"stopped_at_max_cubes", &VoronoiReport::stopped_at_max_cubes, "", "true if max_cubes prevented splits"},
      Member{"governors", &VoronoiReport::governors, "",
             "mean over all cubes of the number of sites that may be closest to a point of the cube"},
      Member{"lines", &VoronoiReport::lines, "",
             "segments of grid lines in the solid along which closest sites were searched"},
      Member{"exact_lines", &VoronoiReport::exact_lines, "",
             "number of searched segments that needed exact arithmetic"},
      Member{"undecided_lines", &VoronoiReport::undecided_lines, "", "number of searched segments without a decision"},
      Member{"contradictions", &VoronoiReport::contradictions, "",
             "grid nodes for which different lines give different closest sites"},
      Member{"failing", &VoronoiReport::failing, "", "cubes that do not pass at the largest depth"},
      Member{"seconds", &VoronoiReport::phases, "s", "wall-clock time of each phase"},
  };
};

/// Walls and surface of a Voronoi diagram.
struct VoronoiComplex {
  /// Triangles on walls between regions and on the surface.
  ///
  /// Columns of vertices: `radius` (float64, mesh units) is the distance from the closest site, 0 on the surface.
  /// `footprint_0` and `footprint_1` (3 x float64) are the closest points of the surface. If more than two closest
  /// points exist, the two with the largest angle between them are stored. If only one point exists, both columns
  /// contain this point. `site_0` and `site_1` (int32) are the sites of the footprints in the SiteTable.
  /// `separation_angle` (float64, degrees) is the angle between the footprints, seen from the vertex.
  ///
  /// Columns of triangles: `site_a` and `site_b` (int32) are the sites of the regions on the two sides, the smaller
  /// site first. On the surface, `site_a` is -1. `separation_angle` (float32, degrees) is the angle between the two
  /// sites, seen from the middle of the triangle. The column contains 0 on the surface, and where the angle is below
  /// 1e-6 degrees. Corners run counterclockwise as seen from the region of site_b.
  ///
  /// Sites in site_a and site_b are numbered as in voronoi_sites(): first faces, in the order of their smallest
  /// triangles, then reflex edges, then reflex vertices. If faces were joined (VoronoiReport::joined_faces), the
  /// smallest number is used for all of them.
  ///
  /// If VoronoiReport::exact or VoronoiReport::traced, vertices also have the column `junction` (int32): 1 at a
  /// junction, 0 inside a seam or sheet.
  Complex complex;
  VoronoiReport report;
};

/// Computes a complex that represents the Voronoi diagram inside a polyhedron. The sites of the diagram are the faces,
/// reflex edges and reflex vertices of the polyhedron.
///
/// If all bodies are convex, the diagram consists of planar polygons. The distance from the border is the least of the
/// distances from the faces' planes, so its graph bounds a convex polytope in four dimensions. The facets, ridges,
/// edges and vertices of this polytope are regions, sheets, seams and junctions. Exact signs decide which of them
/// exist. Sheets are divided into triangles; some get one vertex in the middle for this. (docs/theory/voronoi.md,
/// "Convex solids".)
///
/// Seams of other solids are traced from junction to junction, as VoronoiMethod states. Sheets between seams are
/// divided into triangles, and the result is checked. (docs/theory/voronoi.md, "Traced solids".) If a check fails, the
/// solid is divided into cubes:
///
/// Let K be the union of the surface and the walls between regions of different sites. An octree in generic position
/// cuts space into cubes. The closest sites along the edges of cubes follow from the order of roots, or from exact
/// signs if doubles do not decide. Squares between cubes are split into smaller squares until the border of each square
/// determines K in the square. A cube passes the test if its boundary proves that all components of K in the cube are
/// acyclic. A cube that does not pass is split.
///
/// If all cubes pass, K has the same homology as the order complex of the pairs (cell, component of K in the cell). The
/// order complex is the result. It has a vertex for each component of K in a cube, in a square and on an edge. (Sud
/// 2006, 5.3 and 5.4; theorem and proof: docs/theory/voronoi.md.)
///
/// If VoronoiReport::certified is false, parts of the complex may be missing or wrong.
///
/// @param solid  polyhedron whose bodies do not touch (Solid::problem()). Sites are those of solid.surface().mesh.
/// Coordinates of this mesh must be 0, or have magnitudes of 1e-45 to 1e45. No magnitude may exceed 1e8 times the size
/// of the mesh. Cubes use triangles as given, so a face that rounding has bent becomes several sites.
/// @throws InvalidMesh if the solid does not meet these conditions; InvalidOption; Cancelled; OutOfMemory.
/// Cost: for n faces of a convex body, about n^2 * 0.2 us on two cores (4,000 faces: 3 s). Traces take about 0.5
/// to 5 ms per site on one core. Cubes take about 0.1 ms on one core and 10 kB of memory each. Meshes of 1,000
/// triangles need thousands to tens of thousands of cubes.
[[nodiscard]] VoronoiComplex voronoi_complex(const Solid& solid, const VoronoiOptions& options = {},
                                             const Context& context = {});

/// Computes the Voronoi diagram of the solid that a mesh bounds, found by Solid::of(). Triangles that face the wrong
/// way are reversed. Reversing triangles does not change the numbers of sites.
/// @param mesh  without segments and points. The mesh must not cross itself, because Solid::of() would then replace the
/// surface. For a mesh that crosses itself, pass Solid::of(mesh) to voronoi_complex(), and use the sites of the Solid's
/// surface.
/// @throws InvalidMesh also if the mesh has segments or points, or crosses itself.
[[nodiscard]] VoronoiComplex voronoi_complex(const MeshView& mesh, const VoronoiOptions& options = {},
                                             const Context& context = {});

}  // namespace blum
