#include "proximity/scene_continuous.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "proximity/impact_search.hpp"

namespace blum {

std::optional<double> ObjectCollisions::earliest() const {
  std::optional<double> first;
  const auto look_at = [&](const auto& collisions) {
    for (const auto& one : collisions) {
      if (!first || one.time < *first) first = one.time;
    }
  };
  look_at(vertex_face);
  look_at(face_vertex);
  look_at(edge_edge);
  return first;
}

std::optional<double> SceneCollisions::earliest() const {
  std::optional<double> first;
  for (const ObjectCollisions& pair : objects) {
    const std::optional<double> time = pair.earliest();
    if (time && (!first || *time < *first)) first = time;
  }
  return first;
}

namespace detail {
namespace {

/// An object between two frames, with copies of what it is made of.
struct Moving {
  TriangleMesh mesh;
  std::vector<Vec3d> end;
  std::optional<MovingObject> object;
};

/// @throws InvalidMesh that names the object.
void check_end(const SceneObject& object, const ObjectMotion& motion, const Context& context) {
  try {
    object.check_positions(motion.vertices, context);
  } catch (const InvalidMesh& error) {
    throw InvalidMesh(name_of(motion.object, object) + " at the end: " + error.what());
  }
}

Box3 box_around(std::span<const Vec3d> start, std::span<const Vec3d> end, const MeshView& mesh) {
  Box3 box;
  for_each_named_vertex(mesh, [&](std::uint32_t v) {
    box.extend(start[v]);
    box.extend(end[v]);
  });
  return box;
}

}  // namespace

void SceneMotion::add(const SceneObject& object, const ObjectMotion& motion, const Context& context) {
  std::optional<std::vector<Vec3d>>& end = ends_[motion.object.value];
  if (end) throw InvalidOption(name_of(motion.object, object) + " is given two motions");
  if (motion.place) check(*motion.place);
  if (!motion.vertices.empty()) check_end(object, motion, context);
  const std::span<const Vec3d> vertices = motion.vertices.empty() ? object.mesh().vertices : motion.vertices;
  end = SceneObject::positions(vertices, motion.place.value_or(object.place()));
}

SceneCollisions SceneMotion::collisions(std::span<const TwoObjects> pairs, const ImpactOptions& options,
                                        const Context& context) const {
  SceneCollisions out;
  PhaseTimer timer(out.phases);
  std::vector<std::optional<Moving>> moving(ends_.size());
  std::vector<Box3> boxes(ends_.size());
  const auto look_at = [&](ObjectId id, const SceneObject& object) {
    std::optional<Moving>& one = moving[id.value];
    if (one) return;
    one.emplace();
    one->mesh = object.mesh();
    one->mesh.vertices = object.positions();
    one->end = ends_[id.value].value_or(one->mesh.vertices);
    boxes[id.value] = box_around(one->mesh.vertices, one->end, one->mesh);
  };
  std::vector<const TwoObjects*> close;
  for (const TwoObjects& pair : pairs) {
    look_at(pair.first, *pair.a);
    look_at(pair.second, *pair.b);
    if (box_gap(boxes[pair.first.value], boxes[pair.second.value]) <= options.min_separation) close.push_back(&pair);
  }
  const auto object = [&](ObjectId id) -> const MovingObject& {
    Moving& one = *moving[id.value];
    if (!one.object) one.object.emplace(one.mesh, one.end, options.min_separation, context);
    return *one.object;
  };
  timer.lap("objects");
  ImpactSearch search(options, context);
  for (const TwoObjects* pair : close) {
    ObjectCollisions found{pair->first, pair->second, {}, {}, {}};
    const MovingObject& a = object(pair->first);
    const MovingObject& b = object(pair->second);
    found.vertex_face = search.vertices_and_faces(a, b);
    if (pair->first != pair->second) found.face_vertex = search.vertices_and_faces(b, a);
    found.edge_edge = search.edges_and_edges(a, b);
    const bool is_empty = found.vertex_face.empty() && found.face_vertex.empty() && found.edge_edge.empty();
    if (!is_empty) out.objects.push_back(std::move(found));
  }
  timer.lap("features");
  out.box_pairs = search.box_pairs();
  out.exact_tests = search.exact_tests();
  return out;
}

}  // namespace detail
}  // namespace blum
