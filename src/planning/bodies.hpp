// Blum: bodies among obstacles, and pairs of them that are compared. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/planning/certified_motion.hpp"
#include "planning/rigid_mesh.hpp"

namespace blum::detail {

/// A body and a second one, or all obstacles.
struct BodyPair {
  std::size_t body = 0;
  std::optional<std::size_t> other = {};  ///< nothing: the obstacles
};

/// Bodies, obstacles, and the pairs of them that are compared.
struct Bodies {
  std::vector<RigidMesh> bodies;
  std::optional<RigidMesh> obstacles;  ///< all obstacles in one mesh
  /// For each obstacle: the number of triangles, segments and points of the obstacles up to its end.
  struct Ends {
    std::size_t triangles = 0, segments = 0, points = 0;
  };
  std::vector<Ends> ends;
  std::vector<BodyPair> pairs;

  /// Sets the obstacle and its primitive of a primitive of the joined mesh.
  void name_obstacle(std::uint32_t primitive, MotionPair& pair) const;
};

}  // namespace blum::detail
