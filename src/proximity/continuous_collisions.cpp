#include "blum/proximity/continuous_collisions.hpp"

#include <string>

#include "blum/core/error.hpp"
#include "proximity/impact_search.hpp"

namespace blum {
namespace {

void check(const MeshView& mesh, std::span<const Vec3d> end) {
  validate(mesh);
  if (end.size() != mesh.vertices.size()) {
    throw InvalidMesh("the mesh has " + std::to_string(mesh.vertices.size()) + " vertices at the start, and " +
                      std::to_string(end.size()) + " at the end; they must be as many");
  }
  MeshView last = mesh;
  last.vertices = end;
  try {
    validate(last);
  } catch (const InvalidMesh& error) {
    throw InvalidMesh(std::string("at the end: ") + error.what());
  }
}

}  // namespace

std::optional<double> ContinuousCollisions::earliest() const {
  std::optional<double> first;
  const auto look_at = [&](double time) {
    if (!first || time < *first) first = time;
  };
  for (const VertexFaceCollision& one : vertex_face) look_at(one.time);
  for (const EdgeEdgeCollision& one : edge_edge) look_at(one.time);
  return first;
}

ContinuousCollisions continuous_collisions(const MeshView& mesh, std::span<const Vec3d> end,
                                           const ImpactOptions& options, const Context& context) {
  check(mesh, end);
  check(options);
  ContinuousCollisions out;
  PhaseTimer timer(out.phases);
  const MovingObject object(mesh, end, options.min_separation, context);
  timer.lap("boxes");
  ImpactSearch search(options, context);
  out.vertex_face = search.vertices_and_faces(object, object);
  timer.lap("vertices and faces");
  out.edge_edge = search.edges_and_edges(object, object);
  timer.lap("edges and edges");
  out.box_pairs = search.box_pairs();
  out.exact_tests = search.exact_tests();
  return out;
}

}  // namespace blum
