#include "field/sign/policy.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/topology.hpp"

namespace blum::sign {
namespace {

bool has_flat_triangles(const MeshView& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return is_too_flat(mesh, t); });
}

Plan by_winding(std::string reason) {
  return {SignRule::winding, std::move(reason), Method::sums};
}

/// Returns true if the mesh becomes outward-facing when all its triangles are reversed.
bool faces_inwards(const MeshView& mesh) {
  const std::vector<Triangle> turned = reversed_triangles(mesh.triangles);
  MeshView view = mesh;
  view.triangles = turned;
  return orientation(view, SiteTable(view)).outward;
}

constexpr const char* rule_requested = "this rule was requested";
constexpr const char* unsigned_requested = "unsigned distances were requested";
constexpr const char* no_triangles = "the mesh has no triangles and therefore no inside";

Plan plan_normals(const MeshView& mesh, const SiteTable& sites) {
  const Orientation facts = orientation(mesh, sites);
  if (!facts.closed || !facts.oriented) {
    throw InvalidMesh("signs by normals need a closed, consistently oriented mesh; this one has " +
                      mesh_problem::of_edges(facts) + ": use winding, or weld or repair the mesh");
  }
  if (!mesh.segments.empty() || !mesh.points.empty()) {
    throw InvalidMesh(
        "signs by normals need triangles only; the mesh has free segments or points, which have no sides: use winding");
  }
  if (facts.outward) return {SignRule::normals, rule_requested, Method::crossings};
  Plan plan{SignRule::normals,
            std::string(rule_requested) +
                "; shells of the mesh cross or do not all face away from the solid: flip the mesh if signs look "
                "inverted",
            Method::pseudonormals};
  // An inside-out mesh has winding number -1 in the solid and 0 around it. For such a mesh, the chosen signs make the
  // surrounding space the inside.
  if (faces_inwards(mesh)) {
    plan.method = Method::crossings;
    plan.level = -1;
  }
  return plan;
}

/// Returns true if every edge of the triangles is traversed equally often in both directions. If so, winding numbers
/// are whole everywhere except on the surface.
bool is_balanced(const MeshView& mesh, const SiteTable& sites) {
  std::vector<std::int32_t> forward(sites.edge_count(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeId edge = sites.triangle_edges()[t][k];
      if (edge.has_value()) forward[edge.value] += mesh.triangles[t][k] < mesh.triangles[t][(k + 1) % 3] ? 1 : -1;
    }
  }
  return std::all_of(forward.begin(), forward.end(), [](std::int32_t count) { return count == 0; });
}

void throw_without_triangles() {
  throw InvalidOption("a sign was requested, but the mesh has no triangles, so it has no inside: request none");
}

Plan unsigned_plan(std::string reason) {
  return {SignRule::none, std::move(reason)};
}

}  // namespace

bool is_too_flat(const MeshView& mesh, const Triangle& triangle) {
  const Vec3d u = mesh.vertices[triangle[1]] - mesh.vertices[triangle[0]];
  const Vec3d v = mesh.vertices[triangle[2]] - mesh.vertices[triangle[0]];
  const double longest = std::max({squared_length(u), squared_length(v), squared_length(u - v)});
  return !(squared_length(cross(u, v)) > 1e-24 * longest * longest);
}

Plan Planner::plan_automatically(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  const Orientation facts = orientation(mesh, sites);
  if (!mesh.segments.empty() || !mesh.points.empty()) {
    return by_winding("the mesh has free segments or points, which have no sides");
  }
  if (!facts.closed || !facts.oriented) return by_winding("the mesh has " + mesh_problem::of_edges(facts));
  if (!facts.outward && facts.signed_volume < 0) {
    return by_winding(
        "the mesh is closed but inside out (its volume is negative), so nothing counts as inside: flip its triangles");
  }
  if (has_flat_triangles(mesh)) return by_winding("the mesh is closed, but has triangles too flat for a normal");
  const Context quiet{.threads = context.threads, .cancel = context.cancel};
  if (search_.finds_any(mesh, quiet)) {
    return by_winding("the mesh is closed and oriented, but it crosses or touches itself");
  }
  if (!facts.outward) return by_winding("the mesh is closed, but its shells do not all face away from the solid");
  return {SignRule::normals, "the mesh is closed, consistently oriented and faces outwards", Method::crossings, 0,
          true};
}

Plan Planner::plan(SignMode mode, const MeshView& mesh, const SiteTable& sites, const Context& context) {
  if (mode == SignMode::none) return unsigned_plan(unsigned_requested);
  if (mesh.triangles.empty()) {
    if (mode == SignMode::automatic) return unsigned_plan(no_triangles);
    throw_without_triangles();
  }
  if (mode == SignMode::normals) return plan_normals(mesh, sites);
  Plan plan = mode == SignMode::winding ? by_winding(rule_requested) : plan_automatically(mesh, sites, context);
  if (plan.method == Method::sums && is_balanced(mesh, sites)) plan.method = Method::crossings;
  return plan;
}

Plan plan_unseen_signs(SignMode mode, std::size_t triangles) {
  if (mode == SignMode::normals) {
    throw InvalidOption(
        "signs by normals need a mesh in host memory: use automatic, which gives the same signs for closed meshes that "
        "face outwards");
  }
  if (mode == SignMode::none) return unsigned_plan(unsigned_requested);
  if (triangles > 0) {
    return by_winding(mode == SignMode::winding ? rule_requested : "meshes in device memory are not examined");
  }
  if (mode == SignMode::winding) throw_without_triangles();
  return unsigned_plan(no_triangles);
}

Plan plan_image_signs(bool is_signed, const std::string& selection) {
  if (!is_signed) return unsigned_plan(unsigned_requested);
  return {SignRule::label, "a voxel is inside if its value " + selection};
}

}  // namespace blum::sign
