// Proves that the rectangles, segments and corners of boxes tile the common sides, edges and corners of the boxes for
// any cuts.
#include "solid/model/box_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "blum/core/random.hpp"

namespace blum::detail {
namespace {

constexpr std::int32_t cubes_along = 5;  // the outermost cubes stay whole

/// Cubes of a lattice cut into boxes, and the whole cubes around them.
struct Boxes {
  GridPlanes planes{{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {cubes_along, cubes_along, cubes_along}};
  CellLattice lattice{{cubes_along, cubes_along, cubes_along}};
  std::vector<BoxCell> boxes;
  std::vector<BoxCell> around;
};

BoxCell whole_cube(const Boxes& all, std::int32_t i, std::int32_t j, std::int32_t k) {
  return {all.planes.node({i, j, k}), all.planes.node({i + 1, j + 1, k + 1}), cell_at(all.lattice.node(i, j, k), 7)};
}

/// Cuts each inner cube up to the given number of times, at multiples of 1 / parts. Edges of neighbours meet, cross and
/// miss each other.
Boxes random_boxes(Random& random, std::uint64_t cuts, std::uint64_t parts) {
  Boxes out;
  for (std::int32_t k = 0; k < cubes_along; ++k) {
    for (std::int32_t j = 0; j < cubes_along; ++j) {
      for (std::int32_t i = 0; i < cubes_along; ++i) {
        const auto is_outer = [](std::int32_t at) { return at == 0 || at + 1 == cubes_along; };
        if (is_outer(i) || is_outer(j) || is_outer(k)) {
          out.around.push_back(whole_cube(out, i, j, k));
          continue;
        }
        std::vector<BoxCell> own{whole_cube(out, i, j, k)};
        for (std::uint64_t n = random.below(cuts + 1); n > 0; --n) {
          BoxCell& lower = own[random.below(own.size())];
          const std::size_t axis = random.below(3);
          const double at =
              own.front().low[axis] + static_cast<double>(random.below(parts)) / static_cast<double>(parts);
          if (!(lower.low[axis] < at && at < lower.high[axis])) continue;
          BoxCell upper = lower;
          lower.high[axis] = upper.low[axis] = at;
          own.push_back(upper);
        }
        out.boxes.insert(out.boxes.end(), own.begin(), own.end());
      }
    }
  }
  return out;
}

class BoxCellsCheck {
 public:
  explicit BoxCellsCheck(const Boxes& all) : all_(all), cells_(all.boxes, all.planes, all.lattice) {}

  void run() {
    check_rectangles();
    check_pairs();
    check_segments();
    check_sides_of_boxes();
    check_euler();
  }
  [[nodiscard]] const BoxCells& cells() const { return cells_; }

 private:
  [[nodiscard]] const BoxCell& box(const BoxRef& ref) const {
    if (ref.is_box) return all_.boxes[ref.id];
    return *std::find_if(all_.around.begin(), all_.around.end(), [&](const BoxCell& b) { return b.cube == ref.id; });
  }
  [[nodiscard]] Vec3d end(std::uint32_t segment, std::size_t k) const {
    return cells_.corners()[cells_.segments()[segment].ends[k]];
  }
  [[nodiscard]] Vec3d low(const BoxRectangle& r) const { return end(r.sides[0].front(), 0); }
  [[nodiscard]] Vec3d high(const BoxRectangle& r) const { return end(r.sides[1].back(), 1); }

  void check_rectangles() {
    for (const BoxRectangle& r : cells_.rectangles()) {
      const BoxCell& below = box(r.boxes[0]);
      const BoxCell& above = box(r.boxes[1]);
      ASSERT_EQ(below.high[r.axis], above.low[r.axis]);
      const Vec3d from = low(r);
      const Vec3d to = high(r);
      for (std::size_t a = 0; a < 3; ++a) {
        if (a == r.axis) {
          ASSERT_EQ(from[a], below.high[a]);
          ASSERT_EQ(to[a], below.high[a]);
        } else {
          ASSERT_EQ(from[a], std::max(below.low[a], above.low[a]));
          ASSERT_EQ(to[a], std::min(below.high[a], above.high[a]));
        }
      }
      const std::size_t lower = r.axis == 0 ? 1 : 0;
      const std::size_t upper = 3 - r.axis - lower;
      for (std::size_t side = 0; side < 4; ++side) {
        ASSERT_FALSE(r.sides[side].empty());
        const std::size_t along = side < 2 ? lower : upper;
        const std::size_t across = lower + upper - along;
        Vec3d at = from;
        if (side % 2 == 1) at[across] = to[across];
        for (const std::uint32_t s : r.sides[side]) {
          ASSERT_EQ(cells_.segments()[s].axis, along);
          ASSERT_EQ(end(s, 0), at);
          at = end(s, 1);
        }
        ASSERT_EQ(at[along], to[along]);
      }
    }
  }

  /// True if the boxes share more than an edge.
  static bool touch(const BoxCell& x, const BoxCell& y) {
    int touching = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (x.high[a] < y.low[a] || y.high[a] < x.low[a]) return false;
      if (x.high[a] == y.low[a] || y.high[a] == x.low[a]) ++touching;
    }
    return touching == 1;
  }

  void check_pairs() {
    std::size_t count = 0;
    for (std::uint32_t b = 0; b < all_.boxes.size(); ++b) {
      for (std::uint32_t other = 0; other < b; ++other) {
        if (!touch(all_.boxes[b], all_.boxes[other])) continue;
        ++count;
        const auto& found = cells_.rectangles()[cells_.rectangle({b, true}, {other, true})].boxes;
        ASSERT_TRUE((found == std::array{BoxRef{b, true}, BoxRef{other, true}}) ||
                    (found == std::array{BoxRef{other, true}, BoxRef{b, true}}));
      }
      for (const BoxCell& cube : all_.around) count += touch(all_.boxes[b], cube) ? 1U : 0U;
    }
    ASSERT_EQ(cells_.rectangles().size(), count);
  }

  [[nodiscard]] BoxRef holder(const Vec3d& p) const {
    const auto holds = [&](const BoxCell& b) {
      return b.low.x < p.x && p.x < b.high.x && b.low.y < p.y && p.y < b.high.y && b.low.z < p.z && p.z < b.high.z;
    };
    for (std::uint32_t b = 0; b < all_.boxes.size(); ++b) {
      if (holds(all_.boxes[b])) return {b, true};
    }
    return {std::find_if(all_.around.begin(), all_.around.end(), holds)->cube, false};
  }

  void check_segments() {
    std::set<std::array<std::uint32_t, 2>> all;
    for (std::uint32_t s = 0; s < cells_.segments().size(); ++s) {
      const BoxSegment& segment = cells_.segments()[s];
      ASSERT_TRUE(all.insert(segment.ends).second);
      const Vec3d from = end(s, 0);
      const Vec3d to = end(s, 1);
      const Vec3d middle = (from + to) * 0.5;
      ASSERT_LT(from[segment.axis], to[segment.axis]);
      for (const Vec3d& p : cells_.corners()) {
        Vec3d there = from;
        there[segment.axis] = p[segment.axis];
        ASSERT_FALSE(there == p && from[segment.axis] < p[segment.axis] && p[segment.axis] < to[segment.axis]);
      }
      for (std::size_t q = 0; q < 4; ++q) {
        Vec3d beside = middle;
        beside[(segment.axis + 1) % 3] += (q & 1U) != 0 ? 1e-6 : -1e-6;
        beside[(segment.axis + 2) % 3] += (q & 2U) != 0 ? 1e-6 : -1e-6;
        ASSERT_EQ(segment.around[q], holder(beside));
      }
      check_rectangles_at(s);
    }
  }

  void check_rectangles_at(std::uint32_t s) {
    const BoxSegment& segment = cells_.segments()[s];
    for (const BoxRef& ref : segment.around) {
      if (!ref.is_box) continue;
      std::vector<std::uint32_t> expected;
      for (std::uint32_t r = 0; r < cells_.rectangles().size(); ++r) {
        const BoxRectangle& rectangle = cells_.rectangles()[r];
        if (rectangle.boxes[0] != ref && rectangle.boxes[1] != ref) continue;
        for (const auto& side : rectangle.sides) {
          if (std::find(side.begin(), side.end(), s) != side.end()) expected.push_back(r);
        }
      }
      auto found = cells_.rectangles_at(segment, ref);
      std::sort(found.begin(), found.end());
      ASSERT_EQ(std::vector(found.begin(), found.end()), expected);
    }
  }

  /// Segments tile the edges of each box, and rectangles its sides.
  void check_sides_of_boxes() {
    for (std::uint32_t b = 0; b < all_.boxes.size(); ++b) {
      const BoxCell& own = all_.boxes[b];
      const Vec3d size = own.high - own.low;
      std::array<double, 6> area{};
      for (const BoxRectangle& r : cells_.rectangles()) {
        const Vec3d extent = high(r) - low(r);
        for (std::size_t above = 0; above < 2; ++above) {
          if (r.boxes[1 - above] != BoxRef{b, true}) continue;
          area[2 * r.axis + above] += extent[(r.axis + 1) % 3] * extent[(r.axis + 2) % 3];
        }
      }
      std::array<double, 3> lengths{};
      for (std::uint32_t s = 0; s < cells_.segments().size(); ++s) {
        const std::size_t axis = cells_.segments()[s].axis;
        if (is_on_edge(own, axis, end(s, 0), end(s, 1))) lengths[axis] += end(s, 1)[axis] - end(s, 0)[axis];
      }
      for (std::size_t a = 0; a < 3; ++a) {
        const double side = size[(a + 1) % 3] * size[(a + 2) % 3];
        ASSERT_NEAR(area[2 * a], side, 1e-12);
        ASSERT_NEAR(area[2 * a + 1], side, 1e-12);
        ASSERT_NEAR(lengths[a], 4 * size[a], 1e-12);
      }
    }
  }
  static bool is_on_edge(const BoxCell& own, std::size_t axis, const Vec3d& from, const Vec3d& to) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (a == axis ? from[a] < own.low[a] || to[a] > own.high[a] : from[a] != own.low[a] && from[a] != own.high[a]) {
        return false;
      }
    }
    return true;
  }

  /// The inner cubes form one ball.
  void check_euler() {
    const auto count = [](std::size_t size) { return static_cast<std::int64_t>(size); };
    EXPECT_EQ(count(cells_.corners().size()) - count(cells_.segments().size()) + count(cells_.rectangles().size()) -
                  count(all_.boxes.size()),
              1);
    EXPECT_TRUE(std::is_sorted(cells_.corners().begin(), cells_.corners().end(), [](const Vec3d& a, const Vec3d& b) {
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    }));
  }

  const Boxes& all_;
  BoxCells cells_;
};

TEST(BoxCells, OfWholeCubesEqualThoseOfTheGrid) {
  Random random(1);
  const Boxes all = random_boxes(random, 0, 2);
  BoxCellsCheck check(all);
  check.run();
  EXPECT_EQ(all.boxes.size(), 27U);
  EXPECT_EQ(check.cells().corners().size(), 64U);
  EXPECT_EQ(check.cells().segments().size(), 144U);
  EXPECT_EQ(check.cells().rectangles().size(), 108U);
}

TEST(BoxCells, TileTheCommonPartsOfRandomBoxes) {
  Random random(2);
  std::size_t in_parts = 0;
  for (std::size_t k = 0; k < 24; ++k) {
    const Boxes all = random_boxes(random, 1 + random.below(3), std::array{2U, 3U, 16U, 1000U}[k % 4]);
    BoxCellsCheck check(all);
    ASSERT_NO_FATAL_FAILURE(check.run());
    for (const BoxRectangle& r : check.cells().rectangles()) {
      for (const auto& side : r.sides) in_parts += side.size() > 1 ? 1U : 0U;
    }
  }
  EXPECT_GT(in_parts, 100U);
}

/// Two cubes are halved in different directions. Their edges cross in the square between them.
TEST(BoxCells, EdgesThatCrossWithinASideMeetInACorner) {
  Random random(3);
  Boxes all = random_boxes(random, 0, 2);
  const auto halve = [&](std::size_t b, std::size_t axis) {
    BoxCell upper = all.boxes[b];
    all.boxes[b].high[axis] = upper.low[axis] = upper.low[axis] + 0.5;
    all.boxes.push_back(upper);
  };
  halve(0, 1);
  halve(1, 2);  // its neighbour along x
  BoxCellsCheck check(all);
  ASSERT_NO_FATAL_FAILURE(check.run());
  const auto corners = check.cells().corners();
  EXPECT_EQ(std::count(corners.begin(), corners.end(), Vec3d{2, 1.5, 1.5}), 1);
  EXPECT_EQ(corners.size(), 64U + 4 + 4 + 1);
}

}  // namespace
}  // namespace blum::detail
