// Blum: motions of the objects of a scene, and their collisions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/proximity/continuous_collisions.hpp"

namespace blum {

/// Object of a scene: its number, in the order in which objects were added.
using ObjectId = Id<struct ObjectTag>;

/// Motion of an object from its present place. Each vertex moves along a straight line, at a constant speed, from time
/// 0 to time 1. Rotation is treated likewise: vertices move along chords, and are exact at both ends.
struct ObjectMotion {
  ObjectId object;
  std::span<const Vec3d> vertices = {};      ///< At the end, before the transform; empty: as they are.
  std::optional<RigidTransform> place = {};  ///< At the end; nullopt: where it is.
};

/// Collisions of two objects, or of one with itself.
struct ObjectCollisions {
  ObjectId first;
  ObjectId second;
  std::vector<VertexFaceCollision> vertex_face;  ///< A vertex of the first object and a face of the second.
  std::vector<VertexFaceCollision> face_vertex;  ///< A vertex of the second object, a face of the first; empty for one.
  std::vector<EdgeEdgeCollision> edge_edge;      ///< An edge of the first object, then one of the second.

  /// Returns the earliest time of impact; nullopt if nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

struct SceneCollisions {
  std::vector<ObjectCollisions> objects;  ///< Pairs of objects that collide, by ascending (first, second).
  std::size_t box_pairs = 0;              ///< Pairs of features whose moving boxes touch.
  std::size_t exact_tests = 0;            ///< Pairs that were tested, because no direction separates them.
  std::vector<PhaseTime> phases;

  /// Returns the earliest time of impact; nullopt if nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

}  // namespace blum
