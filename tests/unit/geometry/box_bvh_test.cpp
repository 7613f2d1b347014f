// Proves that every query of a hierarchy of boxes agrees with a search over all boxes, before and after a refit. Any
// number of threads gives the same. Boxes may be empty or have no extent.
#include "blum/geometry/box_bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"

namespace blum {
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// Boxes of many sizes in the unit cube. Some are points, some are empty, some are copies of others.
std::vector<Box3> random_boxes(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box3> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d p{random.uniform(), random.uniform(), random.uniform()};
    const double size = i % 5 == 0 ? 0 : std::pow(random.uniform(), 4);
    if (i % 17 == 3) {
      boxes.push_back({});
    } else if (i % 11 == 7) {
      boxes.push_back(boxes[random.below(i)]);
    } else {
      boxes.push_back({p, p + Vec3d{random.uniform(), random.uniform(), random.uniform()} * size});
    }
  }
  return boxes;
}

bool touch(const Box3& a, const Box3& b, double margin = 0) {
  if (a.is_empty() || b.is_empty()) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] - margin > b.upper[axis] || a.upper[axis] + margin < b.lower[axis]) return false;
  }
  return true;
}

double distance(const Vec3d& p, const Box3& box) {
  if (box.is_empty()) return HUGE_VAL;
  return length(max(max(box.lower - p, p - box.upper), Vec3d{}));
}

std::set<std::uint32_t> touching(const BoxBvh& bvh, const Box3& box) {
  std::set<std::uint32_t> found;
  bvh.for_each_touching(box, [&](std::uint32_t i) {
    EXPECT_TRUE(found.insert(i).second);
    return true;
  });
  return found;
}

void expect_answers(const BoxBvh& bvh, const std::vector<Box3>& boxes, const std::vector<Box3>& places) {
  ASSERT_EQ(bvh.size(), boxes.size());
  for (const Box3& place : places) {
    std::set<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (touch(boxes[i], place)) expected.insert(i);
    }
    EXPECT_EQ(touching(bvh, place), expected);
    if (place.is_empty()) continue;
    std::set<std::uint32_t> near;
    bvh.for_each_near(place.lower, 0.1, [&](std::uint32_t i) {
      EXPECT_TRUE(near.insert(i).second);
      return 0.1;
    });
    double closest = HUGE_VAL;
    bvh.for_each_near(place.lower, HUGE_VAL,
                      [&](std::uint32_t i) { return closest = std::min(closest, distance(place.lower, boxes[i])); });
    double expected_closest = HUGE_VAL;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      const double d = distance(place.lower, boxes[i]);
      expected_closest = std::min(expected_closest, d);
      if (d <= 0.1 * (1 - 1e-12)) {
        EXPECT_TRUE(near.contains(i)) << i;
      }
      if (d > 0.1 * (1 + 1e-12)) {
        EXPECT_FALSE(near.contains(i)) << i;
      }
    }
    EXPECT_EQ(closest, expected_closest);
  }
}

TEST(BoxBvh, AgreesWithASearchOverAllBoxes) {
  for (const std::size_t count : {0UL, 1UL, 7UL, 8UL, 9UL, 64UL, 65UL, 700UL}) {
    const std::vector<Box3> boxes = random_boxes(count, count + 1);
    expect_answers(BoxBvh(boxes), boxes, random_boxes(60, 99));
  }
}

TEST(BoxBvh, AnswersLikeANewTreeAfterARefit) {
  const std::vector<Box3> before = random_boxes(300, 5);
  const std::vector<Box3> after = random_boxes(300, 6);
  BoxBvh bvh(before);
  EXPECT_THROW(bvh.refit(random_boxes(299, 6)), InvalidOption);
  expect_answers(bvh, before, random_boxes(20, 7));
  bvh.refit(after);
  expect_answers(bvh, after, random_boxes(60, 7));
  EXPECT_EQ(bvh.self_pairs(0.01), BoxBvh(after).self_pairs(0.01));
  EXPECT_EQ(bvh.bounds().lower, BoxBvh(after).bounds().lower);
  EXPECT_EQ(bvh.bounds().upper, BoxBvh(after).bounds().upper);
}

TEST(BoxBvh, PairsAgreeWithAllPairsOfBoxes) {
  const std::vector<Box3> a = random_boxes(150, 11);
  const std::vector<Box3> b = random_boxes(90, 12);
  const BoxBvh here(a);
  const BoxBvh there(b);
  for (const double margin : {0.0, 0.03}) {
    Pairs expected;
    Pairs expected_self;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
      for (std::uint32_t j = 0; j < b.size(); ++j) {
        if (touch(a[i], b[j], margin)) expected.push_back({i, j});
      }
      for (std::uint32_t j = i + 1; j < a.size(); ++j) {
        if (touch(a[i], a[j], margin)) expected_self.push_back({i, j});
      }
    }
    Pairs seen;
    here.for_each_pair(there, margin, [&](std::uint32_t i, std::uint32_t j) {
      seen.push_back({i, j});
      return true;
    });
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen, expected);
    EXPECT_EQ(here.pairs(there, margin), expected);
    EXPECT_EQ(here.pairs(there, margin, {.threads = 1}), expected);
    Pairs seen_self;
    here.for_each_self_pair(margin, [&](std::uint32_t i, std::uint32_t j) {
      seen_self.push_back({std::min(i, j), std::max(i, j)});
      return true;
    });
    std::sort(seen_self.begin(), seen_self.end());
    EXPECT_EQ(seen_self, expected_self);
    EXPECT_EQ(here.self_pairs(margin), expected_self);
  }
  int calls = 0;
  here.for_each_self_pair(0, [&](std::uint32_t, std::uint32_t) { return ++calls < 3; });
  EXPECT_EQ(calls, 3);
}

TEST(BoxBvh, RaysMissNoBox) {
  const std::vector<Box3> boxes = random_boxes(400, 21);
  const BoxBvh bvh(boxes);
  Random random(22);
  for (int trial = 0; trial < 400; ++trial) {
    // Rays aim at a corner, an edge or the inside of a box, so that they graze boxes. Some components are zero or tiny.
    const Box3& target = boxes[random.below(boxes.size())];
    if (target.is_empty()) continue;
    const Vec3d aim{trial % 2 == 0 ? target.lower.x : target.upper.x, trial % 3 == 0 ? target.lower.y : target.upper.y,
                    target.lower.z + (target.upper.z - target.lower.z) * random.uniform()};
    const Vec3d origin =
        trial % 4 == 0 ? Vec3d{aim.x, aim.y, -1} : Vec3d{-1, random.uniform(), trial % 5 == 0 ? aim.z : 2};
    const double factor = trial % 7 == 0 ? 1e-300 : trial % 7 == 1 ? 1e300 : 1;
    const Ray ray{origin, (aim - origin) * factor};
    std::set<std::uint32_t> found;
    bvh.for_each_along(ray, HUGE_VAL, [&](std::uint32_t i) {
      EXPECT_TRUE(found.insert(i).second);
      return HUGE_VAL;
    });
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].is_empty()) continue;
      // The ray meets the box from `enter` to `leave`. A difference below rounding permits both answers.
      double enter = 0;
      double leave = HUGE_VAL;
      const Vec3d d = aim - origin;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0) {
          if (origin[axis] < boxes[i].lower[axis] || origin[axis] > boxes[i].upper[axis]) leave = -1;
          continue;
        }
        const double first = (boxes[i].lower[axis] - origin[axis]) / d[axis];
        const double last = (boxes[i].upper[axis] - origin[axis]) / d[axis];
        enter = std::max(enter, std::min(first, last));
        leave = std::min(leave, std::max(first, last));
      }
      if (enter <= leave) {
        EXPECT_TRUE(found.contains(i)) << trial << ' ' << i;
      }
      if (enter > leave + 1e-12) {
        EXPECT_FALSE(found.contains(i)) << trial << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace blum
