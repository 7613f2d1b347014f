#include "blum/solid/clean_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/plural.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/solid/oriented_mesh.hpp"
#include "blum/solid/solid.hpp"
#include "blum/solid/solid_warnings.hpp"
#include "solid/clean/mesh_cleaner.hpp"
#include "solid/clean/shrinking_surface.hpp"

namespace blum {
namespace {

using detail::EdgePair;
using detail::ShrinkingSurface;

void check_tolerance(const MeshView& mesh, double tolerance) {
  const double diagonal = bounds(mesh).diagonal();
  constexpr double least = 1e-12;
  if (tolerance >= least * diagonal && tolerance <= diagonal && tolerance > 0) return;
  throw InvalidOption("cleaning a mesh: the tolerance is " + exact_text(tolerance) +
                      ", but must be above 0, and 1e-12 to 1 times the diagonal of the mesh, which is " +
                      rounded_text(diagonal));
}

void check_coordinates(const MeshView& mesh) {
  // Within these limits, fourth powers of lengths neither overflow nor underflow, even for the shortest possible edges.
  constexpr double least = 1e-45;
  constexpr double most = 1e45;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double size = std::abs(mesh.vertices[v][axis]);
        if (size == 0 || (size >= least && size <= most)) continue;
        throw InvalidMesh("vertex " + std::to_string(v) + " has the coordinate " + exact_text(mesh.vertices[v][axis]) +
                          "; for cleaning, it must be 0 or have a magnitude of 1e-45 to 1e45: scale or round the mesh");
      }
    }
  }
}

bool has_area(const ShrinkingSurface& mesh, std::uint32_t t) {
  return !detail::has_no_area(mesh.corners(t));
}

/// Returns which corner of a triangle without area lies between the other two. The test is exact.
std::size_t middle_corner(const std::array<Vec3d, 3>& p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& a = p[(k + 1) % 3];
    const Vec3d& b = p[(k + 2) % 3];
    bool between = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      between = between && (std::min(a[axis], b[axis]) <= p[k][axis] && p[k][axis] <= std::max(a[axis], b[axis]));
    }
    if (between) return k;
  }
  return 0;
}

bool has_flat_triangles(const MeshView& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (detail::has_no_area(triangle_corners(mesh, t))) return true;
  }
  return false;
}

/// Flips the longest sides of triangles without area. The surface stays the same set of points.
/// @return  all triangles after the flips. The number of flips is added to `flips`.
std::vector<Triangle> without_flat_triangles(const MeshView& mesh, std::size_t& flips) {
  std::vector<Triangle> given(mesh.triangles.begin(), mesh.triangles.end());
  std::vector<std::uint32_t> flat;
  for (std::uint32_t t = 0; t < given.size(); ++t) {
    if (detail::has_no_area(triangle_corners(mesh, t))) flat.push_back(t);
  }
  if (flat.empty()) return given;
  ShrinkingSurface surface(mesh);
  // If triangles without area are neighbours, a flip may produce another triangle without area, which is queued. Each
  // flip still leaves one fewer of them in such a row.
  for (std::size_t turn = 0; turn < flat.size() && turn < 4 * given.size(); ++turn) {
    const std::uint32_t t = flat[turn];
    if (has_area(surface, t)) continue;
    const EdgePair edge = surface.opposite_edge(t, surface.triangle(t)[middle_corner(surface.corners(t))]);
    if (edge.apex_left == edge.apex_right || surface.has_edge(edge.apex_left, edge.apex_right)) continue;
    surface.flip(edge);
    ++flips;
    for (const std::uint32_t changed : {edge.left, edge.right}) {
      if (!has_area(surface, changed)) flat.push_back(changed);
    }
  }
  std::copy(surface.triangles().begin(), surface.triangles().end(), given.begin());
  return given;
}

double smallest_height(const MeshView& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    least = std::min(least, detail::least_height(a, b, c));
  }
  return least;
}

/// Copies the remaining triangles and the vertices that they use, in the original order.
void take_result(const ShrinkingSurface& from, std::span<const Vec3d> vertices, TriangleMesh& mesh,
                 std::vector<std::uint32_t>& vertex_of) {
  std::vector<std::uint32_t> number(vertices.size(), 0);
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (from.triangles_at(v).empty()) continue;
    number[v] = static_cast<std::uint32_t>(vertex_of.size());
    vertex_of.push_back(v);
    mesh.vertices.push_back(vertices[v]);
  }
  for (std::uint32_t t = 0; t < from.triangles().size(); ++t) {
    if (from.is_gone(t)) continue;
    const auto& [a, b, c] = from.triangle(t);
    mesh.triangles.push_back({number[a], number[b], number[c]});
  }
}

void check_corners(const MeshView& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (a == b || b == c || c == a) throw InvalidMesh(mesh_problem::doubled_corner(t));
  }
}

/// Checks the result of cleaning.
/// @throws Error if the result is not a sound polyhedron, has other Betti numbers, or deviates by more than the
/// tolerance.
void check_result(const Solid& before, const Solid& after, double deviation, double tolerance) {
  const bool is_sound = after.rule() == SolidRule::polyhedron && !after.resolved() && after.problem().empty() &&
                        problem_of_places(after.surface().mesh).empty();
  if (is_sound && after.betti() == before.betti() && deviation <= tolerance) return;
  throw Error("cleaning a mesh: the result is wrong (" +
              (is_sound ? "its solid has other Betti numbers" : after.problem()) +
              "), which is a bug in Blum: please report it, and use the mesh without cleaning");
}

std::size_t count_named(const MeshView& mesh) {
  std::vector<bool> is_named(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) is_named[v] = true;
  }
  return static_cast<std::size_t>(std::count(is_named.begin(), is_named.end(), true));
}

}  // namespace

CleanedMesh clean_mesh(const Solid& solid, double tolerance, const Context& context) {
  const TriangleMesh& surface = solid.surface().mesh;
  check_manifold(solid);
  check_corners(surface);
  check_tolerance(surface, tolerance);
  check_coordinates(surface);
  CleanReport report;
  report.reversed_triangles = solid.reversed_triangles();
  report.reversed_shells = solid.reversed_shells();
  report.triangles_before = surface.triangles.size();
  report.vertices_before = count_named(surface);
  report.smallest_height_before = smallest_height(surface);
  report.betti_before = *solid.betti();

  detail::MeshCleaner cleaner(surface, tolerance, context);
  cleaner.run();
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;
  take_result(cleaner.mesh(), surface.vertices, mesh, vertex_of);
  if (!solid.surface().vertex_of.empty()) {
    for (std::uint32_t& v : vertex_of) v = solid.surface().vertex_of[v];
  }
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  report.collapses = cleaner.collapses();
  report.flips = cleaner.flips();
  report.deviation = cleaner.deviation();
  report.smallest_height = smallest_height(mesh);
  Solid cleaned = Solid::of(mesh, context);
  check_result(solid, cleaned, report.deviation, tolerance);
  report.betti = *cleaned.betti();
  return {std::move(mesh), std::move(vertex_of), report, std::move(cleaned)};
}

namespace {

/// Cleans a mesh with flat triangles. It flips their sides first, because flat triangles could count as crossings.
CleanedMesh clean_without_flat(const MeshView& all, double tolerance, const Context& context) {
  const OrientedMesh oriented = oriented_mesh(all, context);
  std::size_t flips = 0;
  const std::vector<Triangle> triangles = without_flat_triangles(oriented.mesh, flips);
  const MeshView surface{all.vertices, triangles, {}, {}};
  CleanedMesh out = clean_mesh(Solid::of(surface, context), tolerance, context);
  out.report.reversed_triangles = oriented.reversed_triangles;
  out.report.reversed_shells = oriented.reversed_shells;
  out.report.smallest_height_before = smallest_height(all);
  out.report.flips += flips;
  return out;
}

}  // namespace

CleanedMesh clean_mesh(const MeshView& mesh, double tolerance, const Context& context) {
  validate(mesh);
  if (mesh.triangles.empty()) throw InvalidMesh(std::string(mesh_problem::no_triangles));
  const MeshView all{mesh.vertices, mesh.triangles, {}, {}};
  check_tolerance(all, tolerance);
  check_coordinates(all);
  check_corners(all);
  CleanedMesh out = has_flat_triangles(all) ? clean_without_flat(all, tolerance, context)
                                            : clean_mesh(Solid::of(all, context), tolerance, context);
  out.warnings = reversal_warnings(out.report.reversed_triangles, out.report.reversed_shells);
  if (!mesh.segments.empty() || !mesh.points.empty()) {
    out.warnings.emplace_back(WarningCode::left_out, plural(mesh.segments.size(), "segment", "segments") + " and " +
                                                         plural(mesh.points.size(), "point", "points") +
                                                         " besides the triangles were left out");
  }
  return out;
}

}  // namespace blum
