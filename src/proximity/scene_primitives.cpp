#include "proximity/scene_primitives.hpp"

namespace blum::detail {

ScenePrimitives::ScenePrimitives(std::span<const ObjectPair> pairs, std::size_t objects)
    : objects_(objects), pairs_(objects * objects, nullptr) {
  std::vector<const SceneObject*> scene(objects, nullptr);
  for (const ObjectPair& pair : pairs) {
    const std::size_t a = pair.first().value;
    const std::size_t b = pair.second().value;
    pairs_[a * objects + b] = pairs_[b * objects + a] = &pair;
    scene[a] = &pair.a();
    scene[b] = &pair.b();
  }
  for (std::uint32_t k = 0; k < objects; ++k) {
    if (scene[k] == nullptr) continue;
    const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
    const std::vector<Vec3d> positions = scene[k]->positions();
    mesh_.vertices.insert(mesh_.vertices.end(), positions.begin(), positions.end());
    for (std::uint32_t p = 0; p < scene[k]->primitives(); ++p) {
      const auto [a, b, c] = scene[k]->vertices(p);
      mesh_.triangles.push_back({base + a, base + b, base + c});
      members_.push_back({ObjectId(k), p});
    }
  }
}

std::array<Vec3d, 3> ScenePrimitives::corners(std::uint32_t row) const {
  return triangle_corners(mesh_, row);
}

bool ScenePrimitives::are_compared(std::uint32_t a, std::uint32_t b) const {
  const Member& first = members_[a];
  const Member& second = members_[b];
  const ObjectPair* objects = pair(first.object, second.object);
  if (objects == nullptr) return false;
  return !objects->is_self() || (a != b && !objects->are_neighbours(first.primitive, second.primitive));
}

PrimitivePair ScenePrimitives::compare(std::uint32_t a, std::uint32_t b) const {
  const Member& first = members_[a];
  const Member& second = members_[b];
  const ObjectPair& objects = *pair(first.object, second.object);
  if (a < b) return objects.compare(first.primitive, second.primitive);
  return exchanged(objects.compare(second.primitive, first.primitive));
}

}  // namespace blum::detail
