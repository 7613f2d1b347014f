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

/// Bounding-volume hierarchy over the primitives of a mesh, with eight children per node and boxes aligned with the
/// surface. It finds pairs of primitives of two meshes that may be close. Bvh is the hierarchy for closest points and
/// rays. Primitives are the triangles, then the segments, then the points of the mesh, in its order.
///
/// All queries may run on many threads at once. They allocate nothing, except dive_to_near_pairs(). A pair that is
/// within the limit is never left out. The hierarchy decides which other pairs are seen, and in which order.
/// Cost: O(n log n) to build, about 0.3 microseconds per primitive; 150 bytes per primitive.
class OrientedBvh {
 public:
  /// Pairs that a visitor wants to see from now on.
  struct Wanted {
    double limit;                           ///< largest distance of a pair; none is wanted if it is negative
    std::uint32_t last_there = 0xffffffff;  ///< largest primitive of the other hierarchy

    Wanted(double limit_) : limit(limit_) {}  // NOLINT(google-explicit-constructor): mostly a distance is all
    Wanted(double limit_, std::uint32_t last) : limit(limit_), last_there(last) {}
  };

  /// Called with a primitive of this hierarchy, one of the other, and a lower bound on their distance. Returns the
  /// pairs that are wanted from now on. They can only become fewer.
  using Visit = FunctionRef<Wanted(std::uint32_t, std::uint32_t, double)>;

  /// @param mesh  must pass validate(mesh). @throws Cancelled.
  explicit OrientedBvh(const MeshView& mesh, const Context& context = {});
  OrientedBvh(OrientedBvh&&) noexcept;
  OrientedBvh& operator=(OrientedBvh&&) noexcept;
  ~OrientedBvh();

  /// Updates the hierarchy to moved vertices of the same primitives. Queries get slower as neighbours move apart; then
  /// build a new hierarchy. Must not run at the same time as queries.
  /// @param vertices  as many as the mesh had. Those that the mesh names must be finite.
  /// @throws InvalidMesh if the number differs; Cancelled. After Cancelled, only another refit may follow. Cost: O(n),
  /// a tenth of building.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// Returns the number of primitives.
  [[nodiscard]] std::size_t size() const;
  /// Returns the axis-aligned box around all primitives.
  [[nodiscard]] const Box3& bounds() const;

  /// Calls limit = visit(here, there, distance) for pairs of primitives of this hierarchy and another that may be at
  /// most `limit` apart. Pairs that seem closest come first. A visitor that lowers the limit ends the search early, at
  /// the latest with a negative limit.
  /// @param place  maps points of the other hierarchy to coordinates of this one.
  void for_each_near_pair(const OrientedBvh& other, const RigidTransform& place, double limit, Visit visit) const;

  /// Node of a hierarchy. At level -1 it is a block of primitives; above, its children are a block of boxes.
  struct Node {
    std::uint32_t index = 0;
    std::int32_t level = -1;
    [[nodiscard]] bool is_leaf() const { return level < 0; }
  };
  /// Node of this hierarchy, node of another, and a lower bound on their squared distance, up to rounding.
  struct NodePair {
    double squared_gap = 0;
    Node here, there;
  };
  /// Begins for_each_near_pair(): `dives` times, goes from the closest remaining pair of nodes down to primitives. The
  /// pairs found are mostly near the closest pair of all, and rule out most of the rest. Allocates memory.
  /// @return  the remaining pairs of nodes, closest first, for threads to share.
  [[nodiscard]] std::vector<NodePair> dive_to_near_pairs(const OrientedBvh& other, const RigidTransform& place,
                                                         double limit, std::size_t dives, Visit visit) const;
  /// Works as for_each_near_pair(), for primitives below a pair of nodes only.
  void for_each_near_pair(const NodePair& nodes, const OrientedBvh& other, const RigidTransform& place, double limit,
                          Visit visit) const;

  /// Returns the number of blocks. Primitives lie in blocks of eight, so that threads can share a loop over blocks.
  [[nodiscard]] std::size_t block_count() const;
  /// Returns all primitives in the order of the hierarchy, which keeps neighbours in space together.
  [[nodiscard]] std::span<const std::uint32_t> order() const;
  /// Returns the primitives of a block.
  [[nodiscard]] std::span<const std::uint32_t> block(std::size_t block) const;

  /// Works as for_each_near_pair(), for the primitives of one block only.
  void for_each_near_pair(std::size_t block, const OrientedBvh& other, const RigidTransform& place, double limit,
                          Visit visit) const;
  /// Works as for_each_near_pair(), for pairs of primitives of this hierarchy. Over all blocks each pair is seen once,
  /// in either order.
  void for_each_near_self_pair(std::size_t block, double limit, Visit visit) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
