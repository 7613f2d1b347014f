#include "common/weld_facts.hpp"

#include "blum/geometry/topology.hpp"
#include "common/files.hpp"

namespace blum::cli {
namespace {

Json surface_json(const SurfaceFacts& facts) {
  return {{"components", facts.components}, {"euler_number", facts.euler_number}};
}

std::string surface_text(const SurfaceFacts& facts) {
  return plural(facts.components, "component", "components") + " and the Euler number " +
         std::to_string(facts.euler_number);
}

}  // namespace

SurfaceFacts surface_facts(const MeshView& mesh) {
  const Topology facts = topology({mesh.vertices, mesh.triangles, {}, {}});
  return {facts.components, facts.euler_characteristic};
}

WeldFacts weld_facts(const MeshView& exact, double tolerance, const MeshView& welded) {
  const std::size_t vertices = exact.vertices.size();
  return {tolerance, vertices, vertices - welded.vertices.size(), surface_facts(exact), surface_facts(welded)};
}

std::string weld_text(const WeldFacts& facts) {
  std::string text = "welding within " + rounded_text(facts.tolerance) + " removed " + count_text(facts.lost) + " of " +
                     plural(facts.vertices, "vertex", "vertices");
  if (facts.before == facts.after) return text;
  return text + ": the surface now has " + surface_text(facts.after) + " instead of " + surface_text(facts.before);
}

Json weld_json(const WeldFacts& facts) {
  return {{"tolerance", facts.tolerance},
          {"vertices", facts.vertices},
          {"lost", facts.lost},
          {"before", surface_json(facts.before)},
          {"after", surface_json(facts.after)}};
}

}  // namespace blum::cli
