// Proves that closest points of single sites equal those of the hierarchy, bit for bit, if a query is well within a
// site's domain. Other queries give none.
#include "blum/geometry/site_projection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

TEST(SiteProjection, IsTheClosestPointOfTheHierarchy) {
  for (const double scale : {1e-30, 1.0, 1e20}) {
    TriangleMesh mesh = make_organic({.frequency = 8});
    for (Vec3d& v : mesh.vertices) v = v * scale + Vec3d{3, -2, 1} * scale;
    const SiteTable sites(mesh);
    const Bvh bvh(mesh, sites);
    const SiteProjection projection(mesh, sites);
    const Box3 box = bounds(mesh);
    Random random(1);
    std::size_t counts[3] = {};
    for (int k = 0; k < 20000; ++k) {
      const Vec3d query = box.center() + random.in_ball() * box.diagonal();
      const NearestSite expected = *bvh.nearest(query);
      NearestSite found;
      if (!projection.project(expected.site, query, 1e-9 * scale, found)) continue;
      ++counts[static_cast<std::size_t>(sites.site(expected.site).kind)];
      ASSERT_EQ(found.site, expected.site);
      ASSERT_EQ(found.point, expected.point);
      ASSERT_EQ(found.distance, expected.distance);
    }
    EXPECT_GT(counts[0] + counts[1] + counts[2], 19900U);  // hardly any query is next to a border
    for (const std::size_t count : counts) EXPECT_GT(count, 500U);
  }
}

TEST(SiteProjection, IsNoneOutsideOfTheDomainAndNextToItsBorder) {
  const TriangleMesh box = make_box({});  // from -1/2 to 1/2
  const SiteTable sites(box);
  const SiteProjection projection(box, sites);
  const Bvh bvh(box, sites);
  const auto site_at = [&](const Vec3d& query) { return bvh.nearest(query)->site; };
  const SiteId corner = site_at({2, 2, 2});
  const SiteId edge = site_at({2, 2, 0.1});
  const SiteId face = site_at({2, 0.1, 0.3});
  ASSERT_EQ(sites.site(corner).kind, SiteKind::vertex);
  ASSERT_EQ(sites.site(edge).kind, SiteKind::edge);
  ASSERT_EQ(sites.site(face).kind, SiteKind::face);
  constexpr double margin = 1e-3;
  NearestSite found;
  EXPECT_TRUE(projection.project(corner, {0.502, 0.502, 0.502}, margin, found));
  EXPECT_FALSE(projection.project(corner, {0.502, 0.502, 0.5005}, margin, found));
  EXPECT_FALSE(projection.project(corner, {0.502, 0.502, 0.4}, margin, found));
  EXPECT_TRUE(projection.project(edge, {0.502, 0.502, 0.498}, margin, found));
  EXPECT_FALSE(projection.project(edge, {0.502, 0.502, 0.4995}, margin, found));
  EXPECT_FALSE(projection.project(edge, {0.502, 0.5005, 0.1}, margin, found));
  EXPECT_FALSE(projection.project(edge, {0.4, 0.6, 0.1}, margin, found));
  EXPECT_TRUE(projection.project(face, {2, 0.1, 0.3}, margin, found));
  EXPECT_FALSE(projection.project(face, {2, 0.1, 0.4995}, margin, found));
  EXPECT_FALSE(projection.project(face, {2, 0.1, 0.6}, margin, found));
}

/// Batches have any number of faces, edges, vertices and queries without a site, in any order.
TEST(SiteProjection, GivesTheSameForManyQueriesTogether) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  const SiteTable sites(mesh);
  const Bvh bvh(mesh, sites);
  const SiteProjection projection(mesh, sites);
  const Box3 box = bounds(mesh);
  const double margin = 1e-3 * box.diagonal();
  Random random(2);
  std::size_t certain = 0;
  std::size_t uncertain = 0;
  for (const std::size_t count : {0U, 1U, 7U, 8U, 63U, 64U, 65U, 700U}) {
    std::vector<SiteId> asked(count);
    std::vector<Vec3d> queries(count);
    std::vector<NearestSite> found(count);
    for (std::size_t k = 0; k < count; ++k) {
      queries[k] = box.center() + random.in_ball() * box.diagonal();
      asked[k] = k % 10 == 3 ? SiteId::none() : bvh.nearest(queries[k])->site;
    }
    projection.project(asked, queries, margin, found);
    for (std::size_t k = 0; k < count; ++k) {
      NearestSite alone;
      const bool is_certain = asked[k].has_value() && projection.project(asked[k], queries[k], margin, alone);
      ASSERT_EQ(found[k].site, is_certain ? asked[k] : SiteId::none());
      if (asked[k].has_value()) ++(is_certain ? certain : uncertain);
      if (!is_certain) continue;
      ASSERT_EQ(found[k].point, alone.point);
      ASSERT_EQ(found[k].distance, alone.distance);
    }
  }
  EXPECT_GT(certain, 500U);
  EXPECT_GT(uncertain, 20U);  // next to a border
}

/// Edges with three triangles and triangles without a plane have no known domain.
TEST(SiteProjection, IsNoneIfTheDomainIsUnknown) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}, {0.5, 0, -1}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {5, 6, 7}};
  const SiteTable sites(mesh);
  const SiteProjection projection(mesh, sites);
  NearestSite found;
  EXPECT_FALSE(projection.project(sites.id({SiteKind::edge, 0}), {0.5, 0, 1}, 1e-6, found));
  EXPECT_FALSE(projection.project(sites.id({SiteKind::face, 3}), {4, 1, 0}, 1e-6, found));
  mesh.points = {5};
  EXPECT_TRUE(projection.project(SiteId(2), {0.5, 3, 0}, 1e-6, found));
}

}  // namespace
}  // namespace blum
