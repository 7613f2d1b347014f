// Blum: the scenes of the simulations. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "world.hpp"

namespace simulations {

/// A world, and what happens to it.
class Scene {
 public:
  explicit Scene(const WorldOptions& options) : world(options), step(options.step) {}
  virtual ~Scene() = default;
  /// Called before each step. @param time in seconds. @param last what the step before found.
  virtual void drive(double time, const StepReport& last) {
    static_cast<void>(time);
    static_cast<void>(last);
  }

  World world;
  double step;  ///< seconds
};

/// A skirt on a body that sways and turns.
[[nodiscard]] std::unique_ptr<Scene> make_cloth_scene();
/// Ten bodies that fall into a bowl. @param frequency of their meshes: 20 * frequency^2 triangles, or about as many.
[[nodiscard]] std::unique_ptr<Scene> make_bowl_scene(int bodies, int frequency);
/// A wall that breaks into bricks where a ball hits it.
[[nodiscard]] std::unique_ptr<Scene> make_breaking_scene();

}  // namespace simulations
