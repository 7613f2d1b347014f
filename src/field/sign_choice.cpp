#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/topology.hpp"
#include "field/sign.hpp"

namespace blum {
namespace {

std::string describe_defects(const Orientation& facts) {
  if (facts.boundary_edges + facts.nonmanifold_edges + facts.inconsistent_edges == 0) {
    return "no triangle with three different corners";
  }
  return std::to_string(facts.boundary_edges) + " boundary edges, " + std::to_string(facts.nonmanifold_edges) +
         " non-manifold edges and " + std::to_string(facts.inconsistent_edges) + " inconsistently oriented edges";
}

/// Whether a triangle is too flat for its normal to mean anything. Such triangles close cracks in many CAD meshes, and
/// leave their edges with a pseudonormal of one side only.
bool has_flat_triangles(const MeshView& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    const Vec3d u = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    const Vec3d v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double longest = std::max({squared_length(u), squared_length(v), squared_length(u - v)});
    return !(squared_length(cross(u, v)) > 1e-24 * longest * longest);
  });
}

SignChoice choose_automatically(const MeshView& mesh, const Orientation& facts) {
  const std::string winding = "winding number above 1/2: the mesh ";
  if (!mesh.segments.empty() || !mesh.points.empty()) {
    return {SignRule::winding, winding + "has free segments or points, which have no sides"};
  }
  if (!facts.closed || !facts.oriented) return {SignRule::winding, winding + "has " + describe_defects(facts)};
  if (facts.outward && has_flat_triangles(mesh)) {
    return {SignRule::winding, winding + "is closed, but has triangles too flat for a normal"};
  }
  if (facts.outward) {
    return {SignRule::normals, "the mesh is closed, consistently oriented and faces outwards", true, 0};
  }
  if (facts.signed_volume < 0) {
    return {
        SignRule::winding,
        winding + "is closed but inside out (its volume is negative), so nothing counts as inside: flip its triangles"};
  }
  return {SignRule::winding,
          winding + "is closed, but its shells cross each other or do not all face away from the solid"};
}

/// Whether the mesh would face outwards if all triangles were turned.
bool faces_inwards(const MeshView& mesh) {
  const std::vector<Triangle> turned = turned_triangles(mesh.triangles);
  MeshView view = mesh;
  view.triangles = turned;
  return orientation(view, SiteTable(view)).outward;
}

}  // namespace

SignChoice choose_sign_rule(SignMode mode, const MeshView& mesh, const SiteTable& sites) {
  if (mode == SignMode::none) return {SignRule::none, "unsigned, as asked for"};
  if (mesh.triangles.empty()) {
    if (mode == SignMode::automatic) return {SignRule::none, "unsigned: there are no triangles, so there is no inside"};
    throw InvalidOption("a sign was asked for, but the mesh has no triangles, so it has no inside: ask for none");
  }
  if (mode == SignMode::winding) return {SignRule::winding, "winding number above 1/2, as asked for"};
  const Orientation facts = orientation(mesh, sites);
  if (mode == SignMode::automatic) return choose_automatically(mesh, facts);
  if (!facts.closed || !facts.oriented) {
    throw InvalidMesh("signs by normals need a closed, consistently oriented mesh; this one has " +
                      describe_defects(facts) + ": use winding, or weld or repair the mesh");
  }
  if (!mesh.segments.empty() || !mesh.points.empty()) {
    throw InvalidMesh(
        "signs by normals were asked for, but the mesh has free segments or points, which have no sides: use winding");
  }
  if (facts.outward) return {SignRule::normals, "orientation, as asked for", false, 0};
  SignChoice choice{SignRule::normals,
                    "orientation, as asked for, of a mesh whose shells cross each other or do not all face away from "
                    "the solid: flip it if the sign looks inverted"};
  // Inside out, it has a winding number of -1 in the solid, and 0, which these signs call inside, around it.
  if (faces_inwards(mesh)) choice.level = -1;
  return choice;
}

}  // namespace blum
