#include "blum/geometry/box_bvh.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/space_order.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/bvh/box_tree.hpp"

namespace blum {
namespace {

constexpr std::size_t pair_grain = 256;

Vec3d center_of(const Box3& box) {
  return box.is_empty() ? Vec3d{} : box.center();
}

}  // namespace

struct BoxBvh::Data {
  Box3 bounds;
  std::vector<std::uint32_t> order;  ///< index of the box at each rank (position in spatial order)
  BoxTree tree;                      ///< leaf k is the box at rank k

  [[nodiscard]] Box3 box(std::size_t rank) const { return box_at(tree.levels.front()[rank / lanes], rank % lanes); }

  void fill(std::span<const Box3> boxes, const Context& context) {
    std::vector<Box3> sorted(boxes.size());
    Box3 around;
    for (std::size_t rank = 0; rank < sorted.size(); ++rank) {
      sorted[rank] = boxes[order[rank]];
      around.extend(sorted[rank]);
    }
    tree = make_box_tree(sorted, context);
    bounds = around;
  }
};

BoxBvh::BoxBvh(std::span<const Box3> boxes, const Context& context) : data_(std::make_unique<Data>()) {
  data_->order = space_order(boxes.size(), [&](std::size_t i) { return center_of(boxes[i]); }, context);
  data_->fill(boxes, context);
}

BoxBvh::BoxBvh(BoxBvh&&) noexcept = default;
BoxBvh& BoxBvh::operator=(BoxBvh&&) noexcept = default;
BoxBvh::~BoxBvh() = default;

void BoxBvh::refit(std::span<const Box3> boxes, const Context& context) {
  if (boxes.size() != size()) {
    throw InvalidOption("a hierarchy of " + std::to_string(size()) + " boxes cannot be refitted to " +
                        std::to_string(boxes.size()) + " boxes; build a new hierarchy");
  }
  data_->fill(boxes, context);
}

std::size_t BoxBvh::size() const {
  return data_->order.size();
}
const Box3& BoxBvh::bounds() const {
  return data_->bounds;
}

void BoxBvh::for_each_touching(const Box3& box, FunctionRef<bool(std::uint32_t)> visit) const {
  if (box.is_empty()) return;
  blum::for_each_touching(data_->tree, box, 0, [&](std::size_t rank) { return visit(data_->order[rank]); });
}

void BoxBvh::for_each_near(const Vec3d& point, double limit, FunctionRef<double(std::uint32_t)> visit) const {
  visit_near(data_->tree, point, limit, [&](std::size_t rank) { return visit(data_->order[rank]); });
}

void BoxBvh::for_each_along(const Ray& ray, double limit, FunctionRef<double(std::uint32_t)> visit) const {
  const detail::ScaledRay scaled = detail::scaled_direction(ray);
  visit_along(data_->tree, scaled.ray, limit * scaled.factor,
              [&](std::size_t rank) { return visit(data_->order[rank]) * scaled.factor; });
}

void BoxBvh::for_each_later(std::size_t rank, double margin, FunctionRef<bool(std::size_t)> visit) const {
  const Box3 box = grown(data_->box(rank), margin);
  if (box.is_empty()) return;
  blum::for_each_touching(data_->tree, box, rank + 1, [&](std::size_t other) { return other <= rank || visit(other); });
}

void BoxBvh::for_each_pair(const BoxBvh& other, double margin,
                           FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const {
  bool goes_on = true;
  for (std::size_t rank = 0; rank < size() && goes_on; ++rank) {
    other.for_each_touching(grown(data_->box(rank), margin),
                            [&](std::uint32_t there) { return goes_on = visit(data_->order[rank], there); });
  }
}

void BoxBvh::for_each_self_pair(double margin, FunctionRef<bool(std::uint32_t, std::uint32_t)> visit) const {
  bool goes_on = true;
  for (std::size_t rank = 0; rank < size() && goes_on; ++rank) {
    for_each_later(rank, margin,
                   [&](std::size_t later) { return goes_on = visit(data_->order[rank], data_->order[later]); });
  }
}

namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// Calls find(rank, pairs), which appends pairs, for all ranks. Returns all pairs, sorted.
template <class Find>
Pairs all_pairs(std::size_t ranks, const Context& context, const Find& find) {
  std::vector<Pairs> parts((ranks + pair_grain - 1) / pair_grain);
  parallel_for(context, ranks, pair_grain, "", [&](const WorkRange& range) {
    for (std::size_t rank = range.begin; rank < range.end; ++rank) find(rank, parts[range.begin / pair_grain]);
  });
  Pairs all;
  for (const Pairs& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> BoxBvh::pairs(const BoxBvh& other, double margin,
                                                        const Context& context) const {
  return all_pairs(size(), context, [&](std::size_t rank, Pairs& out) {
    other.for_each_touching(grown(data_->box(rank), margin), [&](std::uint32_t there) {
      out.push_back({data_->order[rank], there});
      return true;
    });
  });
}

std::vector<std::array<std::uint32_t, 2>> BoxBvh::self_pairs(double margin, const Context& context) const {
  return all_pairs(size(), context, [&](std::size_t rank, Pairs& out) {
    for_each_later(rank, margin, [&](std::size_t later) {
      const auto [low, high] = std::minmax(data_->order[rank], data_->order[later]);
      out.push_back({low, high});
      return true;
    });
  });
}

}  // namespace blum
