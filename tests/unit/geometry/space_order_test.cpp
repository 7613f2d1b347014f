// Proves that each cut of space_order() has the points of a full sort on its sides, for any number of threads. Points
// are random, equal, sorted, in lattices or on lines.
#include "blum/geometry/space_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/core/vec3.hpp"

namespace blum {
namespace {

Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Cuts like space_order(), but sorts all points of a range for each cut.
class SlowOrder {
 public:
  explicit SlowOrder(const std::vector<Vec3d>& points) : order(points.size()) {
    std::iota(order.begin(), order.end(), 0U);
    Box3 box;
    for (const Vec3d& p : points) box.extend(p);
    const Vec3d size = points.empty() ? Vec3d{} : box.size();
    const double longest = std::max({size.x, size.y, size.z});
    for (const Vec3d& p : points) at_.push_back(longest > 0 ? to_float((p - box.lower) / longest) : Vec3f{});
    cut(0, points.size());
  }

  std::vector<std::uint32_t> order;

 private:
  void cut(std::size_t begin, std::size_t end) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(end);
    std::sort(first, last);
    if (end - begin <= 8) return;
    Vec3f lower = at_[order[begin]];
    Vec3f upper = lower;
    for (auto k = first; k != last; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], at_[*k][axis]);
        upper[axis] = std::max(upper[axis], at_[*k][axis]);
      }
    }
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (upper[axis] - lower[axis] > upper[longest] - lower[longest]) longest = axis;
    }
    std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(at_[a][longest], a) < std::pair(at_[b][longest], b);
    });
    const std::size_t middle = begin + std::bit_ceil(end - begin) / 2;
    cut(begin, middle);
    cut(middle, end);
  }

  std::vector<Vec3f> at_;
};

void expect_as_slow(const std::vector<Vec3d>& points) {
  const std::vector<std::uint32_t> expected = SlowOrder(points).order;
  for (const int threads : {1, 3}) {
    const auto order = space_order(points.size(), [&](std::size_t k) { return points[k]; }, {.threads = threads});
    ASSERT_EQ(order, expected) << points.size() << " points";
  }
}

TEST(SpaceOrder, AgreesWithFullSorts) {
  for (const std::size_t count : {0U, 1U, 2U, 8U, 9U, 17U, 49U, 50U, 100U, 129U, 1000U, 5000U, 20000U}) {
    SCOPED_TRACE(count);
    Random random(count);
    std::vector<Vec3d> at_random(count);
    for (Vec3d& p : at_random) p = random.in_cube();
    expect_as_slow(at_random);
    std::vector<Vec3d> sorted = at_random;
    std::sort(sorted.begin(), sorted.end(), [](const Vec3d& a, const Vec3d& b) { return a.x < b.x; });
    expect_as_slow(sorted);
    std::reverse(sorted.begin(), sorted.end());
    expect_as_slow(sorted);
    expect_as_slow(std::vector<Vec3d>(count, Vec3d{1, -2, 3}));
    // Few different coordinates give many ties, in runs that regular samples of the entries miss.
    std::vector<Vec3d> lattice(count);
    for (std::size_t k = 0; k < count; ++k) {
      lattice[k] = {static_cast<double>(k % 5), static_cast<double>(k / 5 % 7), static_cast<double>(k % 3 == 0)};
    }
    expect_as_slow(lattice);
    std::vector<Vec3d> saws(count);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t period = std::max<std::size_t>(count / 64, 1);
      saws[k] = {static_cast<double>(k % period), 0, 0};
    }
    expect_as_slow(saws);
    std::vector<Vec3d> crowd(count);
    for (std::size_t k = 0; k < count; ++k) crowd[k] = random.in_ball() * std::pow(10.0, -random.uniform(0, 12));
    expect_as_slow(crowd);
  }
}

/// -0.0 is the same coordinate as 0.0, also if both are the lowest.
TEST(SpaceOrder, OfNegativeZeros) {
  std::vector<Vec3d> points(32);
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = {k % 2 == 0 ? 0.0 : -0.0, 0, 0};
  points[31] = {1, 0, 0};
  expect_as_slow(points);
  const auto order = space_order(points.size(), [&](std::size_t k) { return points[k]; }, {});
  for (std::uint32_t k = 0; k < order.size(); ++k) EXPECT_EQ(order[k], k);
}

}  // namespace
}  // namespace blum
