// Blum: the scenes of the simulations. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "world.hpp"

namespace simulations {

/// A world with a script that drives it.
class Scene {
 public:
  explicit Scene(const WorldOptions& options) : world(options), step(options.step) {}
  virtual ~Scene() = default;
  /// Called before each step. @param time in seconds. @param last report of the previous step.
  virtual void drive(double time, const StepReport& last) {
    static_cast<void>(time);
    static_cast<void>(last);
  }

  World world;
  double step;  ///< seconds
};

/// Makes a skirt on a body that sways and turns.
[[nodiscard]] std::unique_ptr<Scene> make_cloth_scene();
/// Makes bodies that fall into a bowl. @param frequency each mesh has about 20 * frequency^2 triangles.
[[nodiscard]] std::unique_ptr<Scene> make_bowl_scene(int bodies, int frequency);
/// Makes a wall that breaks into bricks where a ball hits the wall.
[[nodiscard]] std::unique_ptr<Scene> make_breaking_scene();

}  // namespace simulations
