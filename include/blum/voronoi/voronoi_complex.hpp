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

/// What a Voronoi complex is made of.
enum class VoronoiPart : std::uint8_t {
  all,          ///< walls between regions, and the surface
  walls,        ///< without the surface
  medial_axis,  ///< of the walls those whose points have two footprints: none between a face and its own reflex edge,
                ///< or an edge and its end
};

template <>
struct Description<VoronoiPart> {
  static constexpr std::string_view name = "VoronoiPart";
  static constexpr std::array values{NamedValue{VoronoiPart::all, "all"}, NamedValue{VoronoiPart::walls, "walls"},
                                     NamedValue{VoronoiPart::medial_axis, "medial"}};
};

struct VoronoiOptions {
  /// What the complex is made of.
  VoronoiPart part = VoronoiPart::all;
  /// Cubes that meet the solid are at most the side of the box around it over this, 1 to 1024.
  int resolution = 16;
  /// Cubes that meet the solid have a diagonal of at most this, > 0, mesh units; what `resolution` asks for holds, too.
  std::optional<double> tolerance = {};
  /// How often cubes are split at most, 1 to 24.
  int depth = 24;
  /// How many places of the grid are tried at most, 1 to 100: where few cubes fail, others may pass.
  int grids = 4;
  /// No more cubes than this, those that are split included, 1,000 to 100,000,000: what does not pass then is reported.
  /// Each takes about 10 kB.
  std::int64_t max_cubes = 1'000'000;
};

template <>
struct Description<VoronoiOptions> {
  static constexpr std::string_view name = "VoronoiOptions";
  static constexpr std::string_view doc = "What a Voronoi complex is made of, and how fine it is";
  static constexpr std::tuple members{
      Member{"part", &VoronoiOptions::part, "",
             "all: walls and surface; walls: without the surface; medial: of the walls those with two footprints"},
      Member{"resolution", &VoronoiOptions::resolution, "",
             "cubes that meet the solid are at most the longest side of the box around it over this",
             Range::between(1, 1024)},
      Member{"tolerance", &VoronoiOptions::tolerance, "mesh units",
             "the complex is nowhere further from the exact walls than this, nor these from it", Range::positive()},
      Member{"depth", &VoronoiOptions::depth, "", "how often cubes are split at most", Range::between(1, 24)},
      Member{"grids", &VoronoiOptions::grids, "",
             "how many places of the grid are tried at most: where few cubes fail, others may pass",
             Range::between(1, 100)},
      Member{"max_cubes", &VoronoiOptions::max_cubes, "",
             "no more cubes than this, those that are split included: about 10 kB each",
             Range::between(1000, 100'000'000)},
  };
};

/// What keeps a cube from passing.
enum class VoronoiObstacle : std::uint8_t {
  none,
  square,        ///< the inside of one of its squares could not be told from its border
  tunnel,        ///< the region of a site passes through it, or may
  enclosed,      ///< the region of a site lies wholly inside, or may
  face_hole,     ///< a hole of a face lies in it, or next to it
  handle,        ///< a component of the solid in it has a tunnel or a second boundary
  joins,         ///< which walls on its boundary are one inside is not known
  contradiction  ///< signs contradict each other
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

/// A cube that does not pass, at the largest depth.
struct FailingVoronoiCell {
  Vec3d low{};   ///< corner, mesh units
  Vec3d high{};  ///< the corner opposite
  VoronoiObstacle obstacle = VoronoiObstacle::none;
};

template <>
struct Description<FailingVoronoiCell> {
  static constexpr std::string_view name = "FailingVoronoiCell";
  static constexpr std::string_view doc = "A cube in which walls and surface are not known to be contractible";
  static constexpr std::tuple members{
      Member{"low", &FailingVoronoiCell::low, "mesh units", "corner of the cube"},
      Member{"high", &FailingVoronoiCell::high, "mesh units", "the corner opposite"},
      Member{"obstacle", &FailingVoronoiCell::obstacle, "", "what keeps it from passing"},
  };
};

struct VoronoiReport {
  /// Whether every cube passes, all signs agree, and the Betti numbers found are those expected: then the homology of
  /// the complex is proven to be that of the part of the exact diagram that was asked for.
  bool certified = false;
  BettiNumbers expected{};  ///< of the part: from the solid's own, holes of faces and regions
  BettiNumbers found{};     ///< of the complex
  /// Where it is certified: each point of the complex has one of the exact part that is no further away than this, and
  /// each point of that one of the complex; mesh units. The largest diagonal of a cube that either is in.
  double hausdorff_bound = 0;
  std::size_t faces = 0;            ///< sites
  std::size_t reflex_edges = 0;     ///< sites
  std::size_t reflex_vertices = 0;  ///< sites
  /// Of these, vertices whose cones are thinner than 1e-3, radians: their regions, that much narrower than long, count
  /// as part of walls.
  std::size_t thin_vertices = 0;
  std::size_t grids = 0;              ///< places of the grid that were tried
  std::size_t cubes = 0;              ///< that meet the solid, and are not split
  std::size_t squares = 0;            ///< and parts of squares
  std::size_t undecided_squares = 0;  ///< of these, those whose borders do not tell what is inside
  std::size_t splits = 0;             ///< cubes that were split because they did not pass
  int depth = 0;                      ///< how often the smallest cube was split
  bool stopped_at_max_cubes = false;  ///< whether more would have been split, but for VoronoiOptions::max_cubes
  double governors = 0;               ///< labels that may be closest in a cube, mean
  std::size_t lines = 0;              ///< parts of grid lines in the solid whose labels were found
  std::size_t exact_lines = 0;        ///< of these, those where doubles did not tell
  std::size_t undecided_lines = 0;    ///< of these, those where nothing did
  std::size_t contradictions = 0;     ///< nodes of which different sites are told
  std::vector<FailingVoronoiCell> failing;
  std::vector<PhaseTime> phases;  ///< seconds
};

template <>
struct Description<VoronoiReport> {
  static constexpr std::string_view name = "VoronoiReport";
  static constexpr std::string_view doc = "What a Voronoi complex consists of, and whether it is certified";
  static constexpr std::tuple members{
      Member{"certified", &VoronoiReport::certified, "",
             "whether every cube passes and the Betti numbers are as expected: then the homology is proven"},
      Member{"expected_betti", &VoronoiReport::expected, "",
             "components, tunnels, voids of the part that was asked for"},
      Member{"found_betti", &VoronoiReport::found, "", "of the complex"},
      Member{"hausdorff_bound", &VoronoiReport::hausdorff_bound, "mesh units",
             "where certified: how far complex and exact part are from each other at most"},
      Member{"faces", &VoronoiReport::faces, "", "sites: coplanar triangles that share edges are one"},
      Member{"reflex_edges", &VoronoiReport::reflex_edges, "", "sites"},
      Member{"reflex_vertices", &VoronoiReport::reflex_vertices, "", "sites"},
      Member{"thin_vertices", &VoronoiReport::thin_vertices, "",
             "reflex vertices whose cones are thinner than 1e-3: their regions count as part of walls"},
      Member{"grids", &VoronoiReport::grids, "", "places of the grid that were tried"},
      Member{"cubes", &VoronoiReport::cubes, "", "that meet the solid, and are not split"},
      Member{"squares", &VoronoiReport::squares, "", "and parts of squares"},
      Member{"undecided_squares", &VoronoiReport::undecided_squares, "",
             "of these, those whose borders do not tell what is inside"},
      Member{"splits", &VoronoiReport::splits, "", "cubes that were split because they did not pass"},
      Member{"depth", &VoronoiReport::depth, "", "how often the smallest cube was split"},
      Member{"stopped_at_max_cubes", &VoronoiReport::stopped_at_max_cubes, "",
             "whether more would have been split, but for max_cubes"},
      Member{"governors", &VoronoiReport::governors, "", "labels that may be closest in a cube, mean"},
      Member{"lines", &VoronoiReport::lines, "", "parts of grid lines in the solid whose labels were found"},
      Member{"exact_lines", &VoronoiReport::exact_lines, "", "of these, those where doubles did not tell"},
      Member{"undecided_lines", &VoronoiReport::undecided_lines, "", "of these, those where nothing did"},
      Member{"contradictions", &VoronoiReport::contradictions, "", "nodes of which different sites are told"},
      Member{"failing", &VoronoiReport::failing, "", "cubes that do not pass at the largest depth"},
      Member{"seconds", &VoronoiReport::phases, "s", "wall-clock, of each phase"},
  };
};

/// Walls and surface of a Voronoi diagram.
struct VoronoiComplex {
  /// Triangles on walls between regions and on the surface. Columns of vertices: `radius` (float64, mesh units: the
  /// distance from the closest site; 0 on the surface), `footprint_0`, `footprint_1` (3 x float64: the closest points
  /// of the surface; of more than two, those that are seen furthest apart; the same one twice where there is one),
  /// `site_0`, `site_1` (int32: what these lie on, by SiteTable), `separation_angle` (float64: between them, degrees).
  /// Of triangles: `site_a` and `site_b` (int32, the smaller one first: the regions on both sides; -1 and a site on the
  /// surface), `separation_angle` (float32, degrees: at which the middle sees both; 0 below 1e-6, and on the surface).
  /// Corners run counterclockwise as seen from the region of site_b. Sites a and b are numbered as faces, by their
  /// smallest triangle, then reflex edges, then reflex vertices, as polyhedron_sites() lists them.
  Complex complex;
  VoronoiReport report;
};

/// The Voronoi diagram of the faces, reflex edges and reflex vertices of a polyhedron inside it, as a complex.
///
/// K is the union of the walls between regions of different sites and the surface. Space is cut by an octree in generic
/// position: on its edges what is closest is found by the order of roots, by exact signs where doubles do not tell; its
/// squares are split in two dimensions until their borders tell what is inside; a cube passes where what is on its
/// boundary proves that all components of K in it are acyclic, and is split where not. Then K has the homology of the
/// complex of pairs of a cell and a component of K in it, which is what comes out: a vertex for each component in a
/// cube, in a square and on an edge. (Sud 2006, 5.3 and 5.4; the theorem and its proof: docs/theory/voronoi.md.)
///
/// Where the report says that it is not certified, parts are missing from the complex or may be wrong.
///
/// @param solid  a polyhedron whose bodies do not touch (Solid::problem()). Sites are those of its surface().mesh, and
///               coordinates there of magnitude 1e-45 to 1e45, or 0, and at most 1e8 times its size from the origin.
///               Triangles are taken as they are: faces bent by rounding are several sites.
/// @throws InvalidMesh where it is none; InvalidOption; Cancelled; OutOfMemory.
/// Cost: about 0.1 ms and 10 kB per cube on one core; thousands to tens of thousands of cubes for 1,000 triangles.
[[nodiscard]] VoronoiComplex voronoi_complex(const Solid& solid, const VoronoiOptions& options = {},
                                             const Context& context = {});

/// The same of the solid that a mesh bounds, found by Solid::of(). Triangles that face the wrong way are taken the
/// other way round, which changes no number of a site.
/// @param mesh  without segments and points. Where it crosses itself the sites would not be its own, so that its solid
///              is asked for.
/// @throws InvalidMesh also for these.
[[nodiscard]] VoronoiComplex voronoi_complex(const MeshView& mesh, const VoronoiOptions& options = {},
                                             const Context& context = {});

}  // namespace blum
