// Blum: motions of the objects of a scene, and their collisions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/proximity/continuous_collisions.hpp"

namespace blum {

/// Number of an object of a scene, from 0, in the order in which objects were added.
using ObjectId = Id<struct ObjectTag>;

/// Motion of an object from its present position. Each vertex moves along a straight line, at a constant speed, from
/// time 0 to time 1. If the object rotates, each vertex moves along the chord of its arc. The positions at times 0 and
/// 1 are exact.
struct ObjectMotion {
  ObjectId object;
  std::span<const Vec3d> vertices = {};      ///< Positions at time 1, before the transform. If empty, unchanged.
  std::optional<RigidTransform> place = {};  ///< Transform at time 1. If nullopt, the transform does not change.
};

/// Collisions of two objects, or of one object with itself.
struct ObjectCollisions {
  ObjectId first;
  ObjectId second;
  std::vector<VertexFaceCollision> vertex_face;  ///< Vertices of the first object, faces of the second object.
  /// Collisions of vertices of the second object with faces of the first object; empty if both objects are the same.
  std::vector<VertexFaceCollision> face_vertex;
  std::vector<EdgeEdgeCollision> edge_edge;  ///< Edges of the first object, edges of the second object.

  /// Returns the earliest time of impact; nullopt if nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

struct SceneCollisions {
  std::vector<ObjectCollisions> objects;  ///< Pairs of objects that collide, by ascending (first, second).
  std::size_t box_pairs = 0;              ///< Pairs of a vertex and a face, or of two edges, whose moving boxes touch.
  /// Number of pairs in `box_pairs` that needed an exact test: no examined direction separates the two features.
  std::size_t exact_tests = 0;
  std::vector<PhaseTime> phases;

  /// Returns the earliest time of impact; nullopt if nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

/// Returns a warning if pairs meet at the start of the motion: see start_warnings(std::size_t).
[[nodiscard]] std::vector<Warning> start_warnings(const SceneCollisions& found);

}  // namespace blum
