// Proves that polygons are cut into triangles that cover exactly the inside of the polygon. Polygons may be non-convex,
// have holes joined by bridges, lie in any plane or have a million corners. Polygons without a proper cut quickly give
// a fan.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "io/mesh/mesh_builder.hpp"

namespace blum {
namespace {

struct Cut {
  std::vector<Triangle> triangles;
  bool proper;
};

Cut cut(const std::vector<Vec3d>& vertices, const std::vector<std::uint32_t>& corners) {
  Cut result{std::vector<Triangle>(corners.size() - 2), false};
  std::int64_t work_left = polygon_work;
  result.proper = cut_polygon(vertices, corners, result.triangles, work_left);
  return result;
}

Cut cut(const std::vector<Vec3d>& vertices) {
  std::vector<std::uint32_t> corners(vertices.size());
  std::iota(corners.begin(), corners.end(), 0U);
  return cut(vertices, corners);
}

double area_xy(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

/// True if a point is inside a polygon of the xy plane, by crossings.
bool is_inside(const std::vector<Vec3d>& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec3d& a = polygon[i];
    const Vec3d& b = polygon[j];
    if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

/// Checks a cut of a counter-clockwise polygon of the xy plane. No triangle is reversed. A random point inside the
/// polygon is in exactly one triangle, a point outside in none.
void expect_covers(const std::vector<Vec3d>& polygon, const Cut& result, const char* name) {
  EXPECT_TRUE(result.proper) << name;
  Box3 box;
  for (const Vec3d& v : polygon) box.extend(v);
  for (const Triangle& t : result.triangles) {
    EXPECT_GE(area_xy(polygon[t[0]], polygon[t[1]], polygon[t[2]]), -1e-12) << name;
  }
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 300; ++i) {
    const Vec3d p = {box.lower.x + unit(random) * box.size().x, box.lower.y + unit(random) * box.size().y, 0};
    const auto covering = std::count_if(result.triangles.begin(), result.triangles.end(), [&](const Triangle& t) {
      return area_xy(polygon[t[0]], polygon[t[1]], p) > 0 && area_xy(polygon[t[1]], polygon[t[2]], p) > 0 &&
             area_xy(polygon[t[2]], polygon[t[0]], p) > 0;
    });
    ASSERT_EQ(covering, is_inside(polygon, p.x, p.y) ? 1 : 0) << name << " at " << p.x << ", " << p.y;
  }
}

std::vector<Vec3d> star(std::size_t count, double inner) {
  std::vector<Vec3d> polygon;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double radius = i % 2 == 0 ? 1 : inner;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return polygon;
}

/// A simple polygon, star-shaped around the origin, with random radii and long spikes.
std::vector<Vec3d> spikes(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> radius(0.02, 1);
  std::vector<Vec3d> polygon;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double r = radius(random);
    polygon.push_back({r * std::cos(angle), r * std::sin(angle), 0});
  }
  return polygon;
}

std::vector<Vec3d> comb(int teeth) {
  std::vector<Vec3d> polygon = {{0, -1, 0}, {2.0 * teeth, -1, 0}};
  for (int i = teeth; i-- > 0;) {
    polygon.insert(polygon.end(), {{2.0 * i + 2, 9, 0}, {2.0 * i + 1.5, 9, 0}, {2.0 * i + 1.2, 0, 0}, {2.0 * i, 0, 0}});
  }
  return polygon;
}

/// A strip that winds `turns` times around the origin.
std::vector<Vec3d> spiral(int turns) {
  std::vector<Vec3d> polygon;
  const int steps = 24 * turns;
  const auto at = [](int step, double width) {
    const double angle = 2 * std::numbers::pi * step / 24.0;
    const double radius = 1 + step / 24.0 + width;
    return Vec3d{radius * std::cos(angle), radius * std::sin(angle), 0};
  };
  for (int i = 0; i <= steps; ++i) polygon.push_back(at(i, 0.6));
  for (int i = steps; i >= 0; --i) polygon.push_back(at(i, 0.1));
  return polygon;
}

/// A square with a square hole, joined by a bridge that is walked twice.
const std::vector<Vec3d> keyhole = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                                    {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};

TEST(MeshPolygon, ConvexOnesAreFans) {
  const Cut result = cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_EQ(result.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(result.proper);
}

TEST(MeshPolygon, EveryStartOfAnArrowHead) {
  const std::vector<Vec3d> arrow = {{0, 0, 0}, {2, -1, 0}, {0.5, 0, 0}, {2, 1, 0}};
  for (std::uint32_t start = 0; start < 4; ++start) {
    std::vector<Vec3d> turned;
    for (std::uint32_t i = 0; i < 4; ++i) turned.push_back(arrow[(start + i) % 4]);
    // The notch at 2 is a reflex corner when walked in this order.
    expect_covers(turned, cut(turned), "arrow");
  }
}

TEST(MeshPolygon, ShapesThatAFanGetsWrong) {
  expect_covers(star(10, 0.3), cut(star(10, 0.3)), "star");
  expect_covers(comb(12), cut(comb(12)), "comb");
  expect_covers(spiral(4), cut(spiral(4)), "spiral");
  expect_covers(keyhole, cut(keyhole), "keyhole");
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const std::vector<Vec3d> polygon = spikes(5 + seed, seed);
    expect_covers(polygon, cut(polygon), "spikes");
  }
}

double signed_area(const std::vector<Vec3d>& polygon) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) area += area_xy(polygon[0], polygon[i], polygon[i + 1]);
  return area;
}

/// Checks a polygon that touches itself. Areas of whole numbers add up exactly.
void expect_exact_area(const std::vector<Vec3d>& polygon, const char* name) {
  const Cut result = cut(polygon);
  EXPECT_TRUE(result.proper) << name;
  double area = 0;
  for (const Triangle& t : result.triangles) {
    const double part = area_xy(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    EXPECT_GE(part, 0) << name;
    area += part;
  }
  EXPECT_EQ(area, signed_area(polygon)) << name;
}

TEST(MeshPolygon, PartsThatMeetInACornerOrByABridge) {
  expect_exact_area({{1, 2, 0}, {1, 0, 0}, {2, 1, 0}, {3, 1, 0}, {2, 1, 0}}, "a spike outside");
  expect_exact_area({{3, 3, 0}, {4, 2, 0}, {3, 3, 0}, {1, 3, 0}, {3, 1, 0}}, "a spike at a corner");
  expect_exact_area({{3, 0, 0}, {3, 1, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {4, 1, 0}}, "triangles that meet");
  const std::vector<Vec3d> left = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const std::vector<Vec3d> right = {{5, 3, 0}, {7, 3, 0}, {7, 5, 0}, {5, 5, 0}};
  for (std::size_t start = 0; start < 4; ++start) {
    std::vector<Vec3d> dumbbell(left);  // around the right square from its nearest corner, and back
    dumbbell.insert(dumbbell.begin() + 3, {right[0], right[1], right[2], right[3], right[0], left[2]});
    std::rotate(dumbbell.begin(), dumbbell.begin() + static_cast<std::ptrdiff_t>(start), dumbbell.end());
    expect_exact_area(dumbbell, "squares joined by a bridge");
  }
}

TEST(MeshPolygon, CornersOnEdgesInAnyPlane) {
  const Vec3d u = {1, 7, 3};
  const Vec3d w = {-9, 2, 4};
  const auto at = [&](int x, int y) { return Vec3d{1, 2, 3} + u * x + w * y; };
  for (int tip = 1; tip < 9; ++tip) {  // the tip of a notch, on the edge below
    std::vector<Vec3d> polygon = {at(0, 0), at(9, 0), at(9, 3), at(tip, 0), at(0, 3)};
    for (std::size_t start = 0; start < polygon.size(); ++start) {
      EXPECT_TRUE(cut(polygon).proper) << tip << ", from corner " << start;
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    }
  }
}

TEST(MeshPolygon, CollinearCornersGiveNoAvoidableEmptyTriangle) {
  const std::vector<Vec3d> square = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                     {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  const Cut result = cut(square);
  expect_covers(square, result, "square");
  for (const Triangle& t : result.triangles) EXPECT_GT(area_xy(square[t[0]], square[t[1]], square[t[2]]), 0);
}

TEST(MeshPolygon, RepeatedCornersAndSpikesOfNoWidth) {
  const std::vector<Vec3d> polygon = {{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 5, 0}, {2, 2, 0}, {0, 2, 0}};
  expect_covers(polygon, cut(polygon), "spike");
}

TEST(MeshPolygon, AnyPlaneAnyDirectionAnyScale) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::vector<Vec3d> flat = star(14, 0.4);
  for (int round = 0; round < 200; ++round) {
    Vec3d u = {unit(random), unit(random), unit(random)};
    u = u / length(u);
    Vec3d n = cross(u, Vec3d{unit(random), unit(random), unit(random)});
    n = n / length(n);
    const Vec3d w = cross(n, u);
    const double scale = std::pow(10.0, 140 * unit(random));
    std::vector<Vec3d> tilted;
    for (const Vec3d& v : flat) tilted.push_back((u * v.x + w * v.y) * scale + Vec3d{1, 2, 3} * (scale * 100));
    const Cut result = cut(tilted);
    expect_covers(flat, result, "tilted");
    std::reverse(tilted.begin(), tilted.end());
    for (const Triangle& t : cut(tilted).triangles) {
      const auto at = [&](std::uint32_t i) { return flat[flat.size() - 1 - i]; };
      EXPECT_LE(area_xy(at(t[0]), at(t[1]), at(t[2])), 1e-9);
    }
  }
}

TEST(MeshPolygon, PolygonsWithoutAProperCutAreFans) {
  const std::vector<Vec3d> line = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  const std::vector<Vec3d> point(5, Vec3d{1, 1, 1});
  const std::vector<Vec3d> bow_tie = {{0, 0, 0}, {3, 2, 0}, {3, 0, 0}, {0, 1, 0}};
  const std::vector<Vec3d> extreme = {
      {1.7e308, -1.7e308, 0}, {-1.7e308, 1.7e308, 0}, {0, 0, 1.7e308}, {0, 0, -1.7e308}};
  EXPECT_FALSE(cut(line).proper);
  EXPECT_EQ(cut(line).triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_FALSE(cut(point).proper);
  EXPECT_EQ(cut(point).triangles.size(), 3U);
  EXPECT_FALSE(cut(bow_tie).proper);
  EXPECT_EQ(cut(extreme).triangles.size(), 2U);
}

TEST(MeshPolygonSlow, AMillionCornersTakeNoMoreThanSeconds) {
  constexpr std::size_t count = 1000000;
  const auto seconds = [](const std::vector<Vec3d>& polygon, bool proper) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(cut(polygon).proper, proper);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  EXPECT_LT(seconds(star(count, 0.99), true), 20.0);
  EXPECT_LT(seconds(comb(count / 4), true), 20.0);
  std::vector<Vec3d> noise;  // crosses itself everywhere: the cut stops after the allowed work
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::size_t i = 0; i < count / 10; ++i) noise.push_back({unit(random), unit(random), 0});
  EXPECT_LT(seconds(noise, false), 20.0);
}

}  // namespace
}  // namespace blum
