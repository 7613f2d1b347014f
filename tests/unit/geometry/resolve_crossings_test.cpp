// Proves exact whole numbers of any size with the rounding of doubles, exact comparison and orientation of points, and
// triangulations of all points and segments. Resolved meshes are closed manifolds without crossings. They wind once
// where their input winds once or more. Unresolved meshes report the reason.
#include "blum/geometry/resolve_crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/shapes/generators.hpp"
#include "exact/exact_integer.hpp"
#include "geometry/crossings/exact_space.hpp"
#include "geometry/crossings/planar_mesh.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using detail::ExactInteger;
using detail::ExactSpace;
using test::box_between;

__extension__ using Wide = __int128;

/// A number of up to `bits` bits, of either sign.
std::int64_t number_of(Random& random, int bits) {
  const auto magnitude = static_cast<std::int64_t>(random.bits() >> static_cast<unsigned>(64 - bits));
  return random.uniform() < 0.5 ? magnitude : -magnitude;
}

ExactInteger exact(Wide value) {
  const bool is_negative = value < 0;
  const Wide magnitude = is_negative ? -value : value;
  const ExactInteger high = static_cast<std::int64_t>(magnitude >> 62);
  const ExactInteger low = static_cast<std::int64_t>(magnitude & ((Wide{1} << 62) - 1));
  const ExactInteger sum = (high << 62) + low;
  return is_negative ? -sum : sum;
}

TEST(ExactInteger, ComputesAsWideIntegersDo) {
  Random random(1);
  for (int k = 0; k < 20000; ++k) {
    const std::int64_t a = number_of(random, 1 + static_cast<int>(random.below(62)));
    const std::int64_t b = number_of(random, 1 + static_cast<int>(random.below(62)));
    ASSERT_TRUE(exact(a) * exact(b) == exact(Wide{a} * b)) << a << " " << b;
    ASSERT_TRUE(exact(a) + exact(b) == exact(Wide{a} + b)) << a << " " << b;
    ASSERT_TRUE(exact(a) - exact(b) == exact(Wide{a} - b)) << a << " " << b;
    ASSERT_EQ(exact(a).sign(), (a > 0) - (a < 0));
    const auto shift = random.below(60);
    ASSERT_TRUE((exact(a) << shift) == exact(Wide{a} * (Wide{1} << shift)));
    ASSERT_TRUE(((exact(a) << shift) >> shift) == exact(a));
  }
}

TEST(ExactInteger, LargeProductsAreAssociative) {
  Random random(2);
  for (int k = 0; k < 200; ++k) {
    std::array<ExactInteger, 3> x{1, 1, 1};
    for (ExactInteger& one : x) {
      for (std::uint64_t n = random.below(20); n > 0; --n) one = one * exact(number_of(random, 62)) + exact(k);
    }
    ASSERT_TRUE((x[0] * x[1]) * x[2] == x[0] * (x[1] * x[2]));
    ASSERT_TRUE((x[0] + x[1]) * x[2] == x[0] * x[2] + x[1] * x[2]);
    ASSERT_EQ((x[0] - x[0]).sign(), 0);
  }
}

TEST(ExactInteger, QuotientsRoundAsDivisionDoes) {
  Random random(3);
  for (int k = 0; k < 20000; ++k) {
    const std::int64_t a = number_of(random, 1 + static_cast<int>(random.below(53)));
    const std::int64_t b = 1 + std::abs(number_of(random, 1 + static_cast<int>(random.below(52))));
    const double expected = static_cast<double>(a) / static_cast<double>(b);
    ASSERT_EQ(ExactInteger::rounded_ratio(exact(a), exact(b), 0), expected) << a << " / " << b;
    const ExactInteger factor = exact(number_of(random, 60)) * exact(number_of(random, 60)) + exact(1);
    if (factor.sign() <= 0) continue;
    ASSERT_EQ(ExactInteger::rounded_ratio(exact(a) * factor, exact(b) * factor, -3), expected / 8);
  }
}

/// Compares intersections of planes of small whole numbers with fractions.
TEST(ExactSpace, EqualPointsAreOne) {
  const std::vector<Vec3d> vertices{{0, 0, 0}, {1, 0, 0},        {0, 1, 0},       {0, 0, 1},
                                    {1, 1, 1}, {0.25, 0.25, -1}, {0.25, 0.25, 1}, {0.5, 0, 0}};
  const std::vector<detail::PointId> all{0, 1, 2, 3, 4, 5, 6, 7};
  ExactSpace space(vertices, all);
  const detail::Cut floor{{0, 1, 2}, -1};
  const detail::PointId p = space.meet(5, 6, floor);
  EXPECT_EQ(space.rounded(p), (Vec3d{0.25, 0.25, 0}));
  EXPECT_EQ(space.meet(6, 5, floor), p);
  EXPECT_EQ(space.side(floor, p), 0);
  EXPECT_EQ(space.side(floor, 3), 1);
  // The point lies on the diagonal, in the planes x = y and x + y = 1/2.
  const detail::Cut diagonal{{0, 4, 3}, -1};
  const detail::Cut across{{5, 6, 7}, -1};
  EXPECT_EQ(space.meet(floor, diagonal, across), p);
  EXPECT_EQ(space.turn(2, 0, 1, p), 1);
  EXPECT_EQ(space.turn(2, 0, p, 4), 0);
  EXPECT_EQ(space.compare(0, p), -1);
  EXPECT_EQ(space.meet(1, 4, detail::Cut{{0, 1, 2}, -1}), 1U) << "a vertex that lies in the plane is met in itself";
}

/// Thirds are not doubles. Only exact arithmetic shows that the point lies on the plane.
TEST(ExactSpace, PredicatesOfRoundedPointsAreExact) {
  Random random(5);
  int zeros = 0;
  for (int k = 0; k < 500; ++k) {
    std::vector<Vec3d> vertices;
    for (int n = 0; n < 8; ++n) {
      vertices.push_back({static_cast<double>(random.below(7)) / 8, static_cast<double>(random.below(7)) / 8,
                          static_cast<double>(random.below(7)) / 8});
    }
    const std::vector<detail::PointId> all{0, 1, 2, 3, 4, 5, 6, 7};
    std::set<std::array<double, 3>> places;
    for (const Vec3d& v : vertices) places.insert({v.x, v.y, v.z});
    if (places.size() < vertices.size()) continue;
    ExactSpace space(vertices, all);
    const detail::Cut cut{{0, 1, 2}, -1};
    if (space.side(cut, 3) * space.side(cut, 4) >= 0) continue;
    const detail::PointId p = space.meet(3, 4, cut);
    ASSERT_EQ(space.side(cut, p), 0);
    ASSERT_EQ(space.turn(0, 3, p, 4), 0);
    ASSERT_EQ(space.turn(1, 3, 4, p), 0);
    for (const detail::PointId q : {5U, 6U, 7U}) {
      const detail::Cut other{{3, 4, q}, -1};
      ASSERT_EQ(space.side(other, p), 0) << "it lies on the edge";
      ++zeros;
    }
  }
  EXPECT_GT(zeros, 100);
}

TEST(PlanarMesh, HoldsItsPointsAndSegments) {
  Random random(9);
  for (int trial = 0; trial < 60; ++trial) {
    std::set<std::array<double, 2>> places;
    const auto step = static_cast<double>(4 + random.below(30));
    for (int n = 0; n < 60; ++n) {
      places.insert({std::floor(random.uniform(-1, 1) * step) / 32, std::floor(random.uniform(-1, 1) * step) / 32});
    }
    std::vector<Vec3d> vertices;
    std::vector<detail::PointId> all;
    for (const auto& [x, y] : places) {
      all.push_back(static_cast<detail::PointId>(vertices.size()));
      vertices.push_back({x, y, 0});
    }
    ExactSpace space(vertices, all);
    detail::PlanarMesh mesh(space, 2, space.corners_around(2));
    for (const detail::PointId p : all) ASSERT_TRUE(mesh.insert(p));
    // Segments between consecutive points do not cross each other and contain no other point.
    std::set<std::array<detail::PointId, 2>> segments;
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
      ASSERT_TRUE(mesh.insert_segment(all[k], all[k + 1])) << trial << ": " << k;
      segments.insert({all[k], all[k + 1]});
    }
    mesh.improve();
    std::set<detail::PointId> seen;
    for (const auto& t : mesh.triangles()) {
      ASSERT_EQ(space.turn(2, t[0], t[1], t[2]), 1);
      for (std::size_t k = 0; k < 3; ++k) {
        seen.insert(t[k]);
        segments.erase({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
      }
    }
    // Segments at the border of the points have outer points on one side.
    ASSERT_LE(segments.size(), all.size() / 2);
    ASSERT_GT(seen.size(), all.size() / 2);
  }
}

/// Checks the promises of the header for a resolved mesh.
void expect_sound(const MeshView& input, const ResolvedMesh& resolved) {
  ASSERT_TRUE(resolved.is_resolved()) << resolved.obstacle;
  const Topology facts = topology(resolved.mesh);
  EXPECT_TRUE(facts.closed && facts.oriented && facts.manifold && facts.faces_outwards);
  EXPECT_EQ(find_self_intersections(resolved.mesh).crossing, 0U);
  ASSERT_EQ(resolved.vertex_of.size(), resolved.mesh.vertices.size());
  ASSERT_EQ(resolved.triangle_of.size(), resolved.mesh.triangles.size());
  const WindingNumber before(input);
  const WindingNumber after(resolved.mesh);
  const Box3 box = bounds(input);
  Random random(4);
  for (int k = 0; k < 300; ++k) {
    const Vec3d at = random.in_cube();
    const Vec3d p = box.lower + Vec3d{at.x * box.size().x, at.y * box.size().y, at.z * box.size().z};
    ASSERT_EQ(std::round(after(p)), std::round(before(p)) >= 1 ? 1 : 0);
  }
}

/// Octahedra with corners at small whole numbers: many parts lie in one plane or on one line, or fold over.
TEST(ResolveCrossings, DegenerateOctahedra) {
  Random random(7);
  const std::array<Triangle, 8> faces{
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  int resolved_ones = 0;
  for (int trial = 0; trial < 150; ++trial) {
    TriangleMesh mesh;
    for (std::uint32_t part = 0; part < 3; ++part) {
      for (std::size_t v = 0; v < 6; ++v) {
        Vec3d p{};
        p[v / 2] = v % 2 == 0 ? 2 : -2;
        for (std::size_t a = 0; a < 3; ++a) p[a] += static_cast<double>(random.below(5)) - 2;
        mesh.vertices.push_back(p);
      }
      for (const Triangle& t : faces) mesh.triangles.push_back({t[0] + 6 * part, t[1] + 6 * part, t[2] + 6 * part});
    }
    const ResolvedMesh resolved = resolve_crossings(mesh);
    if (resolved.obstacle.find("faces inwards") != std::string::npos) continue;
    expect_sound(mesh, resolved);
    ++resolved_ones;
  }
  EXPECT_GT(resolved_ones, 140);
}

TEST(ResolveCrossings, NoisyMeshes) {
  for (const double amplitude : {0.05, 0.1, 0.3}) {
    const TriangleMesh mesh = make_noisy(make_torus({.ring_segments = 30, .tube_segments = 16}), amplitude, 3);
    expect_sound(mesh, resolve_crossings(mesh));
  }
}

/// Three boxes along a line, each partly in the next one. Tests the parts in two boxes, and in all three.
TEST(ResolveCrossings, LeastWindingsOfTwoAndMoreGiveCommonParts) {
  TriangleMesh mesh;
  const auto add = [&](const TriangleMesh& box) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), box.vertices.begin(), box.vertices.end());
    for (const auto& [a, b, c] : box.triangles) mesh.triangles.push_back({base + a, base + b, base + c});
  };
  add(box_between({0, 0, 0}, {2, 2, 2}));
  add(box_between({1, 0.25, 0.25}, {4, 1.5, 1.75}));
  add(box_between({1.5, 0.5, 0.5}, {5, 1, 3}));
  const auto volume = [&](int least_winding) {
    ResolveOptions options;
    options.least_winding = least_winding;
    const ResolvedMesh found = resolve_crossings(mesh, options);
    EXPECT_EQ(found.obstacle, "");
    EXPECT_TRUE(found.has_inside);
    EXPECT_EQ(found.body_of, std::vector<std::uint32_t>(found.mesh.triangles.size(), 0));
    return topology(found.mesh).signed_volume;
  };
  const double first_second = 1 * 1.25 * 1.5;
  const double second_third = 2.5 * 0.5 * 1.25;
  const double first_third = 0.5 * 0.5 * 1.5;
  const double all = 0.5 * 0.5 * 1.25;
  EXPECT_NEAR(volume(3), all, 1e-12);
  EXPECT_NEAR(volume(2), first_second + second_third + first_third - 2 * all, 1e-12);
  ResolveOptions options;
  options.least_winding = 4;
  const ResolvedMesh none = resolve_crossings(mesh, options);
  EXPECT_FALSE(none.has_inside);
  EXPECT_FALSE(none.is_resolved());
}

/// Sides 1e-16 from each other cross. Rays cannot order these sides, but exact sides of planes can.
TEST(ResolveCrossings, SidesThatLieNextToEachOther) {
  const TriangleMesh cylinder = make_cylinder();
  const double volume = topology(cylinder).signed_volume;
  for (const int steps : {1, 2, 4, 6, 8, 22}) {
    const double angle = steps * 2 * std::acos(-1.0) / 48;
    TriangleMesh mesh = cylinder;
    for (Vec3d& p : mesh.vertices) {
      p = {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
    }
    append(mesh, cylinder, {});
    for (const int least_winding : {1, 2}) {
      const ResolvedMesh found = resolve_crossings(mesh, {.most_rounds = 0, .least_winding = least_winding});
      EXPECT_EQ(found.obstacle, "") << steps;
      EXPECT_NEAR(topology(found.mesh).signed_volume, volume, 1e-12) << steps;
    }
  }
}

TEST(ResolveCrossings, RejectsExcessiveAndInvalidInput) {
  TriangleMesh mesh = make_sphere({.frequency = 6});
  append(mesh, make_sphere({.frequency = 6}), {0.5, 0.1, 0.05});
  EXPECT_EQ(resolve_crossings(mesh, {.most_pairs = 5}).obstacle, "more than 5 pairs of triangles cross or touch");
  EXPECT_TRUE(resolve_crossings(mesh).is_resolved());
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)resolve_crossings(mesh, {}, {.cancel = source.get_token()}), Cancelled);
  mesh.triangles.pop_back();
  EXPECT_EQ(resolve_crossings(mesh).obstacle, "triangles do not meet in opposite directions at 3 edges");
  EXPECT_THROW((void)resolve_crossings(TriangleMesh{}), InvalidMesh);
}

TEST(ResolveCrossings, TheSameForAnyNumberOfThreadsAndAnySize) {
  TriangleMesh mesh = make_sphere({.frequency = 6});
  append(mesh, box_between({0.1, -0.3, -0.2}, {1.7, 0.4, 0.3}));
  const ResolvedMesh one = resolve_crossings(mesh, {}, {.threads = 1});
  const ResolvedMesh three = resolve_crossings(mesh, {}, {.threads = 3});
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
  for (const double factor : {0x1p-200, 0x1p180}) {
    TriangleMesh scaled = mesh;
    for (Vec3d& v : scaled.vertices) v *= factor;
    const ResolvedMesh other = resolve_crossings(scaled);
    ASSERT_TRUE(other.is_resolved()) << other.obstacle;
    EXPECT_EQ(one.mesh.triangles, other.mesh.triangles);
    EXPECT_EQ(one.mesh.vertices[0] * factor, other.mesh.vertices[0]);
  }
}

}  // namespace
}  // namespace blum
