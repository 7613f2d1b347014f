// Proves that signs about the sites of a polyhedron equal those of rational arithmetic, at random points and on every
// kind of border and wall. The closest labels include all ties and match those of a search.
#include "voronoi/site_labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <set>
#include <string>

#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/solid/solid.hpp"
#include "support/labelled_solid.hpp"
#include "support/mesh_places.hpp"
#include "support/shape_names.hpp"
#include "voronoi/bounded_number.hpp"

namespace blum {
namespace {

using boost::multiprecision::cpp_rational;
using test::LabelledSolid;
using voronoi::BoundedNumber;
using voronoi::Label;

std::set<std::uint32_t> closest_sites(const LabelledSolid& solid, const Vec3d& q) {
  std::set<std::uint32_t> out;
  for (const Label& label : solid.labels.closest_labels(q)) out.insert(solid.labels.site_of(label));
  return out;
}

TEST(BoundedNumber, BoundsHoldRationalNumbers) {
  Random random(1);
  for (int round = 0; round < 20000; ++round) {
    const auto next = [&] {
      const double x = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-12, 12));
      return round % 5 == 0 ? std::round(x * 8) / 8 : x;
    };
    const std::array<double, 6> x{next(), next(), next(), next(), next(), next()};
    const auto value = [&]<class Number>(const Number&) -> Number {
      const Number a = Number(x[0]) * Number(x[1]) - Number(x[2]) * Number(x[3]);
      const Number b = (Number(x[4]) + Number(x[5])) * a - Number(x[0]) * a;
      return b * (Number(x[1]) - a) - b * Number(x[1]) + a * b;  // 0
    };
    const auto part = [&]<class Number>(const Number&) -> Number {
      return Number(x[0]) * Number(x[1]) - Number(x[2]) * Number(x[3]) + Number(x[4]) * Number(x[5]);
    };
    const int zero = value(BoundedNumber()).sign();
    EXPECT_TRUE(zero == 0 || zero == BoundedNumber::unknown);
    const int sign = part(BoundedNumber()).sign();
    if (sign == BoundedNumber::unknown) continue;
    ASSERT_EQ(sign, part(cpp_rational()).sign());
  }
  const BoundedNumber tiny(1e-200);
  EXPECT_EQ((tiny * tiny).sign(), BoundedNumber::unknown) << "lost below the normal range";
  EXPECT_EQ((tiny * BoundedNumber(0.0)).sign(), 0);
  const BoundedNumber huge(1e200);
  EXPECT_EQ((huge * huge).sign(), BoundedNumber::unknown) << "overflow";
}

TEST(SiteLabels, TiesOfABox) {
  const LabelledSolid box(test::box_between({-1, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(closest_sites(box, {0, 0, 0}).size(), 6U);
  EXPECT_EQ(closest_sites(box, {0.5, 0.5, 0.5}).size(), 3U);
  EXPECT_EQ(closest_sites(box, {0.5, 0.5, 0.25}).size(), 2U);
  EXPECT_EQ(closest_sites(box, {0.5, std::nextafter(0.5, 1.0), 0.25}).size(), 1U);
  EXPECT_EQ(box.labels.site_count(), 6U);
}

TEST(SiteLabels, TiesBetweenFacesEdgesAndVertices) {
  const LabelledSolid solid(test::box_with_void());
  ASSERT_EQ(solid.labels.site_count(), 32U);
  // Where the domains of a face and its edge meet, both are closest. At the vertex, a second edge and the vertex tie as
  // well.
  EXPECT_EQ(closest_sites(solid, {1.25, 1, 0.125}).size(), 2U);
  EXPECT_EQ(closest_sites(solid, {1.25, 1, 1}).size(), 4U) << "a face, two edges and a vertex";
  EXPECT_EQ(closest_sites(solid, {1.25, 1.25, 1.25}).size(), 1U) << "the vertex";
  EXPECT_EQ(closest_sites(solid, {1.25, 1.25, 0.5}).size(), 1U) << "an edge";
  EXPECT_EQ(closest_sites(solid, {1.5, 0.25, 0.25}).size(), 2U) << "both walls";
  const voronoi::SignCounts counts = solid.labels.counts();
  EXPECT_GT(counts.exact, 0U);
  EXPECT_LT(counts.exact, counts.all / 2);
}

/// Compares two distances in rational arithmetic, without a filter.
int slow_comparison(const LabelledSolid& solid, const Label& a, const Label& b, const Vec3d& q) {
  using Q = cpp_rational;
  using Point = std::array<Q, 3>;
  const auto exact = [](const Vec3d& v) { return Point{Q(v.x), Q(v.y), Q(v.z)}; };
  const auto minus = [](const Point& u, const Point& v) { return Point{u[0] - v[0], u[1] - v[1], u[2] - v[2]}; };
  const auto inner = [](const Point& u, const Point& v) -> Q { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  const auto squared = [&](const Label& label) -> Q {
    const Point at = exact(q);
    if (label.kind == SiteKind::vertex) {
      const Point from = minus(at, exact(solid.mesh.vertices[label.index]));
      return inner(from, from);
    }
    // The projection onto the span of one or two sides, by their Gram matrix.
    std::vector<Point> sides;
    Point corner;
    if (label.kind == SiteKind::edge) {
      const auto [u, v] = solid.table.edges()[label.index];
      corner = exact(solid.mesh.vertices[u]);
      sides = {minus(exact(solid.mesh.vertices[v]), corner)};
    } else {
      const auto [u, v, w] = triangle_corners(solid.mesh, label.index);
      corner = exact(u);
      sides = {minus(exact(v), corner), minus(exact(w), corner)};
    }
    const Point from = minus(at, corner);
    if (sides.size() == 1) {
      const Q along = inner(from, sides[0]);
      return inner(from, from) - along * along / inner(sides[0], sides[0]);
    }
    const Q aa = inner(sides[0], sides[0]);
    const Q ab = inner(sides[0], sides[1]);
    const Q bb = inner(sides[1], sides[1]);
    const Q fa = inner(from, sides[0]);
    const Q fb = inner(from, sides[1]);
    return inner(from, from) - (fa * fa * bb - 2 * fa * fb * ab + fb * fb * aa) / (aa * bb - ab * ab);
  };
  return Q(squared(a) - squared(b)).sign();
}

TEST(SiteLabels, ComparisonsAreThoseOfRationalNumbers) {
  Random random(3);
  for (const TriangleMesh& mesh : {test::box_with_void(), test::turned(test::box_with_void()), make_star({})}) {
    const LabelledSolid solid(mesh);
    const std::vector<Label>& all = solid.labels.all();
    for (int round = 0; round < 3000; ++round) {
      const Label& a = all[random.below(all.size())];
      const Label& b = all[random.below(all.size())];
      Vec3d q = random.in_cube() * 4.0 - Vec3d{2, 2, 2};
      // Half of the points lie on a lattice, where many distances are equal.
      if (round % 2 == 0) q = {std::round(q.x * 4) / 4, std::round(q.y * 4) / 4, std::round(q.z * 4) / 4};
      ASSERT_EQ(solid.labels.compare_distances(a, b, q), slow_comparison(solid, a, b, q)) << round;
    }
  }
}

class SiteLabelsOfShapes : public testing::TestWithParam<std::string> {};

/// At random inner points, the site that a search in doubles finds is among the exact ones, or ties with them in
/// doubles.
TEST_P(SiteLabelsOfShapes, ClosestAreThoseOfASearch) {
  TriangleMesh mesh = make_shape(GetParam());
  if (mesh.triangles.empty()) GTEST_SKIP() << "no triangles";
  for (Vec3d& p : mesh.vertices) p = test::turned(p);
  const Solid found = Solid::of(mesh);
  if (found.rule() != SolidRule::polyhedron) GTEST_SKIP() << "no polyhedron: " << found.reason();
  const LabelledSolid solid(found.bodies()[0].mesh);
  const ClosestPointQuery query(solid.mesh, {.sign = SignMode::normals});
  const Box3 box = bounds(solid.mesh);
  Random random(4);
  const std::size_t wanted = std::max<std::size_t>(4, 400'000 / solid.labels.all().size());
  std::size_t asked = 0;
  for (int round = 0; round < 20000 && asked < std::min<std::size_t>(wanted, 300); ++round) {
    const Vec3d t = random.in_cube();
    const Vec3d size = box.size();
    const Vec3d q = box.lower + Vec3d{size.x * t.x, size.y * t.y, size.z * t.z};
    const ClosestPoint closest = query.nearest(q);
    if (!(closest.distance < 0)) continue;
    ++asked;
    const std::vector<Label> labels = solid.labels.closest_labels(q);
    ASSERT_FALSE(labels.empty());
    const Site site = solid.table.site(closest.site);
    const bool is_same = std::any_of(labels.begin(), labels.end(), [&](const Label& label) {
      return label == Label{site.kind, site.index} || (label.kind == SiteKind::face && site.kind == SiteKind::edge &&
                                                       solid.sites.turn[site.index] == EdgeTurn::flat);
    });
    if (is_same) continue;
    // Then both are equally far, up to rounding.
    double gap = 0;
    if (labels[0].kind == SiteKind::face) {
      const auto [a, b, c] = triangle_corners(solid.mesh, labels[0].index);
      const Vec3d normal = cross(b - a, c - a);
      gap = std::abs(std::abs(dot(normal, q - a)) / length(normal) + closest.distance);
    } else if (labels[0].kind == SiteKind::vertex) {
      gap = std::abs(length(q - solid.mesh.vertices[labels[0].index]) + closest.distance);
    } else {
      const auto [a, b] = solid.table.edges()[labels[0].index];
      const Vec3d along = solid.mesh.vertices[b] - solid.mesh.vertices[a];
      gap = std::abs(length(cross(along, q - solid.mesh.vertices[a])) / length(along) + closest.distance);
    }
    EXPECT_LT(gap, 1e-12 * box.diagonal());
  }
  EXPECT_GT(asked, 3U);
}

INSTANTIATE_TEST_SUITE_P(Shapes, SiteLabelsOfShapes, testing::ValuesIn(test::catalog_names()),
                         [](const auto& info) { return test::test_name(info.param); });

}  // namespace
}  // namespace blum
