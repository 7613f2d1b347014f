// Blum: a bounding-volume hierarchy of oriented boxes, for close pairs. SPDX-License-Identifier: Apache-2.0
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
/// surface. It finds pairs of primitives of two meshes that may be close. The hierarchy for closest points and rays is
/// Bvh. Primitives are numbered consecutively: the triangles, then the segments, then the points of the mesh.
///
/// All queries may run on many threads at once. Only the queries that return pairs of nodes allocate memory. Every pair
/// whose distance is within the limit is visited. Pairs that are farther apart may be visited, too. The hierarchy
/// determines these additional pairs and the order of visits. Cost: O(n log n) time to build, about 0.3 microseconds
/// per primitive, and 150 bytes per primitive.
class OrientedBvh {
 public:
  /// Limits on the pairs that the rest of a search visits. A visitor returns them.
  struct Wanted {
    double limit;                           ///< largest distance of a pair; if it is negative, the search ends
    std::uint32_t last_there = 0xffffffff;  ///< primitives of the other hierarchy with a larger index are not visited
    std::uint32_t last_here = 0xffffffff;   ///< primitives of this hierarchy with a larger index are not visited

    Wanted(double limit_) : limit(limit_) {}  // NOLINT(google-explicit-constructor): usually only a distance
    Wanted(double limit_, std::uint32_t last_there_) : limit(limit_), last_there(last_there_) {}
    Wanted(double limit_, std::uint32_t last_there_, std::uint32_t last_here_)
        : limit(limit_), last_there(last_there_), last_here(last_here_) {}
  };

  /// Visitor: a function that is called with a primitive of this hierarchy, a primitive of the other hierarchy, and a
  /// lower bound on their distance. It returns the limits for the rest of the search. Limits can only become narrower.
  using Visit = FunctionRef<Wanted(std::uint32_t, std::uint32_t, double)>;

  /// @param mesh  must pass validate(mesh). @throws Cancelled.
  explicit OrientedBvh(const MeshView& mesh, const Context& context = {});
  OrientedBvh(OrientedBvh&&) noexcept;
  OrientedBvh& operator=(OrientedBvh&&) noexcept;
  ~OrientedBvh();

  /// Updates the hierarchy to moved vertices of the same primitives. Queries become slower if primitives that were
  /// neighbours move apart; build a new hierarchy in this case. Must not run at the same time as queries.
  /// @param vertices  the new positions, one for each vertex of the mesh. Vertices that a triangle, segment or point
  ///                  uses must be finite.
  /// @throws InvalidMesh if the number of vertices has changed; Cancelled. After Cancelled, refit() must be called
  /// again before any other function. Cost: O(n), a tenth of the time to build a hierarchy.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// Returns the number of primitives.
  [[nodiscard]] std::size_t size() const;
  /// Returns the axis-aligned box around all primitives.
  [[nodiscard]] const Box3& bounds() const;

  /// Calls limit = visit(a, b, distance) for each primitive a of this hierarchy and each primitive b of `other` that
  /// may be at most `limit` apart. Pairs are visited approximately in rising order of the lower bounds on their
  /// distances. A visitor that returns a lower limit shortens the search; a negative limit ends it.
  /// @param place  maps points of the other hierarchy to coordinates of this hierarchy.
  void for_each_near_pair(const OrientedBvh& other, const RigidTransform& place, double limit, Visit visit) const;

  /// Node of a hierarchy. A node at level -1 is a block of primitives. A node at a higher level is a block of the boxes
  /// of its children.
  struct Node {
    std::uint32_t index = 0;
    std::int32_t level = -1;
    [[nodiscard]] bool is_leaf() const { return level < 0; }
  };
  /// Node of this hierarchy (`here`), node of the other hierarchy (`there`), and a lower bound on their squared
  /// distance, up to rounding. If the boxes of the nodes overlap, the bound is minus the square of the overlap.
  struct NodePair {
    double squared_gap = 0;
    Node here, there;
  };
  /// Does the first steps of for_each_near_pair(). The search descends `dives` times from the closest remaining pair of
  /// nodes to primitives, and visits the pairs of primitives that it finds. The visited pairs are mostly near the
  /// closest pair of all, so their distances exclude most other pairs. Allocates memory.
  /// @return  the remaining pairs of nodes, closest first. Threads can share them.
  [[nodiscard]] std::vector<NodePair> dive_to_near_pairs(const OrientedBvh& other, const RigidTransform& place,
                                                         double limit, std::size_t dives, Visit visit) const;
  /// Works as for_each_near_pair(), but only for the primitives below pairs of nodes, and ends after `steps` steps. A
  /// step replaces a node by its children, or compares the primitives of two nodes. A step takes up to a microsecond,
  /// without the calls of `visit`.
  /// @return the remaining pairs of nodes; empty if the search is complete.
  [[nodiscard]] std::vector<NodePair> visit_some_near_pairs(std::span<const NodePair> nodes, const OrientedBvh& other,
                                                            const RigidTransform& place, double limit,
                                                            std::size_t steps, Visit visit) const;
  /// Returns the pair of the root nodes of this hierarchy and the other hierarchy.
  [[nodiscard]] NodePair whole(const OrientedBvh& other) const;

  /// Returns the number of blocks. A block is a group of up to eight primitives. Threads can share a loop over blocks.
  [[nodiscard]] std::size_t block_count() const;
  /// Returns all primitives in the order of the hierarchy, which keeps neighbours in space together.
  [[nodiscard]] std::span<const std::uint32_t> order() const;
  /// Returns the primitives of a block.
  [[nodiscard]] std::span<const std::uint32_t> block(std::size_t block) const;

  /// Works as for_each_near_pair(), but only for the primitives of one block of this hierarchy.
  void for_each_near_pair(std::size_t block, const OrientedBvh& other, const RigidTransform& place, double limit,
                          Visit visit) const;
  /// Works as for_each_near_pair(), for pairs of a primitive of one block and any primitive of this hierarchy. If this
  /// function is called for all blocks, each pair is visited once, in either order.
  void for_each_near_self_pair(std::size_t block, double limit, Visit visit) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
