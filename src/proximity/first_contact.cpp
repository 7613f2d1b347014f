#include "blum/proximity/first_contact.hpp"

#include "proximity/first_search.hpp"
#include "proximity/impact_search.hpp"

namespace blum {
namespace {

constexpr ObjectId first_object(0);
constexpr ObjectId second_object(1);

}  // namespace

double FirstContact::time() const {
  return std::visit([](const auto& one) { return one.time; }, features);
}

SceneCollisions collisions_of(const FirstContact& contact) {
  ObjectCollisions pair{contact.first, contact.second, {}, {}, {}};
  if (contact.kind == ContactKind::edge_edge) {
    pair.edge_edge.push_back(std::get<EdgeEdgeCollision>(contact.features));
  } else {
    auto& list = contact.kind == ContactKind::vertex_face ? pair.vertex_face : pair.face_vertex;
    list.push_back(std::get<VertexFaceCollision>(contact.features));
  }
  SceneCollisions out;
  out.objects.push_back(std::move(pair));
  return out;
}

std::optional<FirstContact> first_contact(const MeshView& mesh, std::span<const Vec3d> end,
                                          const ImpactOptions& options, const Context& context) {
  check_motion(mesh, end);
  check(options);
  const MovingObject object(mesh, end, options.min_separation, context);
  FirstSearch search(options, context);
  search.add(first_object, object, first_object, object);
  return search.result();
}

std::optional<FirstContact> first_contact(const MeshView& first, std::span<const Vec3d> first_end,
                                          const MeshView& second, std::span<const Vec3d> second_end,
                                          const ImpactOptions& options, const Context& context) {
  check_motion(first, first_end);
  check_motion(second, second_end);
  check(options);
  const MovingObject a(first, first_end, options.min_separation, context);
  const MovingObject b(second, second_end, options.min_separation, context);
  FirstSearch search(options, context);
  search.add(first_object, a, second_object, b);
  return search.result();
}

}  // namespace blum
