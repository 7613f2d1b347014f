#include "blum/voronoi/voronoi_complex.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <new>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/complex/homology.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/solid/solid.hpp"
#include "blum/voronoi/failing_cells.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "voronoi/assemble.hpp"
#include "voronoi/planes/plane_complex.hpp"
#include "voronoi/subdivision.hpp"
#include "voronoi/traced/label_error.hpp"
#include "voronoi/traced/proof/structure_proof.hpp"
#include "voronoi/traced/traced_complex.hpp"
#include "voronoi/traced/traced_sites.hpp"
#include "voronoi/traced/traced_structure.hpp"

namespace blum {
namespace {

using namespace voronoi;

void check(const VoronoiOptions& options) {
  const auto check_range = [](const char* name, std::int64_t value, std::int64_t least, std::int64_t most) {
    if (value >= least && value <= most) return;
    throw InvalidOption("Voronoi complex: " + std::string(name) + " must be " + std::to_string(least) + " to " +
                        std::to_string(most) + ", not " + std::to_string(value));
  };
  check_range("resolution", options.resolution, 1, 1024);
  check_range("depth", options.depth, 1, 24);
  check_range("grids", options.grids, 1, 100);
  check_range("max_cubes", options.max_cubes, 1000, 100'000'000);
  if (options.flatness && !(*options.flatness >= 0 && std::isfinite(*options.flatness))) {
    throw InvalidOption("Voronoi complex: flatness must be 0 or more, not " + exact_text(*options.flatness));
  }
  if (options.tolerance && !(*options.tolerance > 0 && std::isfinite(*options.tolerance))) {
    throw InvalidOption("Voronoi complex: tolerance must be above 0, not " + exact_text(*options.tolerance));
  }
}

/// @throws InvalidMesh if the size of the mesh is below 1e-45, or a coordinate is above 1e45. Also if the mesh lies
///   more than 1e8 times its size from the origin, where doubles are too coarse for a grid.
void check_distance(const MeshView& mesh) {
  const Box3 box = bounds(mesh);
  constexpr double smallest = 1e-45;  // exact signs support magnitudes in this range
  constexpr double largest = 1e45;
  if (!(box.diagonal() >= smallest && box.largest_coordinate() <= largest)) {
    throw InvalidMesh("the mesh has a size of " + exact_text(box.diagonal()) + " and coordinates up to " +
                      exact_text(box.largest_coordinate()) +
                      "; Voronoi diagrams need a size of at least 1e-45 and coordinates up to 1e45: scale the mesh");
  }
  constexpr double furthest = 1e8;
  if (box.largest_coordinate() > furthest * box.diagonal()) {
    throw InvalidMesh("the mesh lies more than 1e8 times its size from the origin: move it to the origin first");
  }
}

[[noreturn]] void refuse(std::string_view problem) {
  throw InvalidMesh(std::string(problem));
}

/// @throws InvalidMesh if the solid is not a polyhedron, its mesh has segments or points, or its surface touches
///   itself. Also throws if check_distance() throws.
void check(const Solid& solid) {
  if (solid.rule() != SolidRule::polyhedron) throw InvalidMesh(solid.problem());
  const MeshView surface = solid.surface().mesh;
  if (!surface.segments.empty() || !surface.points.empty()) refuse(mesh_problem::more_than_triangles);
  check_distance(surface);
  check_manifold(solid);
}

/// Returns the volume of the solid in cubic mesh units.
double volume_of(const Solid& solid) {
  double sum = 0;
  for (const SolidShell& shell : solid.shells()) sum += shell.depth % 2 == 0 ? shell.volume : -shell.volume;
  return sum;
}

/// Returns the smallest depth whose cubes satisfy the resolution and the tolerance. Their side must be at most the
/// box's longest side divided by the resolution, and their diagonal at most the tolerance.
/// @throws InvalidOption if the tolerance needs a depth of more than 12.
int least_depth(const VoronoiOptions& options, const Box3& box) {
  const Vec3d size = box.size();
  const double root = CellSplitter::side_of_root * std::max({size.x, size.y, size.z});
  int depth = 0;
  while ((1 << depth) < CellSplitter::side_of_root * options.resolution) ++depth;
  if (!options.tolerance) return depth;
  constexpr int most = 12;  // about 10^9 cubes if the solid fills the box
  while (depth <= most && std::ldexp(root * std::numbers::sqrt3, -depth) > *options.tolerance) ++depth;
  if (depth <= most) return depth;
  throw InvalidOption("Voronoi complex: a tolerance of " + exact_text(*options.tolerance) +
                      " is too small: it must be at least 6e-4 times the longest side of the mesh");
}

/// Rejects options that cannot succeed. With part `all`, cubes of the requested size must fill the solid.
/// @throws InvalidOption if these cubes are more than max_cubes.
void check_count(const VoronoiOptions& options, int least_depth, const Box3& box, double volume) {
  if (options.part != VoronoiPart::all) return;
  const Vec3d size = box.size();
  const double side = std::ldexp(CellSplitter::side_of_root * std::max({size.x, size.y, size.z}), -least_depth);
  const double least = volume / (side * side * side);
  if (least <= static_cast<double>(options.max_cubes)) return;
  throw InvalidOption("Voronoi complex: the resolution or tolerance needs at least " +
                      std::to_string(static_cast<std::int64_t>(std::min(least, 1e18))) + " cubes, but max_cubes is " +
                      std::to_string(options.max_cubes) +
                      ": use a coarser resolution or tolerance, compute only walls, or raise max_cubes");
}

/// Returns the number of problems of an octree: failing cubes, undecided lines and contradictory nodes.
std::size_t obstacles(const Subdivision& cells) {
  return cells.failing.size() + cells.lines.undecided + cells.contradictions;
}

/// Returns true if another position of the grid may help: there are few problems, or splitting stopped because of a bad
/// position.
bool may_pass_elsewhere(const Subdivision& cells) {
  constexpr std::size_t few = 16;
  constexpr std::size_t share = 10;
  const std::size_t count = obstacles(cells);
  return count > 0 && (count <= few || count * share <= cells.leaves.size() ||
                       cells.lines.undecided + cells.contradictions > Subdivision::most_undecided);
}

void add_failing(std::span<const FailingCube> all, const CellTree& tree, VoronoiReport& report) {
  for (const FailingCube& failing : all) {
    const GridCube& cube = tree.cubes[failing.cube];
    report.failing.push_back({tree.lattice.at(cube.low), tree.lattice.at(cube.high()), failing.obstacle});
  }
}

void add_facts(const Subdivision& cells, const LabelGeometry& labels, VoronoiReport& report) {
  report.thin_vertices = labels.thin_vertices().size();
  report.cubes = cells.leaves.size();
  for (const GridSquare& square : cells.tree.squares) {
    if (square.children != no_cell) continue;
    ++report.squares;
    if (square.state != SquareState::resolved) ++report.undecided_squares;
  }
  for (const CellId leaf : cells.leaves) {
    const std::uint32_t length = cells.tree.cubes[leaf].length;
    report.depth = std::max(report.depth, Lattice::depth + 1 - static_cast<int>(std::bit_width(length)));
  }
  report.splits = cells.splits;
  report.stopped_at_max_cubes = cells.was_full && !cells.failing.empty();
  if (report.cubes > 0) report.governors = static_cast<double>(cells.governors) / static_cast<double>(report.cubes);
  report.lines = cells.lines.parts;
  report.exact_lines = cells.lines.exact + cells.lines.undecided;
  report.undecided_lines = cells.lines.undecided;
  report.contradictions = cells.contradictions;
  add_failing(cells.failing, cells.tree, report);
}

/// Returns the Betti numbers of the requested part (docs/theory/voronoi.md).
/// @param solid  the Betti numbers of the solid.
BettiNumbers expected_betti(const VoronoiSolid& sited, const BettiNumbers& solid) {
  BettiNumbers out = solid;
  if (sited.rule.is_medial()) return out;
  out[2] += static_cast<std::int64_t>(sited.exact.site_count() - sited.labels.thin_vertices().size());
  if (sited.rule.is_all()) {
    out[1] += static_cast<std::int64_t>(sited.loops.hole_count());
  } else {
    out[2] -= static_cast<std::int64_t>(sited.sites.face_count);
  }
  return out;
}

/// Makes the complex of convex bodies, and its report.
void finish_planes(const MeshView& mesh, const SiteTable& table, const ConvexBodies& bodies, VoronoiPart part,
                   PhaseTimer& timer, VoronoiComplex& out, const Context& context) {
  VoronoiReport& report = out.report;
  out.complex = plane_complex(mesh, table, bodies, part);
  timer.lap("complex");
  report.exact = true;
  report.flatness = bodies.flatness;
  report.joined = bodies.joined;
  for (const ConvexBody& body : bodies.bodies) {
    report.faces += body.faces.site.size();
    report.joined_faces.insert(report.joined_faces.end(), body.faces.joined.begin(), body.faces.joined.end());
  }
  std::sort(report.joined_faces.begin(), report.joined_faces.end());
  // Positions are rounded once; joined junctions have moved.
  const Box3 box = bounds(mesh);
  report.hausdorff_bound = bodies.moved + 0x1p-50 * (box.diagonal() + box.largest_coordinate());
  const auto count = static_cast<std::int64_t>(bodies.bodies.size());
  report.expected = {count, 0, part == VoronoiPart::all ? static_cast<std::int64_t>(report.faces) : 0};
  report.found = homology(out.complex.view(), context);
  report.certified = report.found == report.expected;
  timer.lap("homology");
}

/// Returns the Betti numbers of the requested part of a traced diagram.
/// @param solid  the Betti numbers of the solid.
BettiNumbers traced_betti(const TracedSites& sites, VoronoiPart part, const BettiNumbers& solid) {
  BettiNumbers out = solid;
  if (part == VoronoiPart::medial_axis) return out;
  out[2] += static_cast<std::int64_t>(sites.size());
  if (part == VoronoiPart::all) {
    out[1] += static_cast<std::int64_t>(sites.hole_count());
  } else {
    out[2] -= static_cast<std::int64_t>(sites.face_count());
  }
  return out;
}

/// Returns the largest distance of chords from curved seams and sheets.
double chord_of(const VoronoiOptions& options, const Box3& box) {
  constexpr double parts = 32;  // of a cube
  const Vec3d size = box.size();
  const double chord = std::max({size.x, size.y, size.z}) / (parts * options.resolution);
  return options.tolerance ? std::min(chord, 0.5 * *options.tolerance) : chord;
}

/// Returns the triangles of walls whose sites have two footprints.
std::vector<WallTriangle> wall_triangles(const TracedSites& sites, const Complex& complex) {
  std::map<std::int32_t, TracedSites::Index> index;
  for (TracedSites::Index i = 0; i < sites.size(); ++i) index[sites[i].number] = i;
  const auto first = complex.triangle_columns.get<std::int32_t>("site_a");
  const auto second = complex.triangle_columns.get<std::int32_t>("site_b");
  const auto angles = complex.triangle_columns.get<float>(medial_columns::separation_angle);
  std::vector<WallTriangle> out;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    if (first[t] < 0 || !(angles[t] > 0)) continue;
    WallTriangle& wall = out.emplace_back();
    wall.sites = {index[first[t]], index[second[t]]};
    for (std::size_t k = 0; k < 3; ++k) wall.corners[k] = complex.positions[complex.triangles[t][k]] - sites.origin();
  }
  return out;
}

void add_proof(const TracedSites& sites, const StructureProof& proof, VoronoiReport& report) {
  report.moved = proof.moved;
  report.junctions = proof.junctions;
  report.proven_junctions = proof.proven_junctions;
  report.seams = proof.seams;
  report.proven_seams = proof.proven_seams;
  for (const OpenPlace& place : proof.open) {
    OpenVoronoiPlace& out = report.open.emplace_back();
    out.position = place.at + sites.origin();
    out.size = place.size;
    out.doubt = place.doubt;
    for (const TracedSites::Index i : place.sites) out.sites.push_back(static_cast<std::uint32_t>(sites[i].number));
    std::sort(out.sites.begin(), out.sites.end());
  }
}

/// Returns VoronoiReport::joined_faces.
std::vector<std::array<std::uint32_t, 2>> joined_faces(const TracedSites& sites, const PolyhedronSites& exact) {
  std::vector<std::array<std::uint32_t, 2>> out;
  for (std::uint32_t t = 0; t < exact.face_of.size(); ++t) {
    const auto joined = static_cast<std::uint32_t>(sites[sites.face_of(t)].number);
    if (joined != exact.face_of[t]) out.push_back({exact.face_of[t], joined});
  }
  detail::sort_unique(out);
  return out;
}

constexpr const char* wrong_betti = "the traced diagram does not have the expected Betti numbers";

/// Traces the diagram with one effort.
/// @param left  work that tracing may still do, > 0. It is reduced by the work that was done.
/// @return the reason why this is impossible; empty if it succeeded.
std::string trace(const Solid& solid, const SiteTable& table, const TracedSites& sites, TraceEffort effort,
                  std::uint64_t& left, const VoronoiOptions& options, PhaseTimer& timer, VoronoiComplex& out,
                  const Context& context) {
  const MeshView mesh = solid.surface().mesh;
  const TracedResult traced = traced_structure(sites, effort, std::min(left, usual_work(sites)), context);
  timer.lap("traces");
  left -= std::min(left, traced.work);
  if (!traced.structure) {
    const Vec3d place = traced.place + sites.origin();
    return traced.problem + " near " + exact_text(place.x) + ", " + exact_text(place.y) + ", " + exact_text(place.z);
  }
  const double chord = chord_of(options, bounds(mesh));
  const auto complex_of = [&](VoronoiPart part) {
    // The balls of a medial axis represent the solid, so their centres must be as dense as with cubes.
    const Vec3d size = bounds(mesh).size();
    const double cube = std::max({size.x, size.y, size.z}) / options.resolution;
    const double longest = part == VoronoiPart::medial_axis ? cube : std::numeric_limits<double>::infinity();
    return traced_complex(mesh, table, sites, *traced.structure, part, chord, longest, context);
  };
  std::optional<Complex> all = complex_of(VoronoiPart::all);
  timer.lap("complex");
  if (!all) return "a sheet cannot be divided into triangles";
  VoronoiReport& report = out.report;
  report.expected = traced_betti(sites, VoronoiPart::all, *solid.betti());
  report.found = homology(all->view(), context);
  timer.lap("homology");
  if (report.found != report.expected) return wrong_betti;
  if (options.part == VoronoiPart::all) {
    out.complex = std::move(*all);
  } else {
    out.complex = *complex_of(options.part);
    timer.lap("complex");
    report.expected = traced_betti(sites, options.part, *solid.betti());
    report.found = homology(out.complex.view(), context);
    timer.lap("homology");
  }
  // Points between the corners are up to twice the chord from the wall, so a bound below that would need no end of
  // parts.
  constexpr double in_chords = 4;
  const std::vector<WallTriangle> walls = wall_triangles(sites, out.complex);
  report.label_error = label_error(sites, mesh, table, walls, in_chords * chord, context);
  timer.lap("errors");
  add_proof(sites, prove_structure(sites, mesh, table, *traced.structure, context), report);
  timer.lap("proof");
  report.traced = true;
  report.joined = sites.tolerance();
  report.faces = sites.face_count();
  report.chord = chord;
  report.certified = report.found == report.expected;
  report.proven = report.certified && report.open.empty();
  return {};
}

/// Traces the diagram with the usual effort, and with more if that may help.
/// @return the reason why this is impossible; empty if it succeeded.
std::string trace(const Solid& solid, const SiteTable& table, const TracedSites& sites, std::uint64_t& left,
                  const VoronoiOptions& options, PhaseTimer& timer, VoronoiComplex& out, const Context& context) {
  out.report.reflex_edges = sites.count(SiteKind::edge);
  out.report.reflex_vertices = sites.count(SiteKind::vertex);
  std::string problem = trace(solid, table, sites, TraceEffort::usual, left, options, timer, out, context);
  // More walks across sheets may find what is missing. They do not help against other problems.
  if (problem == wrong_betti && left > 0) {
    problem = trace(solid, table, sites, TraceEffort::full, left, options, timer, out, context);
  }
  return problem;
}

/// Traces the diagram with several methods, until one succeeds. If close places are merged, the result has the
/// structure of symmetric solids. Rounded coordinates break symmetry, and tracing may then succeed with separate
/// places.
void trace(const Solid& solid, const SiteTable& table, const PolyhedronSites& exact, const VoronoiOptions& options,
           PhaseTimer& timer, VoronoiComplex& out, const Context& context) {
  const MeshView mesh = solid.surface().mesh;
  const double flatness = options.flatness ? *options.flatness : rounding_of_coordinates(mesh);
  std::vector<std::pair<double, TracedPlaces>> ways{{flatness, TracedPlaces::merged},
                                                    {flatness, TracedPlaces::separate}};
  if (flatness > 0) ways.emplace_back(0.0, TracedPlaces::separate);
  std::optional<std::uint64_t> left;  // work that all ways together may still do
  std::string problems;
  std::vector<TracedSites::Index> tried;  // the faces of a separate way that failed
  for (const auto& [own, places] : ways) {
    const std::optional<TracedSites> sites = TracedSites::of(mesh, table, exact, own, places);
    timer.lap("sites");
    std::string problem = "joined triangles do not make flat faces";
    if (sites) {
      // Attempts with separate places and the same faces have the same result.
      if (places == TracedPlaces::separate) {
        if (tried == sites->faces()) continue;
        tried = sites->faces();
      }
      if (!left) {
        left = options.method == VoronoiMethod::automatic ? default_work(*sites, mesh.triangles.size())
                                                          : std::numeric_limits<std::uint64_t>::max();
      }
      problem = *left > 0 ? trace(solid, table, *sites, *left, options, timer, out, context)
                          : "tracing " + std::to_string(sites->size()) + " sites is too much work";
      if (out.report.traced) {
        out.report.flatness = 2 * own;
        out.report.joined_faces = joined_faces(*sites, exact);
        return;
      }
    }
    const std::string_view way =
        places == TracedPlaces::merged ? "close junctions merged: " : "close junctions separate: ";
    problems += (problems.empty() ? "" : "; ") + std::string(way) + problem;
    if (left == 0) break;
  }
  out.report.trace_problem = problems;
}

/// Returns true if tracing is tried for solids that are not convex.
bool is_traced(const VoronoiOptions& options) {
  return options.method == VoronoiMethod::automatic ? !options.tolerance : options.method == VoronoiMethod::traced;
}

/// @param phases  phases that were already completed.
VoronoiComplex compute(const Solid& solid, const VoronoiOptions& options, std::vector<PhaseTime> phases,
                       const Context& context) {
  VoronoiComplex out;
  VoronoiReport& report = out.report;
  report.phases = std::move(phases);
  PhaseTimer timer(report.phases);
  check(solid);
  const MeshView mesh = solid.surface().mesh;
  const SiteTable table(mesh, context);
  timer.lap("checks");
  PolyhedronSites sites = polyhedron_sites(mesh, table, context);
  if (options.method != VoronoiMethod::cubes) {
    if (const auto bodies = convex_bodies(mesh, table, sites, options.flatness, context)) {
      timer.lap("planes");
      finish_planes(mesh, table, *bodies, options.part, timer, out, context);
      return out;
    }
  }
  if (is_traced(options)) {
    trace(solid, table, sites, options, timer, out, context);
    if (report.traced) return out;
  }
  const VoronoiSolid sited(mesh, table, std::move(sites), options.part);
  report.faces = sited.sites.face_count;
  report.reflex_edges = sited.sites.reflex_edges.size();
  report.reflex_vertices = sited.sites.reflex_vertices.size();
  timer.lap("sites");
  SubdivisionOptions how;
  how.least_depth = least_depth(options, sited.labels.box());
  check_count(options, how.least_depth, sited.labels.box(), volume_of(solid));
  how.most_depth = std::max(options.depth, how.least_depth);
  how.most_cubes = static_cast<std::size_t>(options.max_cubes);
  const auto divide = [&](int grid) {
    how.grid = grid;
    ++report.grids;
    const auto crossing = [&](const CellTree& tree, std::span<const CellId> leaves) {
      if (sited.rule.is_all()) return std::vector<CellId>();
      const SurfaceInCells surface(mesh, table, tree.lattice);
      return crossing_cubes(tree, leaves, CubeTest(sited, surface, tree), sited, context);
    };
    Subdivision cells = subdivide(sited, how, context, crossing);
    // If refinement made a cube fail, the refinement is omitted. A certified complex matters more than triangles that
    // do not cross the surface.
    if (cells.passed_at_first && !cells.failing.empty()) cells = subdivide(sited, how, context);
    return cells;
  };
  Subdivision cells = divide(0);
  for (int grid = 1; grid < options.grids && may_pass_elsewhere(cells); ++grid) {
    Subdivision other = divide(grid);
    if (obstacles(other) < obstacles(cells)) cells = std::move(other);
  }
  timer.lap("cells");
  add_facts(cells, sited.labels, report);
  const SurfaceInCells surface(mesh, table, cells.tree.lattice);
  Assembled made = assemble(cells.tree, cells.leaves, CubeTest(sited, surface, cells.tree), sited, context);
  out.complex = std::move(made.complex);
  report.hausdorff_bound = made.largest_diagonal;
  add_failing(made.lost, cells.tree, report);
  timer.lap("complex");
  report.found = homology(out.complex.view(), context);
  report.expected = expected_betti(sited, *solid.betti());
  report.certified = report.failing.empty() && report.undecided_lines == 0 && report.contradictions == 0 &&
                     report.found == report.expected;
  timer.lap("homology");
  return out;
}

template <class Work>
VoronoiComplex with_memory(const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("a Voronoi complex of this mesh needs more memory than is free: lower max_cubes");
  }
}

}  // namespace

VoronoiComplex voronoi_complex(const Solid& solid, const VoronoiOptions& options, const Context& context) {
  check(options);
  return with_memory([&] { return compute(solid, options, {}, context); });
}

VoronoiComplex voronoi_complex(const MeshView& mesh, const VoronoiOptions& options, const Context& context) {
  check(options);
  validate(mesh);
  return with_memory([&] {
    if (mesh.triangles.empty()) refuse(problem_as_solid({}));
    std::vector<PhaseTime> phases;
    PhaseTimer timer(phases);
    check_distance(mesh);
    const Solid solid = Solid::of(mesh, context);
    if (solid.resolved()) throw InvalidMesh(mesh_problem::crosses_and_is_resolved(solid.reason()));
    timer.lap("checks");
    return compute(solid, options, std::move(phases), context);
  });
}

void add_failing_cells(Complex& complex, std::span<const FailingVoronoiCell> failing) {
  constexpr std::size_t corners = 8;
  if (!complex.edges.empty())
    throw InvalidOption("add_failing_cells(): the complex must not have edges, but it has some");
  const std::size_t first = complex.positions.size();
  if (failing.size() > (max_id_count - first) / corners) {
    throw InvalidOption("add_failing_cells(): the corners of the cells are more vertices than a complex may have");
  }
  std::vector<std::int32_t> obstacles;
  for (const FailingVoronoiCell& cell : failing) {
    const auto base = static_cast<std::uint32_t>(complex.positions.size());
    for (std::uint32_t k = 0; k < corners; ++k) {
      Vec3d corner = cell.low;
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        if ((k >> axis & 1U) != 0) {
          corner[axis] = cell.high[axis];
        } else {
          complex.edges.push_back({base + k, base + (k | 1U << axis)});
          obstacles.push_back(static_cast<std::int32_t>(cell.obstacle));
        }
      }
      complex.positions.push_back(corner);
    }
  }
  complex.vertex_columns.resize(complex.positions.size());
  for (const char* name : {"site_0", "site_1"}) {
    if (complex.vertex_columns.find(name) == nullptr) continue;
    const auto sites = complex.vertex_columns.edit<std::int32_t>(name);
    for (std::size_t k = first; k < sites.size(); ++k) sites[k] = -1;
  }
  complex.edge_columns = Columns(complex.edges.size());
  complex.edge_columns.add({"obstacle", 1, std::move(obstacles)});
}

}  // namespace blum
