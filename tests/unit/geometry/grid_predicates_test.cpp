// Proves that the predicates of grids are exact and answer as if every plane were moved down slightly. The tests
// compare them with wide integers, whose planes are moved by small fractions. Nearly degenerate doubles are compared
// with other predicates.
#include "blum/geometry/grid_predicates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum::detail {
namespace {

__extension__ using Wide = __int128;

constexpr std::size_t next(std::size_t axis) {
  return (axis + 1) % 3;
}

template <class T>
int sign(const T& value) {
  return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
}

/// Coordinates are whole numbers, planes are multiples of 1 / unit. Planes move by 1/2^18, 1/2^36, 1/2^54 along x, y,
/// z. These moves act like infinitely small ones for coordinates of magnitude up to 4. There, every predicate is the
/// sign of an integer plus multiples, smaller than 2^16, of the moves.
constexpr Wide unit = Wide{1} << 54U;
constexpr std::array<Wide, 3> moves{Wide{1} << 36U, Wide{1} << 18U, 1};

/// A plane, moved down.
Wide moved(double plane, std::size_t axis) {
  return static_cast<Wide>(plane) * unit - moves[axis];
}

/// A fraction of whole numbers.
struct Fraction {
  Wide over = 0;
  Wide under = 1;  ///< not 0

  [[nodiscard]] friend int compare(const Fraction& x, const Fraction& y) {
    return sign(x.over * y.under - y.over * x.under) * sign(x.under) * sign(y.under);
  }
};

/// A moved line along an axis. Its coordinates are multiplied by unit.
struct MovedLine {
  std::size_t axis = 0;
  Wide u = 0;
  Wide v = 0;

  MovedLine(std::size_t axis_, double u_, double v_)
      : axis(axis_), u(moved(u_, next(axis_))), v(moved(v_, next(next(axis_)))) {}
};

/// Twice the area of a triangle between a line and two points, seen against the line, times unit.
Wide area(const Vec3d& a, const Vec3d& b, const MovedLine& line) {
  const std::size_t u = next(line.axis);
  const std::size_t v = next(u);
  const auto along = [&](const Vec3d& p, std::size_t k) { return static_cast<Wide>(p[k]); };
  return (along(b, u) - along(a, u)) * (line.v - along(a, v) * unit) -
         (along(b, v) - along(a, v)) * (line.u - along(a, u) * unit);
}

/// The height at which a line crosses the plane of a triangle, times unit. It is the mean of the corners, weighted by
/// the areas opposite of them. Empty if line and plane are parallel.
std::optional<Fraction> height(const TriangleCorners& t, const MovedLine& line) {
  Fraction sum{0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Wide weight = area(t[next(k)], t[next(next(k))], line);
    sum.over += weight * static_cast<Wide>(t[k][line.axis]);
    sum.under += weight;
  }
  if (sum.under == 0) return std::nullopt;
  sum.under /= unit;  // the areas add up to that of the triangle, which is whole
  return sum;
}

/// 1 if the line goes up through the inside of a triangle, -1 if down, 0 if past the triangle.
int passage(const TriangleCorners& t, const MovedLine& line) {
  const int first = sign(area(t[0], t[1], line));
  return first == sign(area(t[1], t[2], line)) && first == sign(area(t[2], t[0], line)) ? first : 0;
}

int expected_side_of_node(const TriangleCorners& t, const Vec3d& node) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = height(t, {axis, node[next(axis)], node[next(next(axis))]});
    if (at) return compare({moved(node[axis], axis), 1}, *at) * sign(at->under);
  }
  return 0;
}

/// The place, along another axis, at which an edge passes a plane, times unit.
Fraction passing(const EdgeEnds& edge, std::size_t across, double plane, std::size_t along) {
  const auto& [a, b] = edge;
  const auto rise = static_cast<Wide>(b[across] - a[across]);
  const Wide part = moved(plane, across) - static_cast<Wide>(a[across]) * unit;
  return {static_cast<Wide>(a[along]) * unit * rise + static_cast<Wide>(b[along] - a[along]) * part, rise};
}

double small(Random& random, int range) {
  return static_cast<double>(random.below(2 * static_cast<std::uint64_t>(range) + 1)) - range;
}

Vec3d small_point(Random& random, int range) {
  const double x = small(random, range);
  const double y = small(random, range);
  return {x, y, small(random, range)};
}

TriangleCorners small_triangle(Random& random, int range) {
  const Vec3d a = small_point(random, range);
  const Vec3d b = small_point(random, range);
  return {a, b, small_point(random, range)};
}

TEST(GridPredicates, HaveTheirConventions) {
  EXPECT_TRUE(is_above(1, 1));
  EXPECT_FALSE(is_above(0.5, 1));
  EXPECT_EQ(side_of_line({Vec3d{0, 0, 0}, Vec3d{1, 0, 0}}, 2, 0.5, 1), 1);
  EXPECT_EQ(side_of_line({Vec3d{0, 0, 0}, Vec3d{1, 0, 0}}, 2, 0.5, -1), -1);
  EXPECT_EQ(side_of_line({Vec3d{0, 0, 0}, Vec3d{0, 0, 1}}, 2, 0.5, 1), 0);
  const TriangleCorners floor{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};
  EXPECT_EQ(side_of_node(floor, {0.2, 0.2, 1}), 1);
  EXPECT_EQ(side_of_node(floor, {0.2, 0.2, 0}), -1);  // the node lies below
  EXPECT_EQ(normal_sign(floor, 2), 1);
  EXPECT_EQ(normal_sign(floor, 0), 0);
  const TriangleCorners ceiling{Vec3d{0, 0, 1}, Vec3d{0, 1, 1}, Vec3d{1, 0, 1}};
  EXPECT_TRUE(is_crossed_before(floor, ceiling, 2, 0.2, 0.2));
  EXPECT_FALSE(is_crossed_before(ceiling, floor, 2, 0.2, 0.2));
  EXPECT_TRUE(passes_before({Vec3d{0, 0, 0}, Vec3d{0, 0, 1}}, {Vec3d{1, 0, 1}, Vec3d{1, 0, 0}}, 2, 0.5, 0));
}

TEST(GridPredicates, SideOfLineAgreesWithAMovedLine) {
  Random random(1);
  int degenerate = 0;
  for (int k = 0; k < 20000; ++k) {
    const EdgeEnds edge{small_point(random, 2), small_point(random, 2)};
    const double u = small(random, 2);
    const double v = small(random, 2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Wide wide = area(edge[0], edge[1], MovedLine(axis, u, v));
      const int side = side_of_line(edge, axis, u, v);
      ASSERT_EQ(side, sign(wide)) << k << " along " << axis;
      ASSERT_EQ(side_of_line({edge[1], edge[0]}, axis, u, v), -side);
      if (wide != 0 && wide < unit && wide > -unit) ++degenerate;
    }
  }
  EXPECT_GT(degenerate, 5000);
}

TEST(GridPredicates, SideOfNodeAgreesWithAMovedNode) {
  Random random(2);
  std::array<int, 3> found{};
  for (int k = 0; k < 30000; ++k) {
    const TriangleCorners t = small_triangle(random, 2);
    const Vec3d node = small_point(random, 2);
    const int side = side_of_node(t, node);
    ASSERT_EQ(side, expected_side_of_node(t, node)) << k;
    ASSERT_EQ(side_of_node({t[1], t[2], t[0]}, node), side);
    ASSERT_EQ(side_of_node({t[1], t[0], t[2]}, node), -side);
    if (orient3d(t[0], t[1], t[2], node) != 0) continue;
    ++found[side == 0 ? 0 : normal_sign(t, 0) != 0 ? 1 : 2];
  }
  EXPECT_GT(found[0], 100);  // corners on one line
  EXPECT_GT(found[1], 1000);
  EXPECT_GT(found[2], 200);  // parallel to x: y or z decide
}

TEST(GridPredicates, CrossingsAreOrderedAsOnAMovedLine) {
  Random random(3);
  int compared = 0;
  int at_one_height = 0;
  int in_one_plane = 0;
  for (int k = 0; k < 150000; ++k) {
    const std::size_t axis = static_cast<std::size_t>(k) % 3;
    const TriangleCorners x = small_triangle(random, 2);
    TriangleCorners y = small_triangle(random, 2);
    if (k % 4 == 0) y[0] = x[1];
    if (k % 8 == 0) y[1] = x[0];
    const double u = small(random, 1);
    const double v = small(random, 1);
    const MovedLine line(axis, u, v);
    if (passage(x, line) == 0 || passage(y, line) == 0) continue;
    const int order = compare(*height(x, line), *height(y, line));
    ASSERT_EQ(is_crossed_before(x, y, axis, u, v), order < 0) << k << " along " << axis;
    ASSERT_EQ(is_crossed_before(y, x, axis, u, v), order > 0) << k << " along " << axis;
    ++compared;
    MovedLine unmoved = line;
    unmoved.u = static_cast<Wide>(u) * unit;
    unmoved.v = static_cast<Wide>(v) * unit;
    if (order == 0) ++in_one_plane;
    if (order != 0 && compare(*height(x, unmoved), *height(y, unmoved)) == 0) ++at_one_height;
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(at_one_height, 100);
  EXPECT_GT(in_one_plane, 10);
}

TEST(GridPredicates, EdgesAreOrderedAsInAMovedPlane) {
  Random random(4);
  int compared = 0;
  int at_one_point = 0;
  for (int k = 0; k < 60000; ++k) {
    EdgeEnds x{small_point(random, 3), small_point(random, 3)};
    const EdgeEnds y{small_point(random, 3), k % 5 == 0 ? x[0] : small_point(random, 3)};
    const std::size_t across = static_cast<std::size_t>(k) % 3;
    const std::size_t along = (across + 1 + static_cast<std::size_t>(k) / 3 % 2) % 3;
    const double plane = small(random, 2);
    const auto passes = [&](const EdgeEnds& e) {
      return is_above(e[0][across], plane) != is_above(e[1][across], plane);
    };
    if (!passes(x) || !passes(y)) continue;
    const int order = compare(passing(x, across, plane, along), passing(y, across, plane, along));
    ASSERT_EQ(passes_before(x, y, across, plane, along), order < 0) << k;
    ASSERT_EQ(passes_before(y, x, across, plane, along), order > 0) << k;
    ASSERT_EQ(passes_before({x[1], x[0]}, y, across, plane, along), order < 0) << k;
    ++compared;
    const auto at = [&](const EdgeEnds& e) {
      return e[0][along] + (e[1][along] - e[0][along]) * (plane - e[0][across]) / (e[1][across] - e[0][across]);
    };
    if (order != 0 && std::abs(at(x) - at(y)) < 1e-9) ++at_one_point;
  }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(at_one_point, 500);
}

/// The order of two triangles at an edge follows from a corner of one: its side of the other and of the edge.
TEST(GridPredicates, OrderOfTrianglesAtAnEdgeFollowsFromSides) {
  Random random(5);
  int compared = 0;
  for (int k = 0; k < 20000; ++k) {
    const std::size_t axis = static_cast<std::size_t>(k) % 3;
    const Vec3d a = random.in_cube();
    const Vec3d b = random.in_cube();
    // The line is as close to a point of the edge as doubles permit, or further off. The triangles lie nearly in one
    // plane or not.
    const double off = k % 3 == 0 ? 0 : std::ldexp(random.uniform(-1, 1), -static_cast<int>(random.below(60)));
    const Vec3d on = a + (b - a) * random.uniform();
    const Vec3d c = random.in_cube();
    Vec3d d = a + (b - a) * random.uniform(-1, 1) + (c - a) * random.uniform(0.2, 2);
    if (k % 2 == 0) d[axis] += std::ldexp(random.uniform(-1, 1), -static_cast<int>(random.below(60)));
    const double u = on[next(axis)] + off;
    const double v = on[next(next(axis))];
    const TriangleCorners one{a, b, c};
    const TriangleCorners other{b, a, d};
    const int facing = normal_sign(one, axis);
    const int facing_other = normal_sign(other, axis);
    if (facing == 0 || facing_other == 0) continue;
    const int above = orient3d(a, b, c, d) * facing;  // d above the plane of `one`
    const int side_of_d = -facing_other;              // of the edge, seen against the axis
    const int order = above * side_of_d * side_of_line({a, b}, axis, u, v);
    ASSERT_EQ(is_crossed_before(one, other, axis, u, v), order > 0) << k;
    ASSERT_EQ(is_crossed_before(other, one, axis, u, v), order < 0) << k;
    ASSERT_EQ(is_crossed_before({b, c, a}, {d, a, b}, axis, u, v), order > 0) << k;
    ++compared;
  }
  EXPECT_GT(compared, 15000);
}

/// The height of a triangle of whole numbers at an unmoved line, times twice its area.
Wide six_volumes(const TriangleCorners& t, std::size_t axis, double u, double v, Wide& twice_area) {
  const std::size_t x = next(axis);
  const std::size_t y = next(x);
  Wide sum = 0;
  twice_area = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& p = t[next(k)];
    const Vec3d& q = t[next(next(k))];
    const Wide weight = static_cast<Wide>(q[x] - p[x]) * static_cast<Wide>(v - p[y]) -
                        static_cast<Wide>(q[y] - p[y]) * static_cast<Wide>(u - p[x]);
    sum += weight * static_cast<Wide>(t[k][axis]);
    twice_area += weight;
  }
  return sum;
}

TEST(GridPredicates, LargeTrianglesNearlyInOnePlane) {
  Random random(6);
  constexpr int range = 1 << 17;
  int apart = 0;
  int together = 0;
  for (int k = 0; k < 20000; ++k) {
    const std::size_t axis = static_cast<std::size_t>(k) % 3;
    const TriangleCorners x = small_triangle(random, range);
    TriangleCorners y = x;
    for (Vec3d& p : y) p = x[0] + small(random, 2) * (x[1] - x[0]) + small(random, 2) * (x[2] - x[0]);
    if (k % 3 != 0) y[random.below(3)][axis] += small(random, 1);
    // Both triangles cross the line near a corner.
    const Vec3d& near = y[random.below(3)];
    const double u = near[next(axis)] + small(random, 1);
    const double v = near[next(next(axis))] + small(random, 1);
    Wide area_x = 0;
    Wide area_y = 0;
    const Wide volume_x = six_volumes(x, axis, u, v, area_x);
    const Wide volume_y = six_volumes(y, axis, u, v, area_y);
    if (area_x == 0 || area_y == 0) continue;
    const int order = sign(volume_x * area_y - volume_y * area_x) * sign(area_x) * sign(area_y);
    if (order == 0) {  // the move decides, unless both lie in one plane
      EXPECT_FALSE(is_crossed_before(x, y, axis, u, v) && is_crossed_before(y, x, axis, u, v));
      ++together;
      continue;
    }
    ASSERT_EQ(is_crossed_before(x, y, axis, u, v), order < 0) << k;
    ASSERT_EQ(is_crossed_before(y, x, axis, u, v), order > 0) << k;
    ++apart;
  }
  EXPECT_GT(apart, 3000);
  EXPECT_GT(together, 3000);
}

/// Many triangles pass nearly through one point. Each comes before all later ones.
TEST(GridPredicates, OrderOfCrossingsIsTransitive) {
  Random random(7);
  for (int k = 0; k < 60; ++k) {
    const std::size_t axis = static_cast<std::size_t>(k) % 3;
    const Vec3d p = random.in_cube();
    std::vector<TriangleCorners> row;
    while (row.size() < 24) {
      const Vec3d a = random.in_ball();
      const Vec3d b = random.in_ball();
      TriangleCorners t{p + a, p + b, p - a - b};
      if (row.size() % 3 == 1) t[2][axis] += 0x1p-51;
      if (row.size() % 3 == 2) t = {t[0] * 3.0 - t[1] * 2.0, t[1] * 3.0 - t[2] * 2.0, t[2] * 3.0 - t[0] * 2.0};
      if (normal_sign(t, axis) != 0) row.push_back(t);
    }
    const auto before = [&](const TriangleCorners& x, const TriangleCorners& y) {
      return is_crossed_before(x, y, axis, p[next(axis)], p[next(next(axis))]);
    };
    std::sort(row.begin(), row.end(), before);
    for (std::size_t i = 0; i < row.size(); ++i) {
      ASSERT_FALSE(before(row[i], row[i]));
      for (std::size_t j = i + 1; j < row.size(); ++j) {
        ASSERT_TRUE(before(row[i], row[j])) << k;
        ASSERT_FALSE(before(row[j], row[i])) << k;
      }
    }
  }
}

}  // namespace
}  // namespace blum::detail
