#include "points/sample_elimination.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>

#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t grain = 4096;
constexpr double steepness = 8;       // of a neighbour's weight, as Yuksel has it
constexpr double floor_share = 0.65;  // below that part of what is expected distances count less
constexpr double floor_power = 1.5;
/// How much they still count; Yuksel's count nothing. Where the two sides of a thin plate are closer than points, all
/// have neighbours below the floor, and those at nearly no distance are to go first.
constexpr double below_floor = 0.3;

/// Points in cells of a grid as wide as the distance at which they are neighbours.
class Cells {
 public:
  Cells(std::span<const Vec3d> points, double width) : points_(points), width_(width) {
    for (const Vec3d& p : points) box_.extend(p);
    order_.resize(points.size());
    for (std::uint32_t k = 0; k < points.size(); ++k) order_[k] = {bucket(cell(points[k])), k};
    radix_sort(order_);
    first_.assign(buckets + 1, 0);
    for (const KeyedIndex& item : order_) ++first_[item.key + 1];
    for (std::size_t b = 0; b < buckets; ++b) first_[b + 1] += first_[b];
  }

  /// Calls visit(other, squared distance) for the points closer than the width.
  template <class Visit>
  void for_each_near(std::uint32_t point, const Visit& visit) const {
    const Vec3d& p = points_[point];
    const std::array<std::int64_t, 3> at = cell(p);
    std::array<std::uint32_t, 27> seen{};
    std::size_t count = 0;
    for (int n = 0; n < 27; ++n) {
      const std::uint32_t b = bucket({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
      // Two cells may have one bucket.
      if (std::find(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(count), b) !=
          seen.begin() + static_cast<std::ptrdiff_t>(count)) {
        continue;
      }
      seen[count++] = b;
      for (std::size_t k = first_[b]; k < first_[b + 1]; ++k) {
        const std::uint32_t other = order_[k].index;
        const double squared = squared_length(points_[other] - p);
        if (other != point && squared < width_ * width_) visit(other, squared);
      }
    }
  }

 private:
  static constexpr std::size_t buckets = std::size_t{1} << 20;

  [[nodiscard]] std::array<std::int64_t, 3> cell(const Vec3d& p) const {
    std::array<std::int64_t, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out[axis] = static_cast<std::int64_t>(std::min(std::floor((p[axis] - box_.lower[axis]) / width_), 1e15));
    }
    return out;
  }
  static std::uint32_t bucket(const std::array<std::int64_t, 3>& at) {
    std::uint64_t hash = 0;
    for (const std::int64_t x : at) {
      hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return static_cast<std::uint32_t>(hash % buckets);
  }

  std::span<const Vec3d> points_;
  double width_;
  Box3 box_;
  std::vector<KeyedIndex> order_;
  std::vector<std::uint32_t> first_;
};

/// What a neighbour weighs.
class Weight {
 public:
  Weight(double width, double share)
      : width_(width), floor_(width * (1 - std::pow(share, floor_power)) * floor_share) {}
  double operator()(double squared) const {
    const double distance = std::sqrt(squared);
    const double counted = distance < floor_ ? floor_ - below_floor * (floor_ - distance) : distance;
    return std::pow(1 - counted / width_, steepness);
  }

 private:
  double width_;
  double floor_;
};

}  // namespace

std::vector<std::uint32_t> most_even(std::span<const Vec3d> points, std::size_t count, double area,
                                     const Context& context) {
  // Points in a lattice of triangles would be 2 r apart; neighbours are those closer than that.
  const double width = 2 * std::sqrt(area / (2 * std::numbers::sqrt3 * static_cast<double>(count)));
  const Cells cells(points, width);
  const Weight weight(width, static_cast<double>(count) / static_cast<double>(points.size()));
  std::vector<double> sum(points.size());
  parallel_for(context, points.size(), grain, "weights", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      cells.for_each_near(static_cast<std::uint32_t>(k),
                          [&](std::uint32_t, double squared) { sum[k] += weight(squared); });
    }
  });
  // The heaviest on top; entries whose weight has changed are looked at again when they come up.
  using Entry = std::tuple<double, std::uint32_t>;
  std::vector<Entry> entries;
  entries.reserve(points.size());
  for (std::uint32_t k = 0; k < points.size(); ++k) entries.emplace_back(sum[k], k);
  std::priority_queue<Entry> heap({}, std::move(entries));
  std::vector<std::uint8_t> is_gone(points.size(), 0);
  for (std::size_t left = points.size(); left > count;) {
    const auto [was, point] = heap.top();
    heap.pop();
    if (was != sum[point]) {  // lighter by now
      heap.emplace(sum[point], point);
      continue;
    }
    is_gone[point] = 1;
    if (--left % grain == 0) throw_if_cancelled(context);
    cells.for_each_near(point, [&](std::uint32_t other, double squared) {
      if (is_gone[other] == 0) sum[other] -= weight(squared);
    });
  }
  std::vector<std::uint32_t> out;
  out.reserve(count);
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (is_gone[k] == 0) out.push_back(k);
  }
  return out;
}

}  // namespace blum::detail
