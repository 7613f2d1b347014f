// Blum: boxes in a bounding-volume hierarchy. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/ray.hpp"

namespace blum {

/// Bounding-volume hierarchy over boxes, with eight children per node. It finds boxes by their position and passes
/// their indices to a function of the caller, the visitor. The hierarchy for triangles, segments and points is Bvh.
///
/// All queries may run on many threads at once. They allocate no memory except for the lists that they return. The
/// order of visits does not depend on the number of threads.
/// Cost: O(n log n) time to build, and 60 bytes per box, in contiguous arrays. A query for one box costs about O(log
/// n).
class BoxBvh {
 public:
  /// @param boxes  each box is finite or empty (Box3{}); at most max_id_count boxes. An empty box touches no other box.
  /// @throws Cancelled.
  explicit BoxBvh(std::span<const Box3> boxes, const Context& context = {});
  BoxBvh(BoxBvh&&) noexcept;
  BoxBvh& operator=(BoxBvh&&) noexcept;
  ~BoxBvh();

  /// Updates the hierarchy to moved boxes. Afterwards, queries have the same results as with a newly built hierarchy,
  /// except for the order of visits. Queries become slower if boxes that were neighbours move apart; build a new
  /// hierarchy in this case. Must not run at the same time as queries.
  /// @throws InvalidOption if the number of boxes has changed; Cancelled. After Cancelled, the hierarchy is unchanged.
  /// Cost: O(n), at most a third of the time to build a hierarchy.
  void refit(std::span<const Box3> boxes, const Context& context = {});

  [[nodiscard]] std::size_t size() const;
  /// Returns the box around all boxes.
  [[nodiscard]] const Box3& bounds() const;

  /// Calls visit(index) for each box that touches a given box, until visit() returns false.
  void for_each_touching(const Box3& box, FunctionRef<bool(std::uint32_t)> visit) const;

  /// Calls limit = visit(index) for each box whose distance from a point is at most `limit`. The value that visit()
  /// returns is the limit for the rest of the search; a lower limit ends the search earlier. Boxes are visited
  /// approximately in the order of their distances.
  void for_each_near(const Vec3d& point, double limit, FunctionRef<double(std::uint32_t)> visit) const;

  /// Calls limit = visit(index) for each box that a ray meets between t = 0 and t = limit. Boxes are visited
  /// approximately in rising order of t. No box is missed because of rounding.
  void for_each_along(const Ray& ray, double limit, FunctionRef<double(std::uint32_t)> visit) const;

  /// Calls visit(a, b) for pairs of a box a of this hierarchy and a box b of `other`. All pairs that are at most
  /// `margin` apart along every axis are visited, until visit() returns false.
  void for_each_pair(const BoxBvh& other, double margin, FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const;
  /// Does the same for pairs of boxes of this hierarchy. Each pair is visited once; either of its boxes may be a.
  void for_each_self_pair(double margin, FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const;

  /// Return all pairs (a, b) that for_each_pair() and for_each_self_pair() visit, in rising order, computed with
  /// threads. In self_pairs(), a is the smaller index.
  /// @throws Cancelled.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> pairs(const BoxBvh& other, double margin,
                                                                const Context& context = {}) const;
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> self_pairs(double margin, const Context& context = {}) const;

 private:
  /// Calls visit(rank) for the boxes that are at most `margin` apart, along every axis, from the box of a given rank.
  /// The rank of a box is its position along a curve through space. Only boxes with a rank above the given rank are
  /// visited. Stops if visit() returns false.
  void for_each_later(std::size_t rank, double margin, FunctionRef<bool(std::size_t)> visit) const;

  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
