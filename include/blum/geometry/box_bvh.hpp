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

/// Bounding-volume hierarchy over boxes, with eight children per node. It finds boxes by their position; a visitor
/// examines their contents. Boxes are named by their index. Bvh is the hierarchy for triangles, segments and points.
///
/// All queries may run on many threads at once. They allocate nothing but the lists that they return. The order in
/// which a visitor sees boxes depends on the boxes alone, not on threads.
/// Cost: O(n log n) to build, 60 bytes per box. Memory is contiguous. A query for one box costs about O(log n).
class BoxBvh {
 public:
  /// @param boxes  finite or empty (Box3{}), at most max_id_count. An empty box touches nothing.
  /// @throws Cancelled.
  explicit BoxBvh(std::span<const Box3> boxes, const Context& context = {});
  BoxBvh(BoxBvh&&) noexcept;
  BoxBvh& operator=(BoxBvh&&) noexcept;
  ~BoxBvh();

  /// Updates the hierarchy to moved boxes. Answers are those of a newly built hierarchy, but visitors may see boxes in
  /// another order. Queries get slower as boxes that were neighbours move apart; then build a new hierarchy. Must not
  /// run at the same time as queries.
  /// @throws InvalidOption if the number of boxes differs; Cancelled, which leaves the hierarchy unchanged.
  /// Cost: O(n), at most a third of building.
  void refit(std::span<const Box3> boxes, const Context& context = {});

  [[nodiscard]] std::size_t size() const;
  /// Returns the box around all boxes.
  [[nodiscard]] const Box3& bounds() const;

  /// Calls visit(box index) for the boxes that touch this box, until it returns false.
  void for_each_touching(const Box3& box, FunctionRef<bool(std::uint32_t)> visit) const;

  /// Calls limit = visit(box index) for the boxes whose distance from a point is at most `limit`. Closer boxes come
  /// first, as far as the hierarchy orders them. A visitor that lowers the limit ends the search early.
  void for_each_near(const Vec3d& point, double limit, FunctionRef<double(std::uint32_t)> visit) const;

  /// Calls limit = visit(box index) for the boxes that a ray meets between t = 0 and limit. Closer boxes come first, as
  /// far as the hierarchy orders them. No box is missed because of rounding.
  void for_each_along(const Ray& ray, double limit, FunctionRef<double(std::uint32_t)> visit) const;

  /// Calls visit(index here, index there) for pairs of boxes of two hierarchies, until it returns false. These are the
  /// pairs that are at most `margin` apart along every axis.
  void for_each_pair(const BoxBvh& other, double margin, FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const;
  /// Calls visit likewise for pairs of boxes of this hierarchy. Each pair is seen once, in either order.
  void for_each_self_pair(double margin, FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const;

  /// Returns all these pairs, computed with threads, as (index here, index there) in rising order. In self_pairs() the
  /// first index is the smaller one.
  /// @throws Cancelled.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> pairs(const BoxBvh& other, double margin,
                                                                const Context& context = {}) const;
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> self_pairs(double margin, const Context& context = {}) const;

 private:
  /// Calls visit(rank) for boxes that are at most `margin` apart from the box at this rank along every axis. Only boxes
  /// of higher rank, along a curve through space, are visited. It stops if visit() returns false.
  void for_each_later(std::size_t rank, double margin, FunctionRef<bool(std::size_t)> visit) const;

  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
