#include "blum/field/field_warnings.hpp"

#include <algorithm>

#include "blum/core/plural.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"

namespace blum {
namespace {

std::vector<Warning> facing_warnings(SignRule rule, const MeshView& mesh, const Orientation& facts,
                                     const Context& context) {
  if (facts.inconsistent_edges > 0) {
    return {{WarningCode::facing, plural(facts.inconsistent_edges, "edge lies", "edges lie") +
                                      " between triangles that face different ways, so signs near them may not be "
                                      "those of a solid; orient the mesh first, with oriented_mesh() or `blum clean`"}};
  }
  if (!facts.closed || !facts.oriented || facts.outward) return {};
  if (facts.signed_volume < 0) {
    return {{WarningCode::facing,
             "the mesh is inside out (its volume is negative), so signs are not those of a solid: flip its triangles"}};
  }
  // If shells cross, their nesting depth is undefined, and so is the direction in which they must face. Winding numbers
  // form their union.
  const Context quiet{.threads = context.threads, .cancel = context.cancel};
  if (rule != SignRule::normals && SelfIntersectionSearch().finds_any(mesh, quiet)) return {};
  return {{WarningCode::facing,
           "parts of the mesh face the wrong way or enclose nothing, so signs may not be those of a solid; topology() "
           "lists the shells"}};
}

}  // namespace

std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh, const Orientation& facts,
                                    const Context& context) {
  if (field.sign_rule == SignRule::none) return {};
  const auto is_inside = [](float distance) { return distance < 0; };
  const bool has_inside = std::any_of(field.distance.begin(), field.distance.end(), is_inside);
  if (!has_inside && facts.inconsistent_edges > 0) {
    return {{WarningCode::nothing_inside,
             "no node is inside: " + plural(facts.inconsistent_edges, "edge lies", "edges lie") +
                 " between triangles that face different ways, so their winding numbers cancel; orient the mesh first, "
                 "with oriented_mesh() or `blum clean`"}};
  }
  std::vector<Warning> facing = facing_warnings(field.sign_rule, mesh, facts, context);
  if (has_inside || !facing.empty()) return facing;
  return {{WarningCode::nothing_inside,
           "no node is inside: the shape encloses nothing, lies outside the grid, or is too thin for its spacing"}};
}

std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh, const Context& context) {
  if (field.sign_rule == SignRule::none) return {};
  validate(mesh);
  return field_warnings(field, mesh, orientation(mesh, SiteTable(mesh, context)), context);
}

std::vector<Warning> sign_warnings(const MeshView& mesh, SignRule rule, const Context& context) {
  if (rule == SignRule::none) return {};
  validate(mesh);
  return facing_warnings(rule, mesh, orientation(mesh, SiteTable(mesh, context)), context);
}

}  // namespace blum
