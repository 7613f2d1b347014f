// Blum: the primitives of all objects of a scene in one row. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// A primitive of a scene.
struct Member {
  ObjectId object;
  std::uint32_t primitive = 0;
};

/// The primitives of the objects that are compared, in the order of objects and then of primitives.
class ScenePrimitives {
 public:
  /// @param pairs    that are compared; must stay.
  /// @param objects  how many there are in the scene.
  ScenePrimitives(std::span<const ObjectPair> pairs, std::size_t objects);

  [[nodiscard]] std::size_t size() const { return members_.size(); }
  [[nodiscard]] const Member& member(std::uint32_t row) const { return members_[row]; }
  /// All of them where they are in the scene, as triangles: a segment is one with a corner twice, a point with one
  /// thrice.
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t row) const { return triangle_corners(mesh_, row); }
  [[nodiscard]] Box3 box(std::uint32_t row) const;
  /// Where a primitive of an object that is compared stands.
  [[nodiscard]] std::uint32_t row(ObjectId object, std::uint32_t primitive) const {
    return first_row_[object.value] + primitive;
  }

  /// Whether two are compared: their objects are, and they are not neighbours in one.
  [[nodiscard]] bool are_compared(std::uint32_t a, std::uint32_t b) const;
  /// The closest points, told for the first one.
  [[nodiscard]] PrimitivePair compare(std::uint32_t a, std::uint32_t b) const;

 private:
  [[nodiscard]] const ObjectPair* pair(ObjectId a, ObjectId b) const { return pairs_[a.value * objects_ + b.value]; }

  std::size_t objects_;
  std::vector<const ObjectPair*> pairs_;  ///< of each two objects, either way; null where they are not compared
  std::vector<Member> members_;
  std::vector<std::uint32_t> first_row_;  ///< of each object
  TriangleMesh mesh_;
};

}  // namespace blum::detail
