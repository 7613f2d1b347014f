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

/// Returns the first of many sampled times at which two boxes overlap by more than a margin; 2 if there is none.
double sampled_touch(const MovingBox& a, const MovingBox& b, double margin) {
  constexpr int samples = 200;
  for (int k = 0; k <= samples; ++k) {
    const double t = static_cast<double>(k) / samples;
    bool overlap = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = [&](const Vec3d& from, const Vec3d& to) { return (1 - t) * from[axis] + t * to[axis]; };
      const double a_low = at(a.start.lower, a.end.lower);
      const double a_high = at(a.start.upper, a.end.upper);
      const double b_low = at(b.start.lower, b.end.lower);
      const double b_high = at(b.start.upper, b.end.upper);
      overlap = overlap && a_low <= b_high - margin && b_low <= a_high - margin;
    }
    if (overlap) return t;
  }
  return 2;
}

/// A box that touches before the limit is visited. Far later ones are not. The visitor may lower the limit.
TEST(MovingBoxBvh, VisitsBoxesThatTouchUntilALimit) {
  Random random(9);
  std::size_t visited = 0;
  for (const Vec3d& place : {Vec3d{0, 0, 0}, Vec3d{1e6, -3e5, 1e7}}) {
    const std::vector<MovingBox> there = random_boxes(random, 400, 0.1, 1, place);
    const MovingBoxBvh tree(there);
    const double margin = 1e-9 * (1 + place.x);
    for (const MovingBox& box : random_boxes(random, 30, 0.2, 2, place)) {
      for (const double limit : {0.0, 0.25, 0.7, 1.0}) {
        std::set<std::uint32_t> seen;
        tree.visit_until(box, limit, [&](std::uint32_t k) {
          EXPECT_TRUE(seen.insert(k).second);
          return limit;
        });
        visited += seen.size();
        for (std::uint32_t k = 0; k < there.size(); ++k) {
          if (sampled_touch(box, there[k], margin) <= limit) {
            EXPECT_TRUE(seen.contains(k)) << limit << " " << k;
          }
        }
        if (limit == 0) {
          for (const std::uint32_t k : seen) {
            EXPECT_FALSE(are_apart({box.start, box.start}, {there[k].start, there[k].start}, 1e-4));
          }
        }
      }
      std::size_t calls = 0;
      tree.visit_until(box, 1, [&](std::uint32_t) {
        ++calls;
        return -1.0;
      });
      EXPECT_LE(calls, 1U);
    }
  }
  EXPECT_GT(visited, 1000U);
  MovingBoxBvh({}).visit_until({}, 1, [](std::uint32_t) { return 1.0; });
}

}  // namespace
}  // namespace blum
