// Proves that a mesh is separated into bodies that face outwards, each with its topology and the sites of the input. A
// mesh that does not bound a polyhedron is reported with the reason. Points are classified exactly.
#include "blum/solid/solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/solid/oriented_mesh.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;

std::vector<BettiNumbers> betti_of(const Solid& split) {
  std::vector<BettiNumbers> betti;
  for (const SolidBody& body : split.bodies()) betti.push_back(body.betti);
  return betti;
}

/// A hollow torus, a box in the hole of the torus, and a hollow box with a box in its void.
TriangleMesh many_bodies() {
  TriangleMesh mesh = make_torus({.ring_segments = 16, .tube_segments = 8});
  append(mesh, make_torus({.tube_radius = 0.1, .ring_segments = 16, .tube_segments = 8}));
  mesh.vertices.push_back({100, 100, 100});  // unused vertex
  append(mesh, make_box({.size = {0.2, 0.2, 0.2}}));
  append(mesh, box_between({3, 3, 3}, {6, 6, 6}));
  append(mesh, box_between({4, 4, 4}, {5, 5, 5}));
  append(mesh, box_between({4.4, 4.4, 4.4}, {4.6, 4.6, 4.6}));
  return mesh;
}

TEST(Solid, OuterShellsHaveTheVoidsInThem) {
  const Solid split = Solid::of(many_bodies());
  EXPECT_EQ(split.rule(), SolidRule::polyhedron);
  EXPECT_EQ(betti_of(split), (std::vector<BettiNumbers>{{1, 2, 1}, {1, 0, 0}, {1, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(split.reversed_shells(), 2U) << "the two voids were given as boxes and tori are";
  EXPECT_EQ(split.reason(),
            "the mesh is closed, manifold and does not cross itself; 2 shells faced the wrong way and were reversed");
}

TEST(Solid, NestedShellsAreAlternatelyBodiesAndVoids) {
  const Solid split = Solid::of(make_nested_shells({.shells = 5, .frequency = 2}));
  EXPECT_EQ(betti_of(split), (std::vector<BettiNumbers>{{1, 0, 1}, {1, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(split.reversed_shells(), 0U);
}

TEST(Solid, CatalogueShapesAddUpToTheirNumbers) {
  int shapes = 0;
  for (const ShapeInfo& shape : shape_catalog()) {
    const ShapeParameters parameters = complete_parameters(shape, {});
    const auto known = shape.betti(parameters);
    if (!known || shape.name == "organic") continue;
    const Solid split = Solid::of(shape.make(parameters));
    EXPECT_EQ(split.rule(), SolidRule::polyhedron) << shape.name << ": " << split.reason();
    BettiNumbers sum{};
    for (const SolidBody& body : split.bodies()) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += body.betti[k];
    }
    EXPECT_EQ(sum, *known) << shape.name;
    ++shapes;
  }
  EXPECT_GT(shapes, 15);
}

TEST(Solid, BodiesFaceOutwardsForAnyOrientationOfShells) {
  const TriangleMesh mesh = many_bodies();
  TriangleMesh turned = mesh;
  turned.triangles = reversed_triangles(mesh.triangles);
  for (const TriangleMesh& input : {mesh, turned}) {
    const Solid split = Solid::of(input);
    for (const SolidBody& body : split.bodies()) {
      const Topology facts = topology(body.mesh);
      EXPECT_TRUE(facts.closed && facts.manifold && facts.faces_outwards);
      EXPECT_EQ(facts.betti, body.betti);
    }
  }
  EXPECT_EQ(Solid::of(turned).reversed_shells(), 4U) << "all but the two voids";
}

TEST(Solid, InconsistentTrianglesAreReversed) {
  Random random(2);
  for (const bool has_degenerate : {false, true}) {
    TriangleMesh mesh = many_bodies();
    const std::vector<BettiNumbers> expected = betti_of(Solid::of(mesh));
    for (Triangle& t : mesh.triangles) {
      if (random.uniform() < 0.3) std::swap(t[0], t[1]);
    }
    if (has_degenerate) {
      const Triangle first = mesh.triangles.front();
      mesh.triangles.insert(mesh.triangles.begin(), {first[0], first[0], first[1]});
      mesh.triangles.push_back({first[1], first[2], first[1]});
    }
    const Solid split = Solid::of(mesh);
    ASSERT_EQ(split.rule(), SolidRule::polyhedron) << split.reason();
    EXPECT_EQ(betti_of(split), expected);
    EXPECT_TRUE(split.reason().ends_with("; neighbouring triangles faced different ways and were reversed"));
    for (const SolidBody& body : split.bodies()) {
      const Topology facts = topology(body.mesh);
      EXPECT_TRUE(facts.closed && facts.oriented && facts.faces_outwards);
    }
  }
}

TEST(Solid, EveryTriangleIsInOneBody) {
  const TriangleMesh mesh = many_bodies();
  const Solid split = Solid::of(mesh);
  std::vector<int> times(mesh.triangles.size(), 0);
  for (const SolidBody& body : split.bodies()) {
    ASSERT_EQ(body.triangle_of.size(), body.mesh.triangles.size());
    ASSERT_EQ(body.vertex_of.size(), body.mesh.vertices.size());
    for (const std::uint32_t t : body.triangle_of) ++times[t];
  }
  EXPECT_EQ(times, std::vector<int>(mesh.triangles.size(), 1));
}

/// The sorted positions of the vertices of a site.
std::vector<std::array<double, 3>> corners_of(const TriangleMesh& mesh, const SiteTable& sites, SiteId site) {
  std::vector<std::array<double, 3>> corners;
  for (const std::int32_t v : sites.vertices(site)) {
    if (v < 0) continue;
    const Vec3d& p = mesh.vertices[static_cast<std::size_t>(v)];
    corners.push_back({p.x, p.y, p.z});
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

TEST(Solid, SitesEqualThoseOfTheInput) {
  TriangleMesh mixed = many_bodies();  // its triangles are reordered, so that bodies interleave
  Random random(1);
  for (std::size_t t = mixed.triangles.size(); t > 1; --t) {
    std::swap(mixed.triangles[t - 1], mixed.triangles[random.below(t)]);
  }
  TriangleMesh open = make_torus({.ring_segments = 12, .tube_segments = 6});
  open.triangles.erase(open.triangles.begin());
  for (const TriangleMesh& mesh : {mixed, open}) {
    const SiteTable input_sites(mesh);
    const Solid solid = Solid::of(mesh);
    for (const SolidBody& body : solid.bodies()) {
      const SiteTable own_sites(body.mesh);
      for (std::uint32_t own = 0; own < own_sites.size(); ++own) {
        const SiteId input = body.input_site(SiteId(own), own_sites, input_sites);
        ASSERT_LT(input.value, input_sites.size());
        ASSERT_EQ(input_sites.site(input).kind, own_sites.site(SiteId(own)).kind);
        ASSERT_EQ(corners_of(mesh, input_sites, input), corners_of(body.mesh, own_sites, SiteId(own)));
      }
    }
  }
}

TEST(Solid, BodiesMayTouch) {
  TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, box_between({0, 0, 1}, {1, 1, 2}));    // a face
  append(mesh, box_between({1, 1, 0}, {2, 2, 0.5}));  // an edge
  append(mesh, box_between({2, 2, 0.5}, {3, 3, 3}));  // a corner
  const Solid split = Solid::of(mesh);
  EXPECT_EQ(split.rule(), SolidRule::polyhedron) << split.reason();
  EXPECT_EQ(betti_of(split), (std::vector<BettiNumbers>(4, BettiNumbers{1, 0, 0})));
}

/// The reason why a mesh does not bound a polyhedron. Also checks the resulting solid.
std::string obstacle_of(const TriangleMesh& mesh) {
  const Solid split = Solid::of(mesh);
  EXPECT_EQ(split.rule(), SolidRule::winding) << split.reason();
  EXPECT_EQ(split.reversed_shells(), 0U);
  EXPECT_EQ(split.bodies().size(), 1U);
  EXPECT_EQ(split.bodies().front().mesh.triangles.size(), mesh.triangles.size());
  const std::string before = "the mesh bounds no polyhedron: ";
  const std::string after = "; the solid is where the winding number is above 1/2";
  EXPECT_TRUE(split.reason().starts_with(before) && split.reason().ends_with(after)) << split.reason();
  return split.reason().substr(before.size(), split.reason().size() - before.size() - after.size());
}

TEST(Solid, AnOpenMeshIsNotAPolyhedron) {
  TriangleMesh mesh = make_box({});
  mesh.triangles.pop_back();
  EXPECT_EQ(obstacle_of(mesh), "it is open (3 boundary edges)");
}

TEST(Solid, ReportsAllObstacles) {
  TriangleMesh mesh = make_box({});
  mesh.triangles.push_back({mesh.triangles[0][1], mesh.triangles[0][0], 7});
  const std::string why = obstacle_of(mesh);
  EXPECT_TRUE(why.starts_with("it is open (") && why.find("), it is not manifold (") != std::string::npos) << why;
}

TEST(Solid, AOneSidedSurfaceIsNotAPolyhedron) {
  TriangleMesh mesh;  // the projective plane with six vertices
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                    {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
  EXPECT_TRUE(obstacle_of(mesh).starts_with("its triangles face different ways ("));
}

TEST(Solid, UnresolvedCrossingsAreNotAPolyhedron) {
  TriangleMesh mesh = box_between({0, 0, 0}, {2, 2, 2});
  append(mesh, box_between({1, 1, 1}, {3, 3, 3}));
  const TriangleMesh inwards{mesh.vertices, reversed_triangles(mesh.triangles), {}, {}};
  EXPECT_EQ(obstacle_of(inwards),
            "it crosses itself (6 pairs of triangles), and the crossings cannot be resolved: no point has a winding "
            "number above 0: the mesh faces inwards");
  mesh.vertices[0].x = 1e-200;
  EXPECT_EQ(obstacle_of(mesh),
            "it crosses itself (6 pairs of triangles), and the crossings cannot be resolved: coordinates are too many "
            "orders of magnitude apart");
}

TEST(Solid, RejectsMeshesWithoutTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}};
  mesh.segments = {{0, 1}};
  EXPECT_THROW((void)Solid::of(mesh), InvalidMesh);
}

TEST(Solid, TrianglesThatNameAVertexTwiceAreLeftOut) {
  TriangleMesh mesh = make_box({});
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 1});
  mesh.triangles.push_back({5, 5, 5});
  const Solid split = Solid::of(mesh);
  ASSERT_EQ(split.rule(), SolidRule::polyhedron) << split.reason();
  EXPECT_EQ(split.bodies().size(), 1U);
  EXPECT_EQ(split.bodies()[0].mesh.triangles.size(), 12U);
}

TEST(Solid, ShellsHaveDepthBodyAndOrientation) {
  const Solid solid = Solid::of(many_bodies());
  std::vector<std::uint32_t> depths;
  std::vector<std::uint32_t> bodies;
  std::vector<bool> reversed;
  for (const SolidShell& shell : solid.shells()) {
    depths.push_back(shell.depth);
    bodies.push_back(shell.body);
    reversed.push_back(shell.is_reversed);
    EXPECT_GT(shell.volume, 0);
  }
  EXPECT_EQ(depths, (std::vector<std::uint32_t>{0, 1, 0, 0, 1, 2}));
  EXPECT_EQ(bodies, (std::vector<std::uint32_t>{0, 0, 1, 2, 2, 3}));
  EXPECT_EQ(reversed, (std::vector<bool>{false, true, false, false, true, false}));
  EXPECT_EQ(solid.shells()[1].parent, 0U);
  EXPECT_EQ(solid.bodies()[2].shells, (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(solid.betti(), (BettiNumbers{4, 2, 2}));
}

TEST(Solid, ReversedTrianglesAreCounted) {
  TriangleMesh mesh = make_box({});
  for (const std::size_t t : {2U, 5U}) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  EXPECT_EQ(Solid::of(mesh).reversed_triangles(), 2U);
  EXPECT_EQ(Solid::of(make_box({})).reversed_triangles(), 0U);
}

/// The reference is the full sum of solid angles, which is exact except very close to the surface.
TEST(Solid, PointsInsideFollowTheWindingNumber) {
  Random random(4);
  TriangleMesh open = make_torus({.ring_segments = 12, .tube_segments = 6});
  open.triangles.erase(open.triangles.begin());
  TriangleMesh crossing = box_between({0, 0, 0}, {2, 2, 2});
  append(crossing, box_between({1, 1, 1}, {3, 3, 3}));
  for (const TriangleMesh& mesh : {many_bodies(), open, crossing}) {
    const Solid solid = Solid::of(mesh);
    TriangleMesh outward;  // bodies face outwards
    for (const SolidBody& body : solid.bodies()) append(outward, body.mesh);
    const WindingNumber winding(outward);
    int inside = 0;
    for (int n = 0; n < 2000; ++n) {
      const Vec3d p{random.uniform(-1.5, 6), random.uniform(-1.5, 6), random.uniform(-1.5, 6)};
      ASSERT_EQ(solid.inside(p), winding(p) > 0.5) << p.x << " " << p.y << " " << p.z;
      inside += solid.inside(p) ? 1 : 0;
    }
    EXPECT_GT(inside, 0);
  }
}

TEST(Solid, ClassifiesPointsNextToTheSurfaceExactly) {
  const TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  const Solid solid = Solid::of(mesh);
  const double below = std::nextafter(1.0, 0.0);
  const double above = std::nextafter(1.0, 2.0);
  for (const double x : {0.5, 0.3, 1e-9, below}) {
    EXPECT_TRUE(solid.inside({x, 0.25, below}));
    EXPECT_FALSE(solid.inside({x, 0.25, above}));
    EXPECT_TRUE(solid.inside({x, 0.25, 1})) << "on a face";
    EXPECT_TRUE(solid.inside({x, 1, 1})) << "on an edge";
  }
  EXPECT_TRUE(solid.inside({1, 1, 1}));
  EXPECT_FALSE(solid.inside({1, 1, above}));
  EXPECT_FALSE(solid.inside({-1e-70, 0.5, 0.5}));
}

TEST(Solid, AnImageIsTheUnionOfAtLeastOneClosedVoxel) {
  VoxelImage image;
  image.grid = {{10, 20, 30}, {1, 2, 3}, {3, 3, 3}, {}};
  std::vector<std::uint8_t> values(27, 0);
  values[13] = 7;  // the middle: 11 22 33
  values[26] = 7;  // touches it in a corner
  values[0] = 1;
  image.values = values;
  const Solid solid = Solid::of(image, LabelSelection::of_label(7));
  EXPECT_EQ(solid.rule(), SolidRule::voxels);
  EXPECT_EQ(solid.betti(), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(solid.voxels().count(), 2U);
  EXPECT_TRUE(solid.inside({11, 22, 33}));
  EXPECT_TRUE(solid.inside({11.5, 23, 34.5})) << "the corner in common";
  EXPECT_TRUE(solid.inside({10.5, 21, 31.5})) << "the other corner";
  EXPECT_TRUE(solid.inside({12.5, 25, 37.5})) << "the image's own corner";
  EXPECT_FALSE(solid.inside({10.4, 22, 33}));
  EXPECT_FALSE(solid.inside({12.6, 24, 36}));
  EXPECT_THROW((void)Solid::of(image, LabelSelection::of_label(5)), InvalidImage);
}

TEST(Solid, DetectsOpenMeshesThatFaceInwards) {
  TriangleMesh mesh = make_box({});
  mesh.triangles.pop_back();
  EXPECT_FALSE(Solid::of(mesh).faces_inwards());
  mesh.triangles = reversed_triangles(mesh.triangles);
  EXPECT_TRUE(Solid::of(mesh).faces_inwards());
}

/// The surface is the input with reversed triangles corrected. Numbers stay.
TEST(Solid, TheSurfaceIsTheInputFacingOutwards) {
  TriangleMesh mesh = box_between({0, 0, 0}, {3, 3, 3});
  TriangleMesh hole = box_between({1, 1, 1}, {2, 2, 2});
  reverse_triangles(hole);
  append(mesh, hole);
  mesh.vertices.insert(mesh.vertices.begin(), {9, 9, 9});  // used by no triangle
  for (Triangle& t : mesh.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
  const TriangleMesh given = mesh;
  std::swap(mesh.triangles[5][1], mesh.triangles[5][2]);
  const Solid solid = Solid::of(mesh);
  EXPECT_EQ(solid.surface().mesh.vertices, given.vertices);
  EXPECT_EQ(solid.surface().mesh.triangles, given.triangles);
  EXPECT_TRUE(solid.surface().vertex_of.empty() && solid.surface().triangle_of.empty());
  EXPECT_EQ(solid.problem(), "");
  EXPECT_FALSE(solid.topology().oriented);
  EXPECT_EQ(solid.topology().triangles, given.triangles.size());
  EXPECT_EQ(solid.surface().mesh.triangles, oriented_mesh(mesh).mesh.triangles);
}

TEST(Solid, TheSurfaceOfResolvedCrossingsNamesItsOrigin) {
  TriangleMesh mesh = make_box();
  append(mesh, test::moved(make_box(), 1, {0.5, 0.25, 0.125}));
  const Solid solid = Solid::of(mesh);
  const SolidSurface& surface = solid.surface();
  ASSERT_EQ(surface.vertex_of.size(), surface.mesh.vertices.size());
  ASSERT_EQ(surface.triangle_of.size(), surface.mesh.triangles.size());
  EXPECT_EQ(topology(surface.mesh).betti, solid.betti());
  for (std::size_t v = 0; v < surface.vertex_of.size(); ++v) {
    if (surface.vertex_of[v] != SolidBody::no_vertex) {
      EXPECT_EQ(surface.mesh.vertices[v], mesh.vertices[surface.vertex_of[v]]);
    }
  }
  EXPECT_EQ(solid.problem(), "");
}

/// Each problem of a mesh that does not bound separate bodies has its own message.
TEST(Solid, ReportsProblemsWithRemedies) {
  TriangleMesh open = make_box();
  open.triangles.pop_back();
  EXPECT_NE(Solid::of(open).problem().find("weld the mesh"), std::string::npos);
  TriangleMesh touching = make_box();
  append(touching, test::moved(make_box(), 1, {0.25, 0.25, 1}));
  const Solid bodies = Solid::of(touching);
  EXPECT_EQ(bodies.rule(), SolidRule::polyhedron);
  EXPECT_NE(bodies.problem().find("crosses or touches itself: triangles"), std::string::npos);
}

TEST(Solid, CopiesShareResults) {
  std::optional<Solid> first = Solid::of(make_box({}));
  const Solid second = *first;
  EXPECT_EQ(first->bodies().data(), second.bodies().data());
  first.reset();
  EXPECT_TRUE(second.inside({0, 0, 0}));
}

}  // namespace
}  // namespace blum
