// Blum: how objects of a scene move, and what meets. SPDX-License-Identifier: Apache-2.0
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

/// An object of a scene: its number, in the order in which objects were added.
using ObjectId = Id<struct ObjectTag>;

/// Where an object goes from where it is: each of its vertices along a straight line, at a constant speed, from time 0
/// to time 1. (A body that turns does so along chords, which bring its vertices to the right places at both ends.)
struct ObjectMotion {
  ObjectId object;
  std::span<const Vec3d> vertices = {};      ///< at the end, before the transform; none: as they are
  std::optional<RigidTransform> place = {};  ///< at the end; nullopt: where it is
};

/// What of two objects meets, or of one with itself.
struct ObjectCollisions {
  ObjectId first;
  ObjectId second;
  std::vector<VertexFaceCollision> vertex_face;  ///< a vertex of the first one, a face of the second
  std::vector<VertexFaceCollision> face_vertex;  ///< a vertex of the second, a face of the first; none of one object
  std::vector<EdgeEdgeCollision> edge_edge;      ///< an edge of the first one, then one of the second

  /// The earliest time of impact; nullopt where nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

struct SceneCollisions {
  std::vector<ObjectCollisions> objects;  ///< the pairs of which something meets, by rising (first, second)
  std::size_t box_pairs = 0;              ///< pairs of features whose moving boxes touch
  std::size_t exact_tests = 0;            ///< pairs that were tested: those that no direction tells apart
  std::vector<PhaseTime> phases;

  /// The earliest time of impact; nullopt where nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

}  // namespace blum
