// Proves that meshes that cross, overlap or touch themselves become polyhedra with resolved crossings. Their topology
// is that of the points with winding number 1 or more. Their triangles, vertices and sites are those of the input, or
// lie on them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;

/// Expects a polyhedron whose inside equals that of winding numbers, with the given Betti numbers, also of its models.
void expect_resolved(const TriangleMesh& mesh, const BettiNumbers& betti) {
  const Solid solid = Solid::of(mesh);
  ASSERT_EQ(solid.rule(), SolidRule::polyhedron) << solid.reason();
  ASSERT_TRUE(solid.resolved().has_value());
  EXPECT_EQ(*solid.betti(), betti) << solid.reason();
  EXPECT_EQ(solid.reversed_shells(), 0U);
  const WindingNumber winding(mesh);
  const Box3 box = bounds(mesh);
  Random random(3);
  for (int k = 0; k < 500; ++k) {
    const Vec3d at = random.in_cube();
    const Vec3d p = box.lower + Vec3d{at.x * box.size().x, at.y * box.size().y, at.z * box.size().z};
    ASSERT_EQ(solid.inside(p), std::round(winding(p)) >= 1) << p.x << " " << p.y << " " << p.z;
  }
  for (const int resolution : {5, 16}) {
    const CellularModel model = solid.model({.resolution = resolution});
    EXPECT_TRUE(model.report().passes);
    EXPECT_EQ(model.betti(), betti) << "model at " << resolution;
  }
}

TEST(ResolvedSolid, BoxesThatCross) {
  TriangleMesh mesh = box_between({0, 0, 0}, {2, 2, 2});
  append(mesh, box_between({1, 1, 1}, {3, 3, 3}));
  expect_resolved(mesh, {1, 0, 0});
  EXPECT_EQ(Solid::of(mesh).reason(),
            "6 pairs of triangles crossed, 12 pairs of triangles touched: resolved exactly, the solid is where the "
            "winding number is 1 or more");
}

TEST(ResolvedSolid, ABoxGivenTwiceIsOne) {
  TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, box_between({0, 0, 0}, {1, 1, 1}));
  expect_resolved(mesh, {1, 0, 0});
  const Solid solid = Solid::of(mesh);
  EXPECT_EQ(solid.bodies()[0].mesh.triangles.size(), 12U);
}

/// Rays from crossing shells do not determine how the shells are nested.
TEST(ResolvedSolid, BoxesThatCrossAtRandom) {
  Random random(8);
  const auto place = [&](double least) {
    return Vec3d{random.uniform(least, 1), random.uniform(least, 1), random.uniform(least, 1)};
  };
  for (int n = 0; n < 200; ++n) {
    TriangleMesh mesh = box_between({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
    append(mesh, box_between({0.5, 0.45, 0.45}, {0.7, 0.55, 0.55}));  // always crosses the first box
    for (int k = 0; k < 6; ++k) {
      const Vec3d lower = place(0);
      append(mesh, box_between(lower, lower + place(0.01)));
    }
    const Solid solid = Solid::of(mesh);
    ASSERT_EQ(solid.rule(), SolidRule::polyhedron) << n << ": " << solid.reason();
    const WindingNumber winding(mesh);
    for (int k = 0; k < 50; ++k) {
      const Vec3d p = random.in_cube() * 2;
      ASSERT_EQ(solid.inside(p), std::round(winding(p)) >= 1) << n << ": " << p.x << " " << p.y << " " << p.z;
    }
  }
}

TEST(ResolvedSolid, VoidsThatReachWallsAreOpen) {
  TriangleMesh mesh = box_between({0, 0, 0}, {2, 2, 2});
  append(mesh, box_between({0, 0.5, 0.5}, {1, 1, 1}, true));
  expect_resolved(mesh, {1, 0, 0});
  append(mesh, box_between({1, 0.5, 0.5}, {2, 1, 1}, true));
  expect_resolved(mesh, {1, 1, 0});
}

TEST(ResolvedSolid, TwoRingsThatCrossHaveThreeHoles) {
  TriangleMesh mesh = make_torus({.ring_segments = 24, .tube_segments = 12});
  append(mesh, make_torus({.ring_segments = 24, .tube_segments = 12}), {1.1, 0.05, 0.02});
  expect_resolved(mesh, {1, 3, 0});
}

/// Spheres form a closed shell of bubbles, which encloses a void.
TEST(ResolvedSolid, SpheresEncloseAVoid) {
  TriangleMesh mesh;
  for (const Vec3d& at :
       {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}, Vec3d{0, 0, -1}}) {
    append(mesh, make_sphere({.radius = 0.9, .frequency = 6}), at);
  }
  expect_resolved(mesh, {1, 0, 1});
}

/// A sphere with a part pulled through the opposite side. The tip of the part is inside out.
TEST(ResolvedSolid, ASpherePulledThroughItself) {
  TriangleMesh mesh = make_sphere({.frequency = 8});
  for (Vec3d& v : mesh.vertices) {
    const double off = std::hypot(v.x, v.y);
    if (v.z > 0 && off < 0.5) v.z -= 3 * (0.5 - off) * 2;
  }
  expect_resolved(mesh, {1, 1, 0});
}

TEST(ResolvedSolid, TrianglesWithoutArea) {
  // The edge from 0 to 2 of a face of a tetrahedron is cut on one side only. A triangle without area closes the gap.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.5, 0.5, 0}, {1, 1, 0}, {1, 0, 0}, {0.25, 0.5, 1}};
  mesh.triangles = {{0, 2, 3}, {0, 1, 2}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {0, 3, 4}};
  expect_resolved(mesh, {1, 0, 0});
  EXPECT_EQ(Solid::of(mesh).resolved()->flat, 1U);
}

TEST(ResolvedSolid, EdgesOfFourTrianglesAndVerticesOfTwoFans) {
  TriangleMesh edge;
  edge.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}};
  edge.triangles = {{0, 2, 1}, {0, 3, 2}, {1, 2, 3}, {0, 1, 3}, {0, 1, 4}, {0, 4, 5}, {1, 5, 4}, {0, 5, 1}};
  const Solid solid = Solid::of(edge);
  EXPECT_EQ(solid.rule(), SolidRule::polyhedron) << solid.reason();
  EXPECT_TRUE(solid.reason().starts_with("1 edge had more than two triangles: resolved exactly")) << solid.reason();
  EXPECT_EQ(*solid.betti(), (BettiNumbers{2, 0, 0})) << "bodies that touch";
  TriangleMesh vertex;
  vertex.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  vertex.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};
  const Solid apart = Solid::of(vertex);
  EXPECT_EQ(apart.rule(), SolidRule::polyhedron) << apart.reason();
  EXPECT_EQ(*apart.betti(), (BettiNumbers{2, 0, 0}));
}

/// Two boxes meet along an edge. Boxes above and below join them.
TEST(ResolvedSolid, PartsThatMeetAlongAnEdgeAreSeparatedThere) {
  TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, box_between({1, 1, 0}, {2, 2, 1}));
  append(mesh, box_between({0.2, 0.2, 0.7}, {1.8, 1.8, 2}));
  expect_resolved(mesh, {1, 0, 0});
  EXPECT_EQ(Solid::of(mesh).resolved()->touching_edges, 1U);
  EXPECT_EQ(Solid::of(mesh).resolved()->pinches, 1U) << "at its lower end";
  append(mesh, box_between({0.2, 0.2, -1}, {1.8, 1.8, 0.3}));
  expect_resolved(mesh, {1, 1, 0});
  EXPECT_EQ(Solid::of(mesh).resolved()->pinches, 1U) << "in its middle";
}

/// Two pyramids with a common apex, joined by boxes: the solid meets itself in the apex.
TEST(ResolvedSolid, PartsThatMeetInAVertexAreSeparatedThere) {
  TriangleMesh mesh = box_between({-1, -1, -3}, {1, 1, -1});
  append(mesh, box_between({-1, -1, 1}, {1, 1, 3}));
  append(mesh, box_between({0.5, -0.5, -2}, {2, 0.5, 2}));
  TriangleMesh spindle;
  spindle.vertices = {{-0.9, -0.9, -1.5}, {-0.3, -0.9, -1.5}, {-0.6, -0.3, -1.5}, {-0.6, -0.6, 0},
                      {-0.9, -0.9, 1.5},  {-0.3, -0.9, 1.5},  {-0.6, -0.3, 1.5}};
  spindle.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {4, 5, 6}, {5, 4, 3}, {6, 5, 3}, {4, 6, 3}};
  append(mesh, spindle);
  expect_resolved(mesh, {1, 0, 0});
  EXPECT_EQ(Solid::of(mesh).resolved()->pinches, 1U);
}

TEST(ResolvedSolid, VerticesTrianglesAndSitesLieOnTheInput) {
  TriangleMesh mesh = make_torus({.ring_segments = 20, .tube_segments = 10});
  append(mesh, box_between({0.2, -0.3, -0.4}, {1.6, 0.4, 0.2}));
  append(mesh, make_sphere({.radius = 0.2, .frequency = 3}), {-1, 0.1, 0});
  const Solid solid = Solid::of(mesh);
  const SiteTable input_sites(mesh);
  std::size_t news = 0;
  for (const SolidBody& body : solid.bodies()) {
    const SiteTable own_sites(body.mesh);
    for (std::size_t v = 0; v < body.vertex_of.size(); ++v) {
      news += body.vertex_of[v] == SolidBody::no_vertex ? 1 : 0;
      if (body.vertex_of[v] == SolidBody::no_vertex) continue;
      ASSERT_EQ(body.mesh.vertices[v], mesh.vertices[body.vertex_of[v]]);
    }
    for (std::uint32_t own = 0; own < own_sites.size(); ++own) {
      const SiteId site = body.input_site(SiteId(own), own_sites, input_sites);
      ASSERT_LT(site.value, input_sites.size());
      // All corners of the own site lie on the plane, the line or the point of the input site.
      const auto corners = input_sites.vertices(site);
      const auto at = [&](std::size_t k) {
        return mesh.vertices[static_cast<std::size_t>(corners[k] < 0 ? corners[0] : corners[k])];
      };
      const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
      for (const std::int32_t v : own_sites.vertices(SiteId(own))) {
        if (v < 0) continue;
        const Vec3d off = body.mesh.vertices[static_cast<std::size_t>(v)] - at(0);
        ASSERT_LE(std::abs(dot(off, normal)), 1e-14 * length(normal));
        ASSERT_TRUE(input_sites.site(site).kind != SiteKind::vertex || length(off) == 0);
      }
    }
  }
  EXPECT_EQ(news, solid.resolved()->new_vertices);
  EXPECT_GT(news, 50U);
}

}  // namespace
}  // namespace blum
