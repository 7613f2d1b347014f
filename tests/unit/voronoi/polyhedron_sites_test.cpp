// Proves that the sites of a polyhedron are those counted by hand on small solids. On every generated solid, they are
// those that inner points are closest to, found by an independent search. No other sites are listed.
#include "blum/voronoi/polyhedron_sites.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/solid/solid.hpp"
#include "support/mesh_places.hpp"
#include "support/shape_names.hpp"
#include "voronoi/dual_cone.hpp"

namespace blum {
namespace {

PolyhedronSites sites_of(const MeshView& mesh) {
  return polyhedron_sites(mesh, SiteTable(mesh));
}

std::size_t count(const PolyhedronSites& sites, EdgeTurn turn) {
  return static_cast<std::size_t>(std::count(sites.turn.begin(), sites.turn.end(), turn));
}

/// Returns a prism over a polygon. Each cap is a fan around a point that sees all corners.
TriangleMesh prism(const std::vector<std::array<double, 2>>& corners, const std::array<double, 2>& seen_from) {
  TriangleMesh out;
  const auto n = static_cast<std::uint32_t>(corners.size());
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : corners) out.vertices.push_back({x, y, z});
    out.vertices.push_back({seen_from[0], seen_from[1], z});
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    out.triangles.push_back({n, next, k});
    out.triangles.push_back({2 * n + 1, n + 1 + k, n + 1 + next});
    out.triangles.push_back({k, next, n + 1 + next});
    out.triangles.push_back({k, n + 1 + next, n + 1 + k});
  }
  return out;
}

TEST(PolyhedronSites, OfABox) {
  const PolyhedronSites sites = sites_of(make_box({}));
  EXPECT_EQ(sites.face_count, 6U);
  EXPECT_EQ(count(sites, EdgeTurn::convex), 12U);
  EXPECT_EQ(count(sites, EdgeTurn::flat), 6U);
  EXPECT_TRUE(sites.reflex_edges.empty());
  EXPECT_TRUE(sites.reflex_vertices.empty());
}

TEST(PolyhedronSites, OfAnL) {
  const TriangleMesh mesh = prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {0.5, 0.5});
  const PolyhedronSites sites = sites_of(mesh);
  EXPECT_EQ(sites.face_count, 8U);
  EXPECT_EQ(sites.reflex_edges.size(), 1U);
  EXPECT_TRUE(sites.reflex_vertices.empty()) << "at the ends of the reflex edge a cap is closer";
}

/// In a box with a box-shaped void, all edges and vertices of the void are sites.
TEST(PolyhedronSites, OfAVoid) {
  TriangleMesh mesh = test::box_between({-2, -2, -2}, {2, 2, 2});
  TriangleMesh hole = test::box_between({-1, -1, -1}, {1, 1, 1});
  reverse_triangles(hole);
  append(mesh, hole);
  const PolyhedronSites sites = sites_of(mesh);
  EXPECT_EQ(sites.face_count, 12U);
  EXPECT_EQ(sites.reflex_edges.size(), 12U);
  EXPECT_EQ(sites.reflex_vertices.size(), 8U);
}

/// The tip of a pyramid that points into a box is a site, for any number of edges.
TEST(PolyhedronSites, OfATip) {
  for (const std::uint32_t sides : {3U, 4U, 7U, 60U}) {
    SCOPED_TRACE(sides);
    TriangleMesh tip;
    tip.vertices = {{0, 0, 0}};
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 6.283185307179586 * k / sides;
      tip.vertices.push_back({0.5 * std::cos(angle), 0.5 * std::sin(angle), -1});
    }
    for (std::uint32_t k = 2; k < sides; ++k) tip.triangles.push_back({1, k + 1, k});
    for (std::uint32_t k = 0; k < sides; ++k) tip.triangles.push_back({0, 1 + k, 1 + (k + 1) % sides});
    EXPECT_TRUE(sites_of(tip).reflex_vertices.empty());
    reverse_triangles(tip);
    append(tip, test::box_between({-3, -3, -3}, {3, 3, 3}));
    EXPECT_EQ(sites_of(tip).reflex_vertices.size(), sides + 1);
  }
}

/// At a saddle, no direction is opposite to all edges.
TEST(PolyhedronSites, DualConesOfFewEdges) {
  const auto cone_of = [&](std::vector<Vec3d> directions) { return voronoi::dual_cone({0, 0, 0}, directions).size(); };
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 3U);
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}), 3U) << "inside of the others";
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {-1, 0, 1}, {0, -1, 1}}), 4U);
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}), 0U) << "two of them opposite";
  EXPECT_EQ(cone_of({{1, 0, 1}, {-1, 0, 1}, {0, 1, -1}, {0, -1, -1}}), 0U) << "a saddle";
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}), 0U) << "in a plane";
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {-1, -1, 1e-30}, {0, 0, 1}}), 3U) << "nearly";
}

class PolyhedronSitesOfShapes : public testing::TestWithParam<std::string> {};

/// Returns the sine of the angle between the normals of an edge's triangles.
double bend_of(const MeshView& mesh, const std::array<std::uint32_t, 2>& triangles) {
  std::array<Vec3d, 2> normals;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto [a, b, c] = triangle_corners(mesh, triangles[k]);
    normals[k] = cross(b - a, c - a) / length(cross(b - a, c - a));
  }
  return length(cross(normals[0], normals[1]));
}

/// Returns a direction from a reflex edge, between the domains of its triangles.
Vec3d inner_direction(const MeshView& mesh, const std::array<std::uint32_t, 2>& triangles) {
  Vec3d out;
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    out -= cross(b - a, c - a) / length(cross(b - a, c - a));
  }
  return out / length(out);
}

/// Returns a direction from a reflex vertex, in the middle of its dual cone; nullopt if rounding would decide it.
std::optional<Vec3d> inner_direction(const Vec3d& v, const std::vector<Vec3d>& ends) {
  const std::vector<std::uint32_t> cone = voronoi::dual_cone(v, ends);
  Vec3d out;
  for (std::size_t k = 0; k < cone.size(); ++k) {
    const Vec3d ray = cross(ends[cone[k]] - v, ends[cone[(k + 1) % cone.size()]] - v);
    double along = 0;  // relative to all edges, which the ray must oppose
    for (const Vec3d& end : ends) along += dot(ray, (end - v) / length(end - v));
    const double sine = length(ray) / length(ends[cone[k]] - v) / length(ends[cone[(k + 1) % cone.size()]] - v);
    if (sine < 1e-6) return std::nullopt;
    out += ray * (along > 0 ? -1 : 1) / length(ray);
  }
  return out / length(out);
}

std::vector<Vec3d> ends_of(const MeshView& mesh, const SiteTable& table, std::uint32_t v, double& shortest) {
  std::vector<Vec3d> out;
  for (const Segment& ends : table.edges()) {
    if (ends[0] != v && ends[1] != v) continue;
    out.push_back(mesh.vertices[ends[0] == v ? ends[1] : ends[0]]);
    shortest = std::min(shortest, length(out.back() - mesh.vertices[v]));
  }
  return out;
}

/// Collects the edges and vertices that inner points near them are closest to.
class ClosestInside {
 public:
  explicit ClosestInside(const TriangleMesh& mesh)
      : table(mesh), mesh_(mesh), query_(mesh, {.sign = SignMode::normals}) {}

  void look_around(const Vec3d& place, double reach, int points) {
    std::vector<Vec3d> queries;
    for (int k = 0; k < points; ++k) queries.push_back(place + random_.in_ball() * reach);
    for (const ClosestPoint& found : query_.nearest(queries)) {
      // Distances that are pure rounding carry no information.
      if (!(found.distance < -1e-5 * reach)) continue;
      const Site site = table.site(found.site);
      if (site.kind == SiteKind::edge) edges.insert(site.index);
      if (site.kind == SiteKind::vertex) vertices.insert(site.index);
    }
  }
  void look_everywhere() {
    for (const Segment& ends : table.edges()) {
      const Vec3d& a = mesh_.vertices[ends[0]];
      const Vec3d& b = mesh_.vertices[ends[1]];
      const double size = length(b - a);
      look_around((a + b) * 0.5, 0.02 * size, 12);
      look_around(a, 0.02 * size, 12);
      look_around(b, 0.02 * size, 12);
    }
  }

  /// Expects that a point of a site is closest to an inner point beside it, up to rounding.
  void expect_closest(const Vec3d& of_site, const Vec3d& direction, double step) const {
    const ClosestPoint found = query_.nearest(of_site + direction * step);
    EXPECT_LT(found.distance, 0) << step;
    EXPECT_NEAR(-found.distance, step, 1e-7 * step);
  }

  SiteTable table;
  std::set<std::uint32_t> edges, vertices;

 private:
  const TriangleMesh& mesh_;
  ClosestPointQuery query_;
  Random random_{1};
};

void expect_sites_closest(const Solid& solid) {
  for (const SolidBody& body : solid.bodies()) {
    ClosestInside inside(body.mesh);
    const PolyhedronSites sites = polyhedron_sites(body.mesh, inside.table);
    inside.look_everywhere();
    const std::set<std::uint32_t> edges(sites.reflex_edges.begin(), sites.reflex_edges.end());
    const std::set<std::uint32_t> vertices(sites.reflex_vertices.begin(), sites.reflex_vertices.end());
    for (const std::uint32_t edge : inside.edges) {
      if (bend_of(body.mesh, sites.triangles_of[edge]) < 1e-6) continue;  // only rounding distinguishes edge and face
      EXPECT_TRUE(edges.contains(edge)) << "points inside are closest to edge " << edge;
    }
    for (const std::uint32_t v : inside.vertices) {
      EXPECT_TRUE(vertices.contains(v)) << "points inside are closest to vertex " << v;
    }
    // Each site is also closest to points inside.
    for (const std::uint32_t edge : edges) {
      const auto& [a, b] = inside.table.edges()[edge];
      const Vec3d middle = (body.mesh.vertices[a] + body.mesh.vertices[b]) * 0.5;
      const double size = length(body.mesh.vertices[b] - body.mesh.vertices[a]);
      inside.expect_closest(middle, inner_direction(body.mesh, sites.triangles_of[edge]), 1e-3 * size);
    }
    for (const std::uint32_t v : vertices) {
      double size = HUGE_VAL;
      const std::vector<Vec3d> ends = ends_of(body.mesh, inside.table, v, size);
      const std::optional<Vec3d> direction = inner_direction(body.mesh.vertices[v], ends);
      if (direction) inside.expect_closest(body.mesh.vertices[v], *direction, 1e-3 * size);
    }
  }
}

/// Tests each shape as generated, with many coplanar triangles in a face. Tests it also rotated, so that rounding bends
/// many faces.
TEST_P(PolyhedronSitesOfShapes, AreTheClosestSitesOfInnerPoints) {
  TriangleMesh mesh = make_shape(GetParam());
  if (mesh.triangles.empty()) GTEST_SKIP() << "no triangles";
  const Solid solid = Solid::of(mesh);
  if (solid.rule() != SolidRule::polyhedron) GTEST_SKIP() << "no polyhedron: " << solid.reason();
  expect_sites_closest(solid);
  for (Vec3d& p : mesh.vertices) p = test::turned(p);
  expect_sites_closest(Solid::of(mesh));
}

INSTANTIATE_TEST_SUITE_P(Shapes, PolyhedronSitesOfShapes, testing::ValuesIn(test::catalog_names()),
                         [](const auto& info) { return test::test_name(info.param); });

TEST(PolyhedronSites, RejectInvalidMeshes) {
  TriangleMesh open = make_box({});
  open.triangles.pop_back();
  EXPECT_THROW((void)sites_of(open), InvalidMesh);
  TriangleMesh flipped = make_box({});
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_THROW((void)sites_of(flipped), InvalidMesh);
  TriangleMesh needle = make_box({});
  needle.vertices.push_back((needle.vertices[0] + needle.vertices[1]) * 0.5);
  needle.triangles.push_back({0, 8, 1});
  EXPECT_THROW((void)sites_of(needle), InvalidMesh);
}

}  // namespace
}  // namespace blum
