// Proves that the hierarchy of moving boxes reports each touching pair once, by comparison with all pairs. It reports
// no pair that is apart by more than rounding.
#include "blum/geometry/moving_box_bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"

namespace blum {
namespace {

using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;

bool are_apart(const MovingBox& a, const MovingBox& b, double margin) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto gap = [&](const MovingBox& low, const MovingBox& high) {
      return std::min(high.start.lower[axis] - low.start.upper[axis], high.end.lower[axis] - low.end.upper[axis]);
    };
    if (std::max(gap(a, b), gap(b, a)) > margin) return true;
  }
  return false;
}

std::vector<MovingBox> random_boxes(Random& random, std::size_t count, double size, double speed, const Vec3d& place) {
  std::vector<MovingBox> boxes(count);
  for (MovingBox& box : boxes) {
    const Vec3d at = place + random.in_cube();
    const Vec3d by = random.in_ball() * speed;
    for (int k = 0; k < 2; ++k) {
      box.start.extend(at + random.in_cube() * size);
      box.end.extend(at + by + random.in_cube() * size);
    }
  }
  return boxes;
}

/// Checks that each touching pair is reported once, and no pair that is apart by more than rounding.
void expect_pairs(const std::vector<MovingBox>& here, const std::vector<MovingBox>& there, const Pairs& seen,
                  bool is_self, double rounding) {
  for (std::uint32_t i = 0; i < here.size(); ++i) {
    for (std::uint32_t k = is_self ? i + 1 : 0; k < there.size(); ++k) {
      const std::size_t count = seen.count({i, k}) + (is_self ? seen.count({k, i}) : 0);
      ASSERT_LE(count, 1U);
      if (!are_apart(here[i], there[k], 0)) {
        ASSERT_EQ(count, 1U) << i << " " << k;
      } else if (are_apart(here[i], there[k], rounding)) {
        ASSERT_EQ(count, 0U) << i << " " << k;
      }
    }
  }
}

Pairs pairs_of(const MovingBoxBvh& here, const MovingBoxBvh& there) {
  Pairs out;
  for (std::size_t block = 0; block < here.block_count(); ++block) {
    here.for_each_pair(block, there, [&](std::uint32_t i, std::uint32_t k) { out.emplace(i, k); });
  }
  return out;
}

Pairs self_pairs_of(const MovingBoxBvh& boxes) {
  Pairs out;
  for (std::size_t block = 0; block < boxes.block_count(); ++block) {
    boxes.for_each_self_pair(block, [&](std::uint32_t i, std::uint32_t k) { out.emplace(i, k); });
  }
  return out;
}

TEST(MovingBoxBvh, AgreesWithASearchOverAllPairs) {
  Random random(1);
  for (const std::size_t count : {1U, 2U, 7U, 8U, 9U, 64U, 65U, 300U}) {
    for (const double speed : {0.0, 0.1, 2.0}) {
      const auto here = random_boxes(random, count, 0.2, speed, {});
      const auto there = random_boxes(random, 100, 0.1, speed, {0.3, 0, 0});
      const MovingBoxBvh a(here);
      const MovingBoxBvh b(there);
      EXPECT_EQ(a.size(), count);
      expect_pairs(here, there, pairs_of(a, b), false, 1e-5);
      expect_pairs(here, here, self_pairs_of(a), true, 1e-5);
    }
  }
}

TEST(MovingBoxBvh, FindsAllPairsAtAnyScaleAndPlace) {
  Random random(2);
  for (const double scale : {1e-300, 1e-30, 1e30, 1e149}) {
    auto boxes = random_boxes(random, 100, 0.2, 0.5, {});
    for (MovingBox& box : boxes) {
      for (Vec3d* p : {&box.start.lower, &box.start.upper, &box.end.lower, &box.end.upper}) *p *= scale;
    }
    expect_pairs(boxes, boxes, self_pairs_of(MovingBoxBvh(boxes)), true, 1e-5 * scale);
  }
  const auto far = random_boxes(random, 100, 0.2, 0.5, {1e9, -1e9, 0});
  expect_pairs(far, far, self_pairs_of(MovingBoxBvh(far)), true, 1e-5);
}

/// Boxes far beyond single precision must not match lanes without a box.
TEST(MovingBoxBvh, FindsNothingBesideItsBoxes) {
  const std::vector<MovingBox> small{{{{0, 0, 0}, {1e-3, 1e-3, 1e-3}}, {{0, 0, 0}, {1e-3, 1e-3, 1e-3}}}};
  const MovingBoxBvh few(small);
  Random random(4);
  const MovingBoxBvh many(random_boxes(random, 70, 1e-3, 0, {}));
  for (const double far : {1e36, 1e39, 1e150, 1e308}) {
    for (const double sign : {1.0, -1.0}) {
      const Vec3d at{sign * far, sign * far, sign * far};
      const MovingBox beyond{{at, at}, {at, at}};
      const MovingBox leaving{{{}, {}}, {at, at}};
      const MovingBoxBvh away(std::vector{beyond});
      EXPECT_TRUE(pairs_of(away, few).empty());
      EXPECT_TRUE(pairs_of(away, many).empty());
      EXPECT_EQ(pairs_of(MovingBoxBvh(std::vector{leaving}), few).size(), 1U);
    }
  }
}

/// The boxes are points, flat or equal, or touch exactly.
TEST(MovingBoxBvh, FindsAllPairsOfDegenerateBoxes) {
  Random random(3);
  std::vector<MovingBox> boxes(200);
  for (MovingBox& box : boxes) {
    const auto corner = [&] {
      const double x = static_cast<double>(random.below(3));
      const double y = static_cast<double>(random.below(3));
      return Vec3d{x, y, static_cast<double>(random.below(3))};
    };
    for (std::uint64_t k = 0; k <= random.below(2); ++k) box.start.extend(corner());
    for (std::uint64_t k = 0; k <= random.below(2); ++k) box.end.extend(corner());
  }
  expect_pairs(boxes, boxes, self_pairs_of(MovingBoxBvh(boxes)), true, 0);
  const std::vector<MovingBox> same(50, boxes[0]);
  EXPECT_EQ(self_pairs_of(MovingBoxBvh(same)).size(), 50U * 49 / 2);
}

TEST(MovingBoxBvh, EmptyTreesHaveNoPairs) {
  const MovingBoxBvh none(std::vector<MovingBox>{});
  EXPECT_EQ(none.size(), 0U);
  EXPECT_EQ(none.block_count(), 0U);
  const MovingBoxBvh one(std::vector<MovingBox>{{{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {1, 1, 1}}}});
  EXPECT_TRUE(pairs_of(one, none).empty());
  EXPECT_TRUE(self_pairs_of(one).empty());
}

/// Two boxes fly through one place, one after the other. The bounds of their motions meet, but the boxes do not.
TEST(MovingBoxBvh, SeparatesBoxesThatPassOneAfterTheOther) {
  const MovingBox first{{{0, 0, 0}, {1, 1, 0.1}}, {{0, 0, 5}, {1, 1, 5.1}}};
  const MovingBox second{{{0, 0, 1}, {1, 1, 1.1}}, {{0, 0, 6}, {1, 1, 6.1}}};
  EXPECT_TRUE(self_pairs_of(MovingBoxBvh(std::vector{first, second})).empty());
}

}  // namespace
}  // namespace blum
