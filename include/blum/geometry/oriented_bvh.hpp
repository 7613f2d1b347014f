// Blum: a bounding-volume hierarchy of oriented boxes, for pairs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// A bounding-volume hierarchy over the primitives of a mesh, with eight children per node, whose boxes are turned to
/// lie along the surface: it finds pairs of primitives of two meshes that may be close. For closest points and rays
/// there is Bvh. Primitives are the triangles, then the segments, then the points of the mesh, in its order.
///
/// All queries may run on many threads at once, and allocate nothing. A pair that is as close as asked is never left
/// out; which others are seen, and in which order, depends on the hierarchy.
/// Cost: O(n log n) to build, about 0.3 microseconds per primitive; 150 bytes per primitive.
class OrientedBvh {
 public:
  /// Which pairs a visitor wants to see from now on.
  struct Wanted {
    double limit;                           ///< how close they must be; none where it is negative
    std::uint32_t last_there = 0xffffffff;  ///< the largest primitive of the other hierarchy

    Wanted(double limit_) : limit(limit_) {}  // NOLINT(google-explicit-constructor): mostly a distance is all
    Wanted(double limit_, std::uint32_t last) : limit(limit_), last_there(last) {}
  };

  /// Called with a primitive of this hierarchy, one of the other, and a distance that they are apart at least; returns
  /// what is wanted from now on: less than before.
  using Visit = FunctionRef<Wanted(std::uint32_t, std::uint32_t, double)>;

  /// @param mesh  must pass validate(mesh). @throws Cancelled.
  explicit OrientedBvh(const MeshView& mesh, const Context& context = {});
  OrientedBvh(OrientedBvh&&) noexcept;
  OrientedBvh& operator=(OrientedBvh&&) noexcept;
  ~OrientedBvh();

  /// The same primitives after their vertices moved. Queries get slower as neighbours move apart, then build anew. Must
  /// not run beside queries.
  /// @param vertices  as many as the mesh had, finite where it names them.
  /// @throws InvalidMesh for another count; Cancelled, after which only another refit may follow. Cost: O(n), a tenth
  /// of building.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// How many primitives there are.
  [[nodiscard]] std::size_t size() const;
  /// The box around all of them, not turned.
  [[nodiscard]] const Box3& bounds() const;

  /// Calls limit = visit(here, there) for pairs of primitives of this hierarchy and of another that may be at most
  /// `limit` apart, those that seem closest first; a visitor that lowers the limit ends the search early, at the latest
  /// with a negative one.
  /// @param place  where the other hierarchy is, seen from this one.
  void for_each_near_pair(const OrientedBvh& other, const RigidTransform& place, double limit, Visit visit) const;

  /// A node of a hierarchy: a block of primitives where the level is -1; else its children are a block of boxes.
  struct Node {
    std::uint32_t index = 0;
    std::int32_t level = -1;
    [[nodiscard]] bool is_leaf() const { return level < 0; }
  };
  /// A node of this hierarchy, one of another, and the squared distance that they are apart at least, but for rounding.
  struct NodePair {
    double squared_gap = 0;
    Node here, there;
  };
  /// Begins for_each_near_pair(): goes some times from the closest pair of nodes that is left down to primitives. What
  /// that finds is mostly next to the closest of all, and rules out most of the rest. Allocates memory.
  /// @return  the pairs of nodes that are still to be looked at, closest first, for threads to share.
  [[nodiscard]] std::vector<NodePair> dive_to_near_pairs(const OrientedBvh& other, const RigidTransform& place,
                                                         double limit, std::size_t dives, Visit visit) const;
  /// As for_each_near_pair(), for primitives below a pair of nodes only.
  void for_each_near_pair(const NodePair& nodes, const OrientedBvh& other, const RigidTransform& place, double limit,
                          Visit visit) const;

  /// Primitives lie in blocks of eight, so that a loop over blocks can be shared by threads.
  [[nodiscard]] std::size_t block_count() const;
  /// All primitives, in the order in which they lie in the hierarchy: neighbours in space together.
  [[nodiscard]] std::span<const std::uint32_t> order() const;
  /// The primitives of a block.
  [[nodiscard]] std::span<const std::uint32_t> block(std::size_t block) const;

  /// The same for the primitives of a block only.
  void for_each_near_pair(std::size_t block, const OrientedBvh& other, const RigidTransform& place, double limit,
                          Visit visit) const;
  /// The same for pairs of primitives of this hierarchy; over all blocks, each pair is seen once, in either order.
  void for_each_near_self_pair(std::size_t block, double limit, Visit visit) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
