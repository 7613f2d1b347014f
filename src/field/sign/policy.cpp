#include "field/sign/policy.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/plural.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/topology.hpp"
#include "field/sign/facing_repair.hpp"

namespace blum::sign {
namespace {

bool has_flat_triangles(const MeshView& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return is_too_flat(mesh, t); });
}

/// Returns true if facing_warnings() depends on whether the mesh crosses itself.
bool facing_depends_on_crossings(const Orientation& facts) {
  return facts.closed && facts.oriented && !facts.outward && !(facts.signed_volume < 0);
}

/// Returns the warning about a mesh whose parts face the wrong way, or an empty list.
/// @param crosses  true if two triangles of the mesh cross or touch. The nesting depth of shells that cross is
///                 undefined, and so is the direction in which they must face. Winding numbers form their union.
std::vector<Warning> facing_warnings(const Orientation& facts, bool crosses) {
  const auto warn = [](std::string text) { return std::vector<Warning>{{WarningCode::facing, std::move(text)}}; };
  if (facts.inconsistent_edges > 0) {
    return warn(plural(facts.inconsistent_edges, "edge lies", "edges lie") +
                " between triangles that face different ways, so signs near these edges may be wrong; orient the mesh "
                "first, with oriented_mesh() or `blum clean`");
  }
  if (!facts.closed || !facts.oriented || facts.outward) return {};
  if (facts.signed_volume < 0) {
    return warn("the mesh is inside out (its volume is negative), so signs are wrong; reverse its triangles");
  }
  if (crosses) return {};
  return warn(
      "parts of the mesh face the wrong way or enclose nothing, so signs may be wrong; topology() lists the shells");
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
  if (facts.outward) {
    return {.rule = SignRule::normals, .reason = rule_requested, .method = Method::crossings};
  }
  Plan plan{.rule = SignRule::normals,
            .reason = std::string(rule_requested) +
                      "; shells of the mesh cross or do not all face away from the solid: flip the mesh if signs look "
                      "inverted",
            .warnings = facing_warnings(facts, false),
            .method = Method::pseudonormals};
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
  return {.rule = SignRule::none, .reason = std::move(reason)};
}

/// Returns the plan of an unexamined mesh.
Plan plan_by_winding(std::string reason) {
  return {.rule = SignRule::winding, .reason = std::move(reason), .method = Method::sums};
}

/// @param crosses  as for facing_warnings().
Plan plan_by_winding(std::string reason, const MeshView& mesh, const SiteTable& sites, const Orientation& facts,
                     bool crosses) {
  Plan plan = plan_by_winding(std::move(reason));
  plan.warnings = facing_warnings(facts, crosses);
  if (is_balanced(mesh, sites)) plan.method = Method::crossings;
  return plan;
}

/// Returns the first reason against signs by normals that needs no search for crossings, or an empty string.
std::string reason_for_winding(const MeshView& mesh, const Orientation& facts) {
  if (!mesh.segments.empty() || !mesh.points.empty())
    return "the mesh has free segments or points, which have no sides";
  if (!facts.closed || !facts.oriented) return "the mesh has " + mesh_problem::of_edges(facts);
  if (has_flat_triangles(mesh)) return "the mesh is closed, but has triangles too flat for a normal";
  return "";
}

void add_warnings(Plan& plan, std::vector<Warning> found) {
  for (Warning& warning : found) plan.warnings.push_back(std::move(warning));
}

}  // namespace

bool is_too_flat(const MeshView& mesh, const Triangle& triangle) {
  const Vec3d u = mesh.vertices[triangle[1]] - mesh.vertices[triangle[0]];
  const Vec3d v = mesh.vertices[triangle[2]] - mesh.vertices[triangle[0]];
  const double longest = std::max({squared_length(u), squared_length(v), squared_length(u - v)});
  return !(squared_length(cross(u, v)) > 1e-24 * longest * longest);
}

bool Planner::KnownCrossings::operator()(const MeshView& mesh) {
  if (answer_) return *answer_;
  const bool is_crossing = search_.finds_any(mesh, {.threads = context_.threads, .cancel = context_.cancel});
  if (is_shared_) answer_ = is_crossing;
  return is_crossing;
}

Plan Planner::plan_oriented(const MeshView& mesh, const SiteTable& sites, const Orientation& facts,
                            KnownCrossings& crosses) {
  std::string reason = reason_for_winding(mesh, facts);
  const bool is_crossing = (reason.empty() || facing_depends_on_crossings(facts)) && crosses(mesh);
  if (reason.empty() && is_crossing) reason = "the mesh is closed and oriented, but it crosses or touches itself";
  if (reason.empty() && !facts.outward) {
    reason = "the mesh is closed, but its shells do not all face away from the solid";
  }
  if (!reason.empty()) return plan_by_winding(std::move(reason), mesh, sites, facts, is_crossing);
  return {.rule = SignRule::normals,
          .reason = "the mesh is closed, consistently oriented and faces outwards",
          .method = Method::crossings,
          .is_simple = true};
}

Plan Planner::plan_automatically(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  const Orientation facts = orientation(mesh, sites);
  KnownCrossings crosses(search_, mesh, facts, context);
  FacingRepair repair = repair_facing(mesh, sites, facts, crosses, context);
  if (repair.triangles.empty()) {
    Plan plan = plan_oriented(mesh, sites, facts, crosses);
    add_warnings(plan, std::move(repair.warnings));
    return plan;
  }
  MeshView own = mesh;
  own.triangles = repair.triangles;
  const SiteTable own_sites(own, context);
  Plan plan = plan_oriented(own, own_sites, orientation(own, own_sites), crosses);
  plan.reason += ", after " + repair.text;
  plan.warnings = {{WarningCode::facing, "parts of the mesh face the wrong way, and for the signs, " + repair.text}};
  add_warnings(plan, std::move(repair.warnings));
  plan.triangles = std::move(repair.triangles);
  return plan;
}

Plan Planner::plan_as_given(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  const Orientation facts = orientation(mesh, sites);
  KnownCrossings crosses(search_, mesh, facts, context);
  const bool is_crossing = facing_depends_on_crossings(facts) && crosses(mesh);
  Plan plan = plan_by_winding(rule_requested, mesh, sites, facts, is_crossing);
  if (!plan.warnings.empty()) return plan;
  FacingRepair repair = repair_facing(mesh, sites, facts, crosses, context);
  if (!repair.triangles.empty()) {
    plan.warnings = {{WarningCode::facing,
                      "parts of the mesh face the wrong way, so signs are wrong there; reverse their triangles, or use "
                      "the sign mode auto"}};
  }
  add_warnings(plan, std::move(repair.warnings));
  return plan;
}

Plan Planner::plan(SignMode mode, const MeshView& mesh, const SiteTable& sites, const Context& context) {
  if (mode == SignMode::none) return unsigned_plan(unsigned_requested);
  if (mesh.triangles.empty()) {
    if (mode == SignMode::automatic) return unsigned_plan(no_triangles);
    throw_without_triangles();
  }
  if (mode == SignMode::normals) return plan_normals(mesh, sites);
  if (mode == SignMode::automatic) return plan_automatically(mesh, sites, context);
  return plan_as_given(mesh, sites, context);
}

Plan plan_unseen_signs(SignMode mode, std::size_t triangles) {
  if (mode == SignMode::normals) {
    throw InvalidOption(
        "signs by normals need a mesh in host memory: use automatic, which gives the same signs for closed meshes that "
        "face outwards");
  }
  if (mode == SignMode::none) return unsigned_plan(unsigned_requested);
  if (triangles > 0) {
    return plan_by_winding(mode == SignMode::winding ? rule_requested : "meshes in device memory are not examined");
  }
  if (mode == SignMode::winding) throw_without_triangles();
  return unsigned_plan(no_triangles);
}

Plan plan_image_signs(bool is_signed, const std::string& selection) {
  if (!is_signed) return unsigned_plan(unsigned_requested);
  return {.rule = SignRule::label, .reason = "a voxel is inside if its value " + selection};
}

}  // namespace blum::sign
