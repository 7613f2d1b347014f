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

/// A bounding-volume hierarchy over boxes, with eight children per node: it finds the boxes that may matter, and leaves
/// it to a visitor to look at what is in them. Boxes are named by their index. For triangles, segments and points
/// there is Bvh.
///
/// All queries may run on many threads at once, and allocate nothing but what they return. The order in which a visitor
/// sees boxes depends on the boxes alone, not on threads.
/// Cost: O(n log n) to build, 60 bytes per box. Memory is contiguous; a query for one box costs about O(log n).
class BoxBvh {
 public:
  /// @param boxes  finite, or empty (Box3{}): an empty box touches nothing. At most max_id_count.
  /// @throws Cancelled.
  explicit BoxBvh(std::span<const Box3> boxes, const Context& context = {});
  BoxBvh(BoxBvh&&) noexcept;
  BoxBvh& operator=(BoxBvh&&) noexcept;
  ~BoxBvh();

  /// The same boxes moved: answers are those of a hierarchy built anew, only visitors may see boxes in another order.
  /// Queries get slower as boxes that were neighbours move apart; then build anew. Must not run beside queries.
  /// @throws InvalidOption for another count of boxes; Cancelled, which leaves the hierarchy as it was.
  /// Cost: O(n), a third of building or less.
  void refit(std::span<const Box3> boxes, const Context& context = {});

  [[nodiscard]] std::size_t size() const;
  /// Around all boxes.
  [[nodiscard]] const Box3& bounds() const;

  /// Calls visit(box index) for the boxes that touch this one, until it returns false.
  void for_each_touching(const Box3& box, FunctionRef<bool(std::uint32_t)> visit) const;

  /// Calls limit = visit(box index) for the boxes whose distance from a point is at most `limit`, near ones first as
  /// far as the hierarchy tells; a visitor that lowers the limit ends the search early.
  void for_each_near(const Vec3d& point, double limit, FunctionRef<double(std::uint32_t)> visit) const;

  /// Calls limit = visit(box index) for the boxes that a ray meets between t = 0 and limit, near ones first as far as
  /// the hierarchy tells. A box is not missed for rounding.
  void for_each_along(const Ray& ray, double limit, FunctionRef<double(std::uint32_t)> visit) const;

  /// Calls visit(index here, index there) for each pair of boxes of two hierarchies that are at most `margin` apart
  /// along every axis, until it returns false.
  void for_each_pair(const BoxBvh& other, double margin, FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const;
  /// The same for pairs of boxes of this hierarchy; each pair is seen once, in either order.
  void for_each_self_pair(double margin, FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const;

  /// All these pairs, threaded; each (index here, index there), in rising order. Of self_pairs the first is the
  /// smaller.
  /// @throws Cancelled.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> pairs(const BoxBvh& other, double margin,
                                                                const Context& context = {}) const;
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> self_pairs(double margin, const Context& context = {}) const;

 private:
  /// Calls visit(rank) for the boxes of higher rank, along a curve through space, that are at most `margin` apart from
  /// the one at this rank along every axis, until it returns false.
  void for_each_later(std::size_t rank, double margin, FunctionRef<bool(std::size_t)> visit) const;

  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
