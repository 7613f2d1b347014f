// Proves that hierarchical winding numbers keep their error bounds and decide like the full sum over all triangles.
#include "blum/geometry/winding_number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "blum/field/reference.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// A sphere without the part above z = height.
TriangleMesh bowl(double height) {
  TriangleMesh mesh = make_sphere({.frequency = 10});
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices[t[0]].z > height && mesh.vertices[t[1]].z > height && mesh.vertices[t[2]].z > height;
  });
  return mesh;
}

void expect_like_brute_force(const TriangleMesh& mesh, std::uint64_t seed, std::size_t count = 300) {
  const WindingNumber winding(mesh);
  for (const Vec3d& q : test::places_around(mesh, count, seed)) {
    // The sum jumps at vertices: any value is as good as another.
    if (std::find(mesh.vertices.begin(), mesh.vertices.end(), q) != mesh.vertices.end()) continue;
    const double truth = reference::winding_number(mesh, q);
    EXPECT_NEAR(winding(q), truth, 1e-11);
    for (const double allowed : {0.1, 1e-3, 1e-6, 1e-10}) {
      const WindingNumber::Estimate w = winding.estimate(q, allowed);
      EXPECT_LE(std::abs(w.value - truth), w.error + 1e-11);
      EXPECT_LE(w.error, std::max(allowed, 2e-11));
    }
    if (std::abs(truth - 0.5) > 1e-9) {
      EXPECT_EQ(winding.is_inside(q), truth > 0.5);
      const std::optional<bool> side = winding.side(q, 0.01);
      if (side) {
        EXPECT_EQ(*side, truth > 0.5);
      }
      EXPECT_EQ(side.has_value(), std::abs(truth - 0.5) > 0.01) << truth;
    }
  }
}

TEST(WindingNumber, KeepsItsBoundsOnSoups) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    expect_like_brute_force(make_soup({.triangles = 40 * seed, .triangle_size = 0.5, .awkward = 0.6, .seed = seed}),
                            seed);
  }
}

TEST(WindingNumber, KeepsItsBoundsOnSurfaces) {
  expect_like_brute_force(make_sphere({.frequency = 12}), 1);
  expect_like_brute_force(make_star({}), 2);
  expect_like_brute_force(bowl(0.0), 3);
  expect_like_brute_force(bowl(0.7), 4);
  expect_like_brute_force(make_organic({.frequency = 16, .holes = 3}), 5);
  expect_like_brute_force(test::moved(bowl(0.3), 1e-9), 6);
  expect_like_brute_force(test::moved(bowl(0.3), 1e9), 7);
  expect_like_brute_force(test::moved(bowl(0.3), 1, {1e6, -1e6, 1e6}), 8);
}

TEST(WindingNumber, IsAccurateWithoutBoundsToo) {
  const TriangleMesh mesh = make_organic({.frequency = 20, .holes = 2});
  const WindingNumber winding(mesh);
  double worst = 0;
  double worst_at_4 = 0;
  for (const Vec3d& q : test::places_around(mesh, 200, 9)) {
    if (std::find(mesh.vertices.begin(), mesh.vertices.end(), q) != mesh.vertices.end()) continue;
    worst = std::max(worst, std::abs(winding.approximate(q) - winding(q)));
    worst_at_4 = std::max(worst_at_4, std::abs(winding.approximate(q, 4) - winding(q)));
  }
  EXPECT_LT(worst, 1e-2);
  EXPECT_LT(worst_at_4, 1e-3);
  EXPECT_GT(worst, worst_at_4);
}

TEST(WindingNumber, DecidesWithAMargin) {
  const TriangleMesh mesh = test::awkward_soup(300, 3);
  const WindingNumber winding(mesh);
  EXPECT_EQ(winding.triangle_count(), mesh.triangles.size());
  for (const Vec3d& query : test::places_around(mesh, 300, 9)) {
    const WindingNumber::Decision found = winding.decide(query, HUGE_VAL);
    const double w = reference::winding_number(mesh, query);
    EXPECT_EQ(found.is_inside, winding.is_inside(query));
    if (std::abs(winding(query) - w) > 1e-9) continue;  // w jumps on the surface
    EXPECT_GE(found.margin, 0);
    EXPECT_LE(found.margin, std::abs(w - 0.5) + 1e-9);
  }
}

/// Next to a flat sheet, w is 1/2 minus the share of the sheet's border, which is about as large as rounding.
TEST(WindingNumber, HasNoMarginWhereRoundingDecides) {
  const WindingNumber sheet(test::flat_sheet(18));
  for (int k = 1; k < 400; ++k) {
    const double at = (k % 40 + 0.5) / 40;
    for (const double height : {1e-13, 1e-11, 1e-9, -1e-9, -1e-11, -1e-13}) {
      const WindingNumber::Decision found = sheet.decide({at, at, height * k / 400}, std::abs(height) * k / 400);
      if (found.margin > 0) {
        EXPECT_FALSE(found.is_inside) << height;
      }
    }
  }
}

TEST(WindingNumber, IsZeroWithoutTrianglesAndFarAway) {
  const TriangleMesh points = make_points({.points = 10});
  EXPECT_EQ(WindingNumber(points)({0, 0, 0}), 0);
  EXPECT_FALSE(WindingNumber(points).is_inside({0, 0, 0}));
  const WindingNumber sphere(make_sphere({.frequency = 3}));
  EXPECT_FALSE(sphere.is_inside({1e200, 1e200, 1e200}));
  EXPECT_NEAR(sphere({1e20, 0, 0}), 0, 1e-12);
}

TEST(WindingNumber, KnowsWhichSurfacesHaveNoBoundary) {
  EXPECT_TRUE(WindingNumber(make_sphere({.frequency = 3})).is_piecewise_constant());
  EXPECT_TRUE(WindingNumber(test::unwelded(make_sphere({.frequency = 3}))).is_piecewise_constant());
  EXPECT_TRUE(WindingNumber(make_void_cube({})).is_piecewise_constant());
  EXPECT_FALSE(WindingNumber(bowl(0.5)).is_piecewise_constant());
  TriangleMesh turned = make_sphere({.frequency = 3});
  std::swap(turned.triangles[7][0], turned.triangles[7][1]);
  EXPECT_FALSE(WindingNumber(turned).is_piecewise_constant());
}

/// The bound holds for differences of w between points of boxes without triangles.
TEST(WindingNumber, BoundsItsGradient) {
  for (const TriangleMesh& mesh : {bowl(0.2), make_soup({.triangles = 20, .seed = 4}), test::unwelded(bowl(0.6))}) {
    const WindingNumber winding(mesh);
    const reference::BruteForce distances(mesh);
    Random random(3);
    std::size_t tested = 0;
    double tightest = HUGE_VAL;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d center = bounds(mesh).center() + random.in_ball() * 2.0;
      const double half = 0.05 * random.uniform();
      if (distances.nearest(center).distance < 2 * half) continue;
      const Vec3d corner{half, half, half};
      const double bound = winding.gradient_bound({center - corner, center + corner});
      const double enough = bound * random.uniform(0.1, 2.0);
      const double rough = winding.gradient_bound({center - corner, center + corner}, enough);
      EXPECT_TRUE(bound > enough ? rough > enough && rough <= bound * (1 + 1e-12) : rough == bound);
      const Vec3d a = center + (random.in_cube() * 2.0 - Vec3d{1, 1, 1}) * half;
      const Vec3d b = center + (random.in_cube() * 2.0 - Vec3d{1, 1, 1}) * half;
      const double change = std::abs(winding(a) - winding(b));
      EXPECT_LE(change, bound * length(a - b) + 1e-11);
      if (change > 1e-9) tightest = std::min(tightest, bound * length(a - b) / change);
      ++tested;
    }
    EXPECT_GT(tested, 100U);
    EXPECT_LT(tightest, 20) << "the bound is useless";
  }
  EXPECT_EQ(WindingNumber(make_sphere({.frequency = 4})).gradient_bound({{-1, -1, -1}, {1, 1, 1}}), 0);
}

TEST(WindingNumber, GivesTheSideOfBoxesOnlyIfItIsUniform) {
  for (const TriangleMesh& mesh :
       {bowl(0.0), bowl(0.8), make_soup({.triangles = 60, .triangle_size = 0.8, .seed = 2})}) {
    const WindingNumber winding(mesh);
    Random random(5);
    std::size_t decided = 0;
    for (int i = 0; i < 400; ++i) {
      const Vec3d center = random.in_ball() * 1.5;
      const double half = 0.3 * random.uniform();
      const Box3 box{center - Vec3d{half, half, half}, center + Vec3d{half, half, half}};
      const std::optional<bool> side = winding.uniform_side(box);
      if (!side) continue;
      ++decided;
      for (int k = 0; k < 20; ++k) {
        const Vec3d q = center + (random.in_cube() * 2.0 - Vec3d{1, 1, 1}) * half;
        EXPECT_EQ(reference::winding_number(mesh, q) > 0.5, *side);
      }
    }
    EXPECT_GT(decided, 10U);
  }
  // w passes 1/2 across the mouth of half a sphere: a box there has no side.
  EXPECT_FALSE(WindingNumber(bowl(0.0)).uniform_side({{-0.3, -0.3, -0.3}, {0.3, 0.3, 0.6}}));
}

/// A unit box with a triangle without area at one edge of its lid. The middle vertex of this triangle lies on the edge
/// of the wall.
TriangleMesh box_with_filler(bool is_open) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.push_back({static_cast<double>(k & 1), static_cast<double>(k >> 1 & 1), static_cast<double>(k >> 2)});
  }
  mesh.vertices.push_back({0.5, 0, 1});
  mesh.triangles = {{0, 1, 8}, {0, 8, 4}, {1, 5, 8}, {4, 8, 5}, {4, 5, 6}, {5, 7, 6}, {2, 6, 3},
                    {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}, {0, 2, 1}, {1, 2, 3}};
  if (is_open) mesh.triangles.resize(12);
  return mesh;
}

/// Near a triangle with no area, or as little as rounding leaves, the solid angle is a quotient of rounding errors.
/// Without more digits, the error can be a whole turn.
TEST(WindingNumber, OfTrianglesWithoutAreaIsZero) {
  for (const bool is_turned : {false, true}) {
    TriangleMesh closed = box_with_filler(false);
    TriangleMesh open = box_with_filler(true);
    if (is_turned) {
      closed = test::turned(closed);
      open = test::turned(open);
    }
    TriangleMesh bare = open;
    bare.triangles.erase(bare.triangles.begin() + 3);
    const WindingNumber of_closed(closed);
    const WindingNumber of_open(open);
    const WindingNumber of_bare(bare);
    Random random(7);
    for (const double off : {1e-3, 1e-6, 1e-8, 3e-9, 1e-9, 1e-10, 1e-11}) {
      for (int k = 0; k < 300; ++k) {
        const double along = 0.1 + 0.8 * random.uniform();
        const double angle = 2 * std::numbers::pi * random.uniform();
        const Vec3d offset{0, off * std::cos(angle), off * std::sin(angle)};
        // Rounding of the turned box decides for places nearer to a plane.
        if (std::min(std::abs(offset.y), std::abs(offset.z)) < 4e-16) continue;
        const Vec3d place = Vec3d{along, 0, 1} + offset;
        const Vec3d query = is_turned ? test::turned(place) : place;
        const bool is_inside = offset.y > 0 && offset.z < 0;
        const double sliver = is_turned ? 1e-16 / off : 0;  // the share of the view that the turned triangle may take
        EXPECT_EQ(of_closed.value(query, 1e-6).value, is_inside ? 1 : 0) << off;
        const double expected = of_bare(query);
        EXPECT_NEAR(of_open(query), expected, sliver + 1e-11) << off;
        EXPECT_NEAR(expected, is_inside ? 0.95 : -0.05, 0.04) << off;
        EXPECT_EQ(of_open.decide(query, off).is_inside, is_inside) << off;
      }
    }
  }
}

/// Near a corner that a triangle names twice, and near the short side of a needle, all terms are small. The error of
/// the sine must be small as well.
TEST(WindingNumber, NeedlesCancelNextToTheirShortSides) {
  for (const double side : {0.0, 1e-13, 1e-10, 1e-8, 1e-6}) {
    TriangleMesh plain = box_with_filler(true);
    plain.triangles.erase(plain.triangles.begin() + 3);
    TriangleMesh mesh = plain;
    // Two needles in the plane of the lid have the same corners in opposite order.
    mesh.vertices.push_back({1, side, 1});
    const auto tip = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    mesh.triangles.push_back({4, 5, side > 0 ? tip : 5});
    mesh.triangles.push_back({5, 4, side > 0 ? tip : 5});
    mesh = test::turned(mesh);
    plain = test::turned(plain);
    const WindingNumber with(mesh);
    const WindingNumber without(plain);
    Random random(9);
    for (const double off : {1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
      for (int k = 0; k < 200; ++k) {
        const Vec3d place = Vec3d{1, 0, 1} + random.in_ball() * off;
        const Vec3d query = test::turned(place);
        EXPECT_NEAR(with(query), without(query), 1e-9 + 1e-15 / off) << side << " " << off;
      }
    }
  }
}

}  // namespace
}  // namespace blum
