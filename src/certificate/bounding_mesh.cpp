#include "certificate/bounding_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "certificate/scaling.hpp"
#include "certificate/shells.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

constexpr std::size_t most_pairs = 100000;

/// Returns the pairs of triangles at which a mesh touches itself.
/// @throws NoPolyhedron if the mesh crosses itself, or touches itself in too many places.
SelfIntersections without_crossings(const MeshView& mesh, const Context& context) {
  SelfIntersections found = find_self_intersections(mesh, most_pairs, context);
  if (found.crossing > 0) throw NoPolyhedron("the mesh crosses itself");
  if (!found.complete) {
    throw NoPolyhedron("the mesh touches itself in more than " + std::to_string(most_pairs) + " places");
  }
  return found;
}

/// @throws NoPolyhedron if a mesh bounds no polyhedron.
void check_polyhedron(const MeshView& mesh, const Context& context) {
  const ScaledMesh own(mesh, factor_for(bounds(mesh).diagonal()));
  ClosedShells shells = cut_into_shells(own.view, context);
  const SelfIntersections found = without_crossings(mesh, context);
  nest(shells, own.view, TriangleSearch(own.view, shells.of_triangle, context), context);
  const auto body = [&](TriangleId t) { return shells.shells[shells.of_triangle[t.value]].body; };
  for (const TrianglePair& pair : found.pairs) {
    if (body(pair.first) == body(pair.second)) throw NoPolyhedron("the mesh touches itself");
  }
}

/// Computes winding numbers of a mesh around points from the crossings of lines with the mesh.
class Windings {
 public:
  Windings(const MeshView& mesh, const Context& context) : mesh_(mesh), search_(mesh, {}, context) {}

  /// Returns the winding number around p; nullopt if it is undecided, for example on the surface.
  std::optional<int> around(const Vec3d& p) {
    constexpr std::uint32_t most_lines = 24;
    for (std::uint32_t attempt = 0; attempt < most_lines; ++attempt) {
      const ProbeLine line = line_through(p, attempt);
      if (search_.crossings(line, crossings_)) return ahead(line);
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::optional<int> ahead(const ProbeLine& line) const {
    const double nothing = 1e-12 * search_.bounds().diagonal();
    int winding = 0;
    for (const Crossing& crossing : crossings_) {
      if (std::abs(crossing.at) < nothing) return std::nullopt;
      if (crossing.at < 0) continue;
      const auto [a, b, c] = corners_of(mesh_, crossing.triangle);
      winding += dot(cross(b - a, c - a), line.along) > 0 ? 1 : -1;
    }
    return winding;
  }

  MeshView mesh_;
  TriangleSearch search_;
  std::vector<Crossing> crossings_;
};

/// Returns random points in the box of a mesh, and points just off both sides of triangles.
std::vector<Vec3d> probes(const MeshView& mesh) {
  constexpr std::size_t in_box = 1000;
  constexpr std::size_t at_triangles = 4000;
  std::vector<Vec3d> out;
  Random random(1);
  const Box3 box = bounds(mesh);
  for (std::size_t k = 0; k < in_box; ++k) {
    const Vec3d at = random.in_cube();
    out.push_back(box.lower + Vec3d{at.x * box.size().x, at.y * box.size().y, at.z * box.size().z});
  }
  const double step = 1e-7 * box.diagonal();
  for (std::size_t k = 0; k < std::min(at_triangles, mesh.triangles.size()); ++k) {
    const bool takes_all = mesh.triangles.size() <= at_triangles;
    const auto [a, b, c] =
        corners_of(mesh, static_cast<std::uint32_t>(takes_all ? k : random.below(mesh.triangles.size())));
    const Vec3d normal = cross(b - a, c - a);
    if (!(length(normal) > 0)) continue;
    const Vec3d off = normal * (step / length(normal));
    out.push_back((a + b + c) / 3.0 + off);
    out.push_back((a + b + c) / 3.0 - off);
  }
  return out;
}

/// @throws NoPolyhedron if the insides differ at a tested point: `resolved` must wind once where `mesh` winds once or
/// more, and not at all elsewhere.
void check_same_inside(const MeshView& mesh, const MeshView& resolved, const Context& context) {
  const double factor = factor_for(bounds(mesh).diagonal());
  const ScaledMesh given(mesh, factor);
  const ScaledMesh own(resolved, factor);
  Windings around_given(given.view, context);
  Windings around_own(own.view, context);
  constexpr std::size_t often = 256;
  std::size_t done = 0;
  for (const Vec3d& p : probes(own.view)) {
    if (done++ % often == 0) throw_if_cancelled(context);
    const std::optional<int> before = around_given.around(p);
    const std::optional<int> after = around_own.around(p);
    if (before && after && *after != (*before >= 1 ? 1 : 0)) {
      throw NoPolyhedron("resolving the crossings of the mesh would change its interior");
    }
  }
}

}  // namespace

BoundingMesh::BoundingMesh(const MeshView& mesh, const Context& context) : mesh_(mesh) {
  std::string why;
  try {
    check_polyhedron(mesh, context);
    return;
  } catch (const NoPolyhedron& error) {
    if (mesh.triangles.empty()) throw;
    why = error.reason();
  }
  resolved_ = resolve_crossings(mesh, {}, context);
  if (!resolved_->is_resolved())
    throw NoPolyhedron(why + ", and the crossings cannot be resolved: " + resolved_->obstacle);
  try {
    check_polyhedron(resolved_->mesh, context);
    check_same_inside(mesh, resolved_->mesh, context);
  } catch (const NoPolyhedron& error) {
    throw NoPolyhedron(why + "; after its crossings are resolved, it still bounds no polyhedron: " + error.reason());
  }
}

}  // namespace blum::verifier

namespace blum {

MeshSolidRule verifier::rule_of_polyhedron(bool is_resolved) {
  return {SolidRule::polyhedron, is_resolved ? "the mesh is closed, and manifold after its crossings are resolved"
                                             : "the mesh is closed, manifold and does not cross itself"};
}

MeshSolidRule solid_rule(const MeshView& mesh, const Context& context) {
  validate(mesh);
  try {
    const verifier::BoundingMesh bounding(mesh, context);
    return verifier::rule_of_polyhedron(bounding.is_resolved());
  } catch (const verifier::NoPolyhedron& error) {
    return {SolidRule::winding, error.reason()};
  }
}

}  // namespace blum
