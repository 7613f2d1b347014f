// Proves that closest points of triangle meshes, and their sites, equal those of brute force.
#include "medial_axis/surface/mesh_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/field/reference.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using detail::Footprint;
using detail::MeshSurface;
using detail::NearestPoint;
using detail::SurfacePoint;

struct Sample {
  explicit Sample(TriangleMesh its_mesh) : mesh(std::move(its_mesh)), brute(mesh), surface(mesh, sites, true, {}) {}

  [[nodiscard]] double distance_to(std::uint32_t triangle, const Vec3d& query) const {
    const Triangle& t = mesh.triangles[triangle];
    return reference::triangle_distance(query, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  [[nodiscard]] bool faces(std::uint32_t triangle, const Vec3d& query) const {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3d& a = mesh.vertices[t[0]];
    return dot(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a), query - a) > 0;
  }
  [[nodiscard]] Footprint footprint_on(std::uint32_t triangle, const Vec3d& query) const {
    return surface.footprint(sites.id({SiteKind::face, triangle}), query, true);
  }

  TriangleMesh mesh;
  SiteTable sites{mesh};
  reference::BruteForce brute;
  MeshSurface surface;
};

const double tolerance = 1e-13;

TEST(MeshSurface, NearestIsTheNearestOfAllTriangles) {
  for (const TriangleMesh& mesh : {make_soup({.triangles = 200, .awkward = 0.7, .seed = 3}), make_torus({}),
                                   make_shape("gear", {{"teeth", 40}}), make_wedge({.angle = 2})}) {
    const Sample s(mesh);
    for (const Vec3d& query : test::places_around(s.mesh, 200, 4)) {
      const double scale = bounds(s.mesh).diagonal() + length(query);
      const NearestPoint found = s.surface.nearest(query, s.footprint_on(0, query));
      ASSERT_NEAR(found.distance, s.brute.nearest(query).distance, tolerance * scale);
      ASSERT_NEAR(length(query - found.point), found.distance, tolerance * scale);
      ASSERT_LE(s.brute.site_distance(found.site, found.point), tolerance * scale);
      ASSERT_LE(s.distance_to(found.element, found.point), tolerance * scale);
    }
  }
}

TEST(MeshSurface, InsideEqualsTheWindingNumberOfAClosedMesh) {
  for (const TriangleMesh& mesh : {make_torus({}), make_shape("gear", {{"teeth", 40}}), make_wedge({.angle = 2})}) {
    const Sample s(mesh);
    const MeshSurface open(s.mesh, s.sites, false, {});
    std::size_t inside = 0;
    for (const Vec3d& query : test::places_around(s.mesh, 400, 4)) {
      const NearestPoint nearest = s.surface.nearest(query, s.footprint_on(0, query));
      if (nearest.distance < 1e-9) continue;
      const bool expected = reference::winding_number(s.mesh, query) > 0.5;
      ASSERT_EQ(s.surface.is_inside(query, nearest), expected);
      ASSERT_FALSE(open.is_inside(query, nearest)) << "nothing is known";
      inside += expected ? 1 : 0;
    }
    EXPECT_GT(inside, 0U);
  }
}

TEST(MeshSurface, FootprintsAreTheClosestPointsOfTriangles) {
  const Sample s(make_soup({.triangles = 300, .awkward = 0.7, .seed = 5}));
  for (const Vec3d& query : test::places_around(s.mesh, 300, 6)) {
    const double scale = bounds(s.mesh).diagonal() + length(query);
    for (std::uint32_t t = 0; t < s.mesh.triangles.size(); t += 7) {
      const Footprint foot = s.footprint_on(t, query);
      ASSERT_EQ(foot.element, t);
      ASSERT_NEAR(length(query - foot.point), s.distance_to(t, query), tolerance * scale);
      ASSERT_LE(s.distance_to(t, foot.point), tolerance * scale);
    }
  }
}

TEST(MeshSurface, FootprintsOfVerticesAndEdgesLieOnTheirTriangles) {
  const Sample s(make_torus({.ring_segments = 12, .tube_segments = 8}));
  const Vec3d far{3, 4, 5};
  for (std::uint32_t site = 0; site < s.sites.size(); ++site) {
    const Footprint foot = s.surface.footprint(SiteId(site), far, true);
    ASSERT_EQ(foot.element, s.sites.triangle(SiteId(site)).value);
  }
}

TEST(MeshSurface, SitesAreTheVertexTheEdgeOrTheFaceBelow) {
  const Sample s(make_box({.size = {1, 2, 3}}));
  int kinds[3] = {};
  for (std::uint32_t t = 0; t < s.mesh.triangles.size(); ++t) {
    const Triangle& corners = s.mesh.triangles[t];
    const auto corner = [&](std::size_t k) { return s.mesh.vertices[corners[k % 3]]; };
    const Vec3d middle = (corner(0) + corner(1) + corner(2)) / 3.0;
    const auto expect = [&](const Vec3d& query, Site expected) {
      const SiteId site = s.surface.site_of(s.footprint_on(t, query));
      EXPECT_EQ(s.sites.site(site), expected) << "triangle " << t;
      ++kinds[static_cast<int>(expected.kind)];
    };
    const Vec3d up = cross(corner(1) - corner(0), corner(2) - corner(0));
    expect(middle + up, {SiteKind::face, t});
    for (std::size_t k = 0; k < 3; ++k) {
      expect(corner(k) + (corner(k) - middle) * 2.0, {SiteKind::vertex, corners[k]});
      const Vec3d half = (corner(k) + corner(k + 1)) * 0.5;
      const Vec3d outwards = cross(corner(k + 1) - corner(k), up);
      expect(half + outwards, {SiteKind::edge, s.sites.triangle_edges()[t][k].value});
    }
  }
  EXPECT_EQ(kinds[0] + kinds[1] + kinds[2], 12 * 7);
}

/// If a convex body faces a point, its only local minimum of the distance is the nearest point.
TEST(MeshSurface, FollowingAConvexSurfaceFindsTheNearestPoint) {
  for (const TriangleMesh& mesh : {make_sphere({.frequency = 6}), make_box({.segments = {4, 3, 5}}),
                                   make_ellipsoid({.radii = {1, 0.5, 0.2}, .frequency = 5})}) {
    const Sample s(mesh);
    Random random(7);
    int followed = 0;
    for (int n = 0; n < 600; ++n) {
      const Vec3d outwards = random.in_ball();
      const Vec3d query = outwards * (random.uniform(1.8, 4) / length(outwards));
      const auto triangle = static_cast<std::uint32_t>(random.below(s.mesh.triangles.size()));
      if (!s.faces(triangle, query)) continue;
      const Footprint end = s.surface.follow(s.footprint_on(triangle, query), query, 1e9);
      ASSERT_NEAR(length(query - end.point), s.brute.nearest(query).distance, 1e-12);
      ++followed;
    }
    EXPECT_GT(followed, 100);
  }
}

TEST(MeshSurface, FollowingEndsIfNoTriangleAroundIsCloser) {
  const Sample s(make_shape("gear", {{"teeth", 12}}));
  Random random(8);
  for (const Vec3d& query : test::places_around(s.mesh, 400, 9)) {
    const auto triangle = static_cast<std::uint32_t>(random.below(s.mesh.triangles.size()));
    const Footprint start = s.footprint_on(triangle, query);
    const Footprint end = s.surface.follow(start, query, 1e9);
    const double distance = length(query - end.point);
    ASSERT_LE(distance, length(query - start.point));
    for (std::uint32_t t = 0; t < s.mesh.triangles.size(); ++t) {
      if (s.distance_to(t, end.point) > 1e-12) continue;  // does not contain the point
      ASSERT_GE(s.distance_to(t, query), distance - 1e-9) << "triangle " << t;
    }
  }
}

TEST(MeshSurface, FollowingStaysWithinItsReach) {
  const Sample s(make_torus({.ring_segments = 40, .tube_segments = 16}));
  Random random(10);
  int stopped = 0;
  for (const Vec3d& query : test::places_around(s.mesh, 400, 11)) {
    const auto triangle = static_cast<std::uint32_t>(random.below(s.mesh.triangles.size()));
    const Footprint start = s.footprint_on(triangle, query);
    const double reach = random.uniform(0, 1);
    const Footprint end = s.surface.follow(start, query, reach);
    ASSERT_LE(length(end.point - start.point), reach);
    const Footprint free = s.surface.follow(start, query, 1e9);
    stopped += length(free.point - start.point) > reach ? 1 : 0;
  }
  EXPECT_GT(stopped, 50);
}

TEST(MeshSurface, TrianglesCrossTheSurfaceIfTheyCrossOneOfItsTriangles) {
  const Sample s(make_torus({}));
  const std::vector<Vec3d> places = test::places_around(s.mesh, 300, 7);
  std::size_t crossing = 0;
  for (std::size_t k = 0; k + 2 < places.size(); ++k) {
    const Vec3d& a = places[k];
    // Triangles alternate between large and small.
    const double size = k % 2 == 0 ? 1 : 0.1;
    const Vec3d b = a + (places[k + 1] - a) * size;
    const Vec3d c = a + (places[k + 2] - a) * size;
    const detail::ContactTriangle own{{a, b, c}, {1000000, 1000001, 1000002}};
    if (detail::has_no_area(own.points)) continue;
    bool wanted = false;
    for (const Triangle& t : s.mesh.triangles) {
      const detail::ContactTriangle wall{{s.mesh.vertices[t[0]], s.mesh.vertices[t[1]], s.mesh.vertices[t[2]]}, t};
      wanted = wanted || detail::contact(own, wall) == detail::Contact::crossing;
    }
    EXPECT_EQ(s.surface.crosses(a, b, c, nullptr), wanted) << k;
    crossing += wanted ? 1 : 0;
  }
  EXPECT_GT(crossing, 50U);
  EXPECT_LT(crossing, 250U);
}

TEST(MeshSurface, WaysLeadFromTriangleToTriangleWithinTheirBox) {
  const Sample s(make_sphere({.radius = 1}));
  const auto triangle_at = [&](const Vec3d& p) { return s.surface.nearest(p, {}).element; };
  const std::uint32_t from = triangle_at({2, 0.1, 0.2});
  const std::uint32_t to = triangle_at({0.1, 2, 0.3});
  const Box3 all{{-2, -2, -2}, {2, 2, 2}};
  const auto way = s.surface.way_over(from, to, all);
  ASSERT_TRUE(way.has_value());
  ASSERT_GT(way->size(), 2U);
  for (std::size_t k = 0; k < way->size(); ++k) {
    const SurfacePoint& point = (*way)[k];
    EXPECT_NEAR(s.brute.nearest(point.at).distance, 0, tolerance);
    EXPECT_LT(dot(point.inwards, point.at), -0.9 * length(point.at)) << "towards the centre";
    if (k == 0) continue;
    const Vec3d middle = 0.5 * (point.at + (*way)[k - 1].at);
    EXPECT_NEAR(s.brute.nearest(middle).distance, 0, tolerance) << "both lie on one triangle";
  }
  EXPECT_TRUE(s.surface.way_over(from, from, all)->empty());
  const Box3 half{{0.5, -2, -2}, {2, 2, 2}};
  EXPECT_FALSE(s.surface.way_over(from, to, half).has_value());
}

}  // namespace
}  // namespace blum
