// Blum: what of the objects of a scene meets while they move. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/proximity/motion.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// The motions of the objects of a scene.
class SceneMotion {
 public:
  /// @param objects  how many there are; all rest.
  explicit SceneMotion(std::size_t objects) : ends_(objects) {}

  /// @throws InvalidMesh, InvalidOption for an object that moves already.
  void add(const SceneObject& object, const ObjectMotion& motion, const Context& context);

  /// See ProximityScene::continuous(). @param pairs  that are compared.
  [[nodiscard]] SceneCollisions collisions(std::span<const TwoObjects> pairs, const ImpactOptions& options,
                                           const Context& context) const;

 private:
  std::vector<std::optional<std::vector<Vec3d>>> ends_;  ///< of objects that move: vertices in the scene
};

}  // namespace blum::detail
