// Proves that crossing and touching triangles agree with an independent reference, and that the search agrees with a
// test of all pairs. Meshes known to be free of crossings have none.
#include "blum/geometry/self_intersections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/oriented_bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using detail::Contact;
using detail::ContactTriangle;
using Corners = std::array<Vec3d, 3>;

// ---- A reference in double, certain for corners of small whole numbers: unequal values differ by far more ----

constexpr double slack = 1e-9;

Vec3d normal(const Corners& t) {
  return cross(t[1] - t[0], t[2] - t[0]);
}

/// The part of a polygon that is not beyond the plane through `at` with this normal.
std::vector<Vec3d> cut(const std::vector<Vec3d>& polygon, const Vec3d& at, const Vec3d& outward) {
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d& p = polygon[i];
    const Vec3d& q = polygon[(i + 1) % polygon.size()];
    const double s = dot(p - at, outward);
    const double t = dot(q - at, outward);
    if (s <= slack) out.push_back(p);
    if ((s > slack && t < -slack) || (s < -slack && t > slack)) out.push_back(p + (q - p) * (s / (s - t)));
  }
  return out;
}

/// The corners of the common part of two triangles.
std::vector<Vec3d> common_part(const Corners& a, const Corners& b) {
  std::vector<Vec3d> part(a.begin(), a.end());
  const Vec3d n = normal(b);
  part = cut(cut(part, b[0], n), b[0], -n);
  for (std::size_t k = 0; k < 3; ++k) part = cut(part, b[k], cross(b[(k + 1) % 3] - b[k], n));
  return part;
}

double side(const Corners& t, const Vec3d& p, std::size_t k) {
  return dot(p - t[k], cross(normal(t), t[(k + 1) % 3] - t[k]));
}

bool is_inside(const Corners& t, const Vec3d& p) {
  return side(t, p, 0) > slack && side(t, p, 1) > slack && side(t, p, 2) > slack;
}

Contact reference(const Corners& a, const Corners& b) {
  const std::vector<Vec3d> part = common_part(a, b);
  if (part.empty()) return Contact::none;
  std::vector<Vec3d> shared;
  for (const Vec3d& p : a) {
    if (std::find(b.begin(), b.end(), p) != b.end()) shared.push_back(p);
  }
  // If the triangles share nothing else, the corners of the common part lie on the shared corner or edge.
  const auto is_shared = [&](const Vec3d& p) {
    if (shared.size() == 3 || shared.empty()) return false;
    const Vec3d along = shared.back() - shared.front();
    return length(p - shared.front()) < slack || length(cross(p - shared.front(), along)) < slack * length(along);
  };
  const bool beyond = std::any_of(part.begin(), part.end(), [&](const Vec3d& p) {
    return shared.size() == 1 ? length(p - shared[0]) > slack : !is_shared(p);
  });
  if (!beyond) return Contact::none;
  if (length(cross(normal(a), normal(b))) < slack) return Contact::touching;
  Vec3d middle{};
  for (const Vec3d& p : part) middle = middle + p / static_cast<double>(part.size());
  return is_inside(a, middle) && is_inside(b, middle) ? Contact::crossing : Contact::touching;
}

/// Corners at equal positions get equal numbers.
std::array<ContactTriangle, 2> contact_triangles(const Corners& a, const Corners& b) {
  std::array<ContactTriangle, 2> out{ContactTriangle{a, {0, 1, 2}}, ContactTriangle{b, {3, 4, 5}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (a[i] == b[j]) out[1].corners[j] = static_cast<std::uint32_t>(i);
    }
  }
  return out;
}

TEST(TriangleContact, AgreesWithTheReferenceOnSmallGrids) {
  // Corners lie on a grid of 2 to 4 points a side. Every degenerate position occurs, including shared corners and
  // edges.
  std::array<std::array<int, 3>, 4> seen{};  // by number of shared corners
  for (const std::uint64_t side_points : {2U, 3U, 4U}) {
    Random random(side_points);
    for (int run = 0; run < 150000; ++run) {
      const auto point = [&] {
        const auto whole = [&] { return static_cast<double>(random.below(side_points)); };
        const double x = whole();
        const double y = whole();
        return Vec3d{x, y, whole()};
      };
      const Corners a{point(), point(), point()};
      Corners b{point(), point(), point()};
      if (run % 3 == 1) b[random.below(3)] = a[random.below(3)];
      if (run % 3 == 2) b = {a[1], a[0], b[2]};
      if (detail::has_no_area(a) || detail::has_no_area(b)) continue;
      const auto [first, second] = contact_triangles(a, b);
      const Contact expected = reference(a, b);
      const auto text = [&] {
        std::string out;
        for (const Corners& t : {a, b}) {
          for (const Vec3d& p : t) {
            out += "(" + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + ") ";
          }
        }
        return out;
      };
      ASSERT_EQ(contact(first, second), expected) << text();
      ASSERT_EQ(contact(second, first), expected) << text();
      std::size_t shared = 0;
      for (const Vec3d& p : a) shared += std::find(b.begin(), b.end(), p) != b.end() ? 1U : 0U;
      ++seen[shared][static_cast<std::size_t>(expected)];
    }
  }
  for (std::size_t shared = 0; shared < 2; ++shared) {
    for (const int count : seen[shared]) EXPECT_GT(count, 1000) << shared;
  }
  EXPECT_GT(seen[2][0], 1000);
  EXPECT_GT(seen[2][1], 1000);
  EXPECT_EQ(seen[2][2], 0);
  EXPECT_GT(seen[3][1], 10);
}

// ---- The search ----

std::vector<std::pair<std::uint32_t, std::uint32_t>> every_pair(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  const auto corners = [&](std::uint32_t t) {
    const Triangle& v = mesh.triangles[t];
    return Corners{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
  };
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::uint32_t j = i + 1; j < mesh.triangles.size(); ++j) {
      if (detail::has_no_area(corners(i)) || detail::has_no_area(corners(j))) continue;
      const auto [a, b] = contact_triangles(corners(i), corners(j));
      if (contact(a, b) != Contact::none) out.emplace_back(i, j);
    }
  }
  return out;
}

TEST(SelfIntersections, AgreeWithAllPairs) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const TriangleMesh mesh = test::awkward_soup(seed * 60, seed);
    const SelfIntersections found = find_self_intersections(mesh);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const TrianglePair& pair : found.pairs) pairs.emplace_back(pair.first.value, pair.second.value);
    EXPECT_EQ(pairs, every_pair(mesh)) << seed;
    EXPECT_EQ(found.crossing + found.touching, found.pairs.size());
    EXPECT_GT(found.crossing, 0U);
    EXPECT_TRUE(found.complete);
  }
}

/// Triangles whose corners lie on a grid of a few points, or in a few of its planes if `heights` is small. Most of them
/// share corners, edges or planes with others.
TriangleMesh grid_soup(std::uint64_t side, std::uint64_t heights, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  const auto vertex = [&] {
    const auto x = static_cast<double>(random.below(side));
    const auto y = static_cast<double>(random.below(side));
    mesh.vertices.push_back({x, y, static_cast<double>(random.below(heights))});
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (int t = 0; t < 200; ++t) {
    const std::uint32_t a = vertex();
    const std::uint32_t b = vertex();
    mesh.triangles.push_back({a, b, vertex()});
  }
  return mesh;
}

TEST(SelfIntersections, AgreeWithAllPairsOfTrianglesThatShareCornersAndPlanes) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    TriangleMesh mesh = grid_soup(3 + seed % 12, 1 + seed % 4, seed);
    // The rotation has rounded factors: triangles in one plane remain only nearly in one plane.
    if (seed % 2 == 0) {
      for (Vec3d& v : mesh.vertices) v = {0.8 * v.x - 0.6 * v.y, 0.6 * v.x + 0.8 * v.y, v.z + 0.1 * v.x};
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const TrianglePair& pair : find_self_intersections(mesh).pairs) {
      pairs.emplace_back(pair.first.value, pair.second.value);
    }
    EXPECT_EQ(pairs, every_pair(mesh)) << seed;
    EXPECT_GT(pairs.size(), 100U);
  }
}

TEST(SelfIntersections, TiledPlanesHaveNone) {
  for (const double skew : {0.0, 1.0, 0.25}) {
    TriangleMesh mesh;
    const std::uint32_t n = 13;
    for (std::uint32_t y = 0; y < n; ++y) {
      for (std::uint32_t x = 0; x < n; ++x) mesh.vertices.push_back({1.0 * x, y + skew * x, skew * y});
    }
    for (std::uint32_t y = 0; y + 1 < n; ++y) {
      for (std::uint32_t x = 0; x + 1 < n; ++x) {
        const std::uint32_t v = y * n + x;
        mesh.triangles.push_back({v, v + 1, v + n});
        mesh.triangles.push_back({v + n + 1, v + n, v + 1});
      }
    }
    EXPECT_TRUE(find_self_intersections(mesh).pairs.empty()) << skew;
    SelfIntersectionSearch search;
    EXPECT_FALSE(search.finds_any(mesh)) << skew;
    std::swap(mesh.triangles[7][1], mesh.triangles[9][1]);  // two of them now overlap others
    EXPECT_FALSE(find_self_intersections(mesh).pairs.empty()) << skew;
    EXPECT_TRUE(search.finds_any(mesh)) << skew;
  }
}

TEST(SelfIntersections, FrameAfterFrameAgreeWithEachFrameAlone) {
  const TriangleMesh torus =
      make_torus({.ring_radius = 1, .tube_radius = 0.4, .ring_segments = 24, .tube_segments = 12});
  const TriangleMesh box = make_box({});
  SelfIntersectionSearch search;
  const Bvh bvh(torus, SiteTable(torus));
  SelfIntersectionSearch with_order(bvh.order());
  int crossing = 0;
  for (int frame = 0; frame < 60; ++frame) {
    // The tube thickens until it crosses itself in the middle, and thins again. Meanwhile the mesh moves far away.
    const double swell = 1.5 + 1.4 * std::sin(0.2 * frame);
    TriangleMesh mesh = frame % 20 == 19 ? box : torus;
    for (Vec3d& v : mesh.vertices) {
      const double ring = std::hypot(v.x, v.y);
      const double tube = swell * (ring - 1) + 1;
      v = {v.x / ring * tube + frame * frame, v.y / ring * tube, v.z * swell * (1 + 0.5 * frame)};
    }
    const bool expected = !find_self_intersections(mesh).pairs.empty();
    EXPECT_EQ(search.finds_any(mesh), expected) << frame;
    EXPECT_EQ(search.finds_any(test::unwelded(mesh)), expected) << frame;
    EXPECT_EQ(with_order.finds_any(mesh), expected) << frame;
    EXPECT_EQ(SelfIntersectionSearch(bvh.order()).finds_any(mesh), expected) << frame;
    crossing += expected ? 1 : 0;
  }
  EXPECT_GT(crossing, 5);
  EXPECT_LT(crossing, 55);
}

TEST(SelfIntersections, ShapesHaveNone) {
  for (const char* name : {"sphere", "torus", "torus_knot", "gear", "box"}) {
    const SelfIntersections found = find_self_intersections(make_shape(name));
    EXPECT_TRUE(found.pairs.empty()) << name << ": " << found.crossing << " + " << found.touching;
  }
}

/// Appends a moved copy with its own vertices.
void append_moved(TriangleMesh& mesh, const TriangleMesh& other, const Vec3d& by) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : other.vertices) mesh.vertices.push_back(v + by);
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

TEST(SelfIntersections, OfTwoBoxes) {
  const TriangleMesh box = make_box({});
  const Vec3d size = bounds(box).size();
  const auto with_copy = [&](const Vec3d& by) {
    TriangleMesh mesh = box;
    append_moved(mesh, box, by);
    return find_self_intersections(mesh);
  };
  EXPECT_GT(with_copy({size.x * 0.3, size.y * 0.4, size.z * 0.2}).crossing, 0U);
  // The boxes lie side by side with equal faces, joined by position. The two faces between them coincide.
  const SelfIntersections beside = with_copy({size.x, 0, 0});
  EXPECT_EQ(beside.crossing, 0U);
  EXPECT_GT(beside.touching, 0U);
  // The boxes overlap along one axis, but no triangle passes through another: they are reported as touching.
  const SelfIntersections along = with_copy({size.x * 0.5, 0, 0});
  EXPECT_GT(along.touching, 0U);
  EXPECT_TRUE(with_copy({size.x * 1.001, 0, 0}).pairs.empty());
}

TEST(SelfIntersections, DoNotDependOnScaleAndPlaceOfTheMeshOrOnThreads) {
  const TriangleMesh mesh = make_soup({.triangles = 400, .triangle_size = 0.3});
  const SelfIntersections once = find_self_intersections(mesh, 100000, {.threads = 1});
  EXPECT_GT(once.crossing, 100U);
  const auto same = [&](const SelfIntersections& other) {
    return std::equal(once.pairs.begin(), once.pairs.end(), other.pairs.begin(), other.pairs.end(),
                      [](const TrianglePair& a, const TrianglePair& b) {
                        return a.first == b.first && a.second == b.second && a.crosses == b.crosses;
                      });
  };
  EXPECT_TRUE(same(find_self_intersections(mesh, 100000, {.threads = 3})));
  for (const double scale : {0x1p400, 0x1p-400}) {
    TriangleMesh scaled = mesh;
    for (Vec3d& v : scaled.vertices) v = v * scale;
    EXPECT_TRUE(same(find_self_intersections(scaled))) << scale;
  }
}

/// A given order in space and given places of vertices change nothing. The triangles fill several batches.
TEST(SelfIntersections, AreTheSameWithGivenOrderAndPlaces) {
  const TriangleMesh mesh = make_soup({.triangles = 60000, .triangle_size = 0.01});
  const SelfIntersections expected = find_self_intersections(mesh);
  ASSERT_GT(expected.pairs.size(), 100U);
  const OrientedBvh bvh(mesh);
  const std::vector<std::uint32_t> corners = weld_clusters(mesh.vertices);
  const auto is_same = [&](const SelfIntersections& found) {
    return std::ranges::equal(found.pairs, expected.pairs, [](const TrianglePair& a, const TrianglePair& b) {
      return a.first == b.first && a.second == b.second && a.crosses == b.crosses;
    });
  };
  for (const int threads : {1, 2, 7}) {
    Context context;
    context.threads = threads;
    EXPECT_TRUE(is_same(find_self_intersections(mesh, bvh.order(), 100000, context)));
    EXPECT_TRUE(is_same(find_self_intersections(mesh, bvh.order(), corners, 100000, context)));
  }
  const std::span<const std::uint32_t> fewer = std::span(corners).first(5);
  EXPECT_THROW((void)find_self_intersections(mesh, bvh.order(), fewer, 100000), InvalidOption);
  EXPECT_THROW((void)find_self_intersections(mesh, fewer, corners, 100000), InvalidOption);
}

TEST(SelfIntersections, StopAtTheLimitAndWhenAsked) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(30000, Triangle{0, 1, 2});  // 450 million pairs
  const SelfIntersections found = find_self_intersections(mesh, 1000, {.threads = 1});
  EXPECT_FALSE(found.complete);
  EXPECT_EQ(found.pairs.size(), 1000U);
  EXPECT_EQ(found.touching, 1000U);
  const SelfIntersections again = find_self_intersections(mesh, 1000, {.threads = 2});
  EXPECT_EQ(again.pairs.back().second, found.pairs.back().second);
  EXPECT_FALSE(find_self_intersections(mesh, 0).complete);

  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)find_self_intersections(mesh, 1000, {.cancel = source.get_token()}), Cancelled);
  EXPECT_THROW((void)find_self_intersections(TriangleMesh{}), InvalidMesh);
  TriangleMesh points;
  points.vertices = {{0, 0, 0}};
  points.points = {0};
  EXPECT_TRUE(find_self_intersections(points).pairs.empty());
}

}  // namespace
}  // namespace blum
