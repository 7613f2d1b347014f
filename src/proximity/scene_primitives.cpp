#include "proximity/scene_primitives.hpp"

namespace blum::detail {

ScenePrimitives::ScenePrimitives(std::span<const ObjectPair> pairs, std::size_t objects)
    : objects_(objects), pairs_(objects * objects, nullptr), first_row_(objects, 0) {
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
    first_row_[k] = static_cast<std::uint32_t>(members_.size());
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

Box3 ScenePrimitives::box(std::uint32_t row) const {
  Box3 box;
  for (const Vec3d& corner : corners(row)) box.extend(corner);
  return box;
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
