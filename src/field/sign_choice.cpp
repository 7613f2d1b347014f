#include <string>

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

SignChoice choose_automatically(const Orientation& facts) {
  const std::string winding = "winding number above 1/2: the mesh ";
  if (!facts.closed || !facts.oriented) return {SignRule::winding, winding + "has " + describe_defects(facts)};
  if (facts.outward) {
    return {SignRule::normals, "pseudonormals: the mesh is closed, consistently oriented and faces outwards", true};
  }
  if (facts.signed_volume < 0) {
    return {
        SignRule::winding,
        winding + "is closed but inside out (its volume is negative), so nothing counts as inside: flip its triangles"};
  }
  return {SignRule::winding,
          winding + "is closed, but its shells do not all face away from the solid: flip those that are inside out"};
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
  if (mode == SignMode::automatic) return choose_automatically(facts);
  if (!facts.closed || !facts.oriented) {
    throw InvalidMesh("signs by normals need a closed, consistently oriented mesh; this one has " +
                      describe_defects(facts) + ": use winding, or weld or repair the mesh");
  }
  if (facts.outward) return {SignRule::normals, "pseudonormals, as asked for"};
  return {SignRule::normals,
          "pseudonormals, as asked for, of a mesh whose outer shells do not face outwards: flip it if the sign looks "
          "inverted"};
}

}  // namespace blum
