// Proves that sheets are numbered by the patches between which they lie, then by their places, with crumbs last.
// Numbers of patches follow the order of faces and do not depend on the place of the mesh.
#include "blum/axis/order_sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"
#include "support/medial_check.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using detail::order_sheets;
using detail::order_sheets_as;
using detail::PatchNumbers;

using test::AxisRows;

PatchNumbers numbers_of(const TriangleMesh& mesh) {
  const Solid solid = Solid::of(mesh);
  PatchNumbers numbers(solid.sites());
  for (const SolidBody& body : solid.bodies()) {
    const SiteTable own(body.mesh);
    numbers.add({body.mesh, body.triangle_of, body.vertex_of,
                 [&](SiteId site) { return body.input_site(site, own, solid.sites()); }},
                own, {});
  }
  numbers.choose_anchors();
  return numbers;
}

/// The patch numbers of all sites.
std::vector<std::uint32_t> all_of(const PatchNumbers& numbers, const SiteTable& sites) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t s = 0; s < sites.size(); ++s) out.push_back(numbers.at(SiteId(s)));
  return out;
}

TEST(PatchNumbers, BoxHasOneForEachSide) {
  const TriangleMesh box = make_box({.size = {3, 2, 1}});
  const SiteTable sites(box);
  const PatchNumbers numbers = numbers_of(box);
  std::vector<std::uint32_t> found;
  for (std::uint32_t t = 0; t < box.triangles.size(); ++t) {
    const SiteId site = sites.id({SiteKind::face, t});
    EXPECT_FALSE(numbers.is_shared(site));
    found.push_back(numbers.at(site));
  }
  // Each side has two consecutive triangles. Flat parts have even numbers.
  EXPECT_EQ(found, (std::vector<std::uint32_t>{0, 0, 4, 4, 8, 8, 12, 12, 16, 16, 20, 20}));
  for (std::uint32_t e = 0; e < sites.edge_count(); ++e) {
    const SiteId site = sites.id({SiteKind::edge, e});
    std::vector<std::uint32_t> beside;
    for (std::uint32_t t = 0; t < box.triangles.size(); ++t) {
      const auto& edges = sites.triangle_edges()[t];
      if (std::find(edges.begin(), edges.end(), EdgeId(e)) != edges.end()) beside.push_back(found[t]);
    }
    ASSERT_EQ(beside.size(), 2U);
    EXPECT_EQ(numbers.at(site), std::min(beside[0], beside[1]));
    EXPECT_EQ(numbers.is_shared(site), beside[0] != beside[1]);
  }
}

TEST(PatchNumbers, DistinguishFlatAndRoundParts) {
  // None of the 300 sides is a large part of the surface, so all of them are one patch.
  const TriangleMesh rod = make_cylinder({.sides = 300});
  const SiteTable sites(rod);
  std::vector<std::uint32_t> found;
  const PatchNumbers numbers = numbers_of(rod);
  for (std::uint32_t t = 0; t < rod.triangles.size(); ++t) found.push_back(numbers.at(sites.id({SiteKind::face, t})));
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(std::count_if(found.begin(), found.end(), [](std::uint32_t n) { return n % 2 == 0; }), 2) << "both ends";
}

TEST(PatchNumbers, StayIfAMeshIsRotated) {
  for (const TriangleMesh& mesh : {make_bracket(), make_cylinder({}), make_bodies({})}) {
    const SiteTable sites(mesh);
    const PatchNumbers numbers = numbers_of(mesh);
    const Mat3 turn = test::rotation({1, 2, 3}, 17);
    const PatchNumbers turned = numbers_of(test::turned(mesh, turn));
    EXPECT_EQ(all_of(turned, sites), all_of(numbers, sites));
    ASSERT_EQ(numbers.anchors().size(), 4U);
    ASSERT_EQ(turned.anchors().size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT(length(turned.anchors()[k] - turn * numbers.anchors()[k]), 1e-12 * bounds(mesh).diagonal());
    }
  }
}

TEST(PatchNumbers, AbsentSitesHaveNone) {
  EXPECT_EQ(numbers_of(make_box({})).at(SiteId()), PatchNumbers::none);
  EXPECT_TRUE(PatchNumbers().is_empty());
}

/// A box whose sides have the numbers 0, 4, ... 20, and sheets made by hand.
class OrderSheets : public testing::Test {
 protected:
  /// Adds a sheet of adjacent squares. Each square lies between two sides of the box, given by their indices.
  void add_sheet(const Vec3d& at, double side, const std::vector<std::array<std::uint32_t, 2>>& between) {
    Vec3d corner = at;
    for (const auto& [first, second] : between) {
      const auto v = static_cast<std::uint32_t>(axis_.vertices.size());
      for (const Vec3d& step : {Vec3d{0, 0, 0}, Vec3d{side, 0, 0}, Vec3d{side, side, 0}, Vec3d{0, side, 0}}) {
        test::VertexRow& row = axis_.vertices.emplace_back();
        row.position = corner + step;
        row.footprints = {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}};
        row.sites = {sites_.id({SiteKind::face, 2 * first}), sites_.id({SiteKind::face, 2 * second})};
      }
      axis_.triangles.push_back({{v, v + 1, v + 2}, 90, count_});
      axis_.triangles.push_back({{v, v + 2, v + 3}, 90, count_});
      corner.x += side;
    }
    ++count_;
  }

  /// The new number of each sheet, in the order of addition.
  [[nodiscard]] std::vector<std::int32_t> ordered() const {
    Complex complex = axis_;
    order_sheets(complex, numbers_of(box_));
    return numbers_in(complex);
  }
  [[nodiscard]] std::vector<std::int32_t> numbers_in(const Complex& complex) const {
    std::vector<std::int32_t> out(count_, -1);
    const MedialView view(complex);
    for (std::size_t t = 0; t < axis_.triangles.size(); ++t) {
      std::int32_t& number = out[axis_.triangles[t].sheet];
      EXPECT_TRUE(number == -1 || number == view.sheet[t]) << "a sheet stays one";
      number = view.sheet[t];
    }
    return out;
  }

  TriangleMesh box_ = make_box({.size = {3, 2, 1}});
  SiteTable sites_{box_};
  AxisRows axis_;
  std::uint32_t count_ = 0;
};

TEST_F(OrderSheets, SortsByThePairOfPatches) {
  add_sheet({0, 0, 0}, 0.1, {{3, 4}});
  add_sheet({0.5, 0, 0}, 0.1, {{5, 0}});  // 0 and 5: the smaller number counts first
  add_sheet({0, 0.5, 0}, 0.1, {{2, 1}});
  EXPECT_EQ(ordered(), (std::vector<std::int32_t>{2, 0, 1}));
}

TEST_F(OrderSheets, SortsByTheSmallestPairWithALargePart) {
  add_sheet({0, 0, 0}, 0.1, {{2, 3}});
  add_sheet({0, 0.2, 0}, 0.1, {{4, 5}, {4, 5}, {1, 3}});          // half of the largest part: the pair counts
  add_sheet({0, 0.4, 0}, 0.1, {{4, 5}, {4, 5}, {4, 5}, {1, 2}});  // a third: it does not count
  EXPECT_EQ(ordered(), (std::vector<std::int32_t>{1, 0, 2}));
}

TEST_F(OrderSheets, SortsEqualPairsByPlace) {
  // The first vertex of the box is a corner. The sheet nearest to it comes first.
  const Vec3d corner = box_.vertices[0];
  for (const double part : {0.9, 0.1, 0.5}) add_sheet(corner - corner * (2 * part), 0.1, {{2, 3}});
  EXPECT_EQ(ordered(), (std::vector<std::int32_t>{2, 0, 1}));
}

TEST_F(OrderSheets, EquallyFarPlacesHaveAStableOrder) {
  const Vec3d at = box_.vertices[0];
  add_sheet(at - Vec3d{0.05, 0.05, 0} + Vec3d{1, 0, 0}, 0.1, {{2, 3}});
  add_sheet(at - Vec3d{0.05, 0.05, 0} + Vec3d{0, 1, 0}, 0.1, {{2, 3}});
  const std::vector<std::int32_t> first = ordered();
  // The result depends neither on the order of triangles nor on small offsets.
  std::swap(axis_.triangles[0], axis_.triangles[2]);
  std::swap(axis_.triangles[1], axis_.triangles[3]);
  EXPECT_EQ(ordered(), first);
  for (const double off : {0.01, -0.01}) {
    AxisRows moved = axis_;
    for (std::size_t v = 0; v < 4; ++v) moved.vertices[v].position.x += off;
    std::swap(axis_, moved);
    EXPECT_EQ(ordered(), first);
    std::swap(axis_, moved);
  }
}

TEST_F(OrderSheets, PutsCrumbsLast) {
  add_sheet({0, 0, 0}, 0.003, {{0, 1}});  // 0.9 thousandths
  add_sheet({0.2, 0, 0}, 0.1, {{3, 4}});
  add_sheet({0.5, 0, 0}, 0.004, {{2, 3}});  // 1.6 thousandths
  EXPECT_EQ(ordered(), (std::vector<std::int32_t>{2, 1, 0}));
}

TEST_F(OrderSheets, KeepsTheOrderWithoutPatches) {
  add_sheet({0, 0, 0}, 0.1, {{3, 4}});
  add_sheet({0, 1, 0}, 0.1, {{0, 1}});
  Complex complex = axis_;
  order_sheets(complex, {});
  EXPECT_EQ(numbers_in(complex), (std::vector<std::int32_t>{0, 1}));
}

TEST_F(OrderSheets, OrdersSheetsWithoutSites) {
  add_sheet({0, 0, 0}, 0.1, {{3, 4}});
  add_sheet({0, 1, 0}, 0.1, {{0, 1}});
  for (test::VertexRow& vertex : axis_.vertices) vertex.sites = {SiteId(), SiteId()};
  std::vector<std::int32_t> numbers = ordered();
  std::sort(numbers.begin(), numbers.end());
  EXPECT_EQ(numbers, (std::vector<std::int32_t>{0, 1}));
}

TEST_F(OrderSheets, FollowsTheNumbersOfAPreviousAxis) {
  add_sheet({0, 0, 0}, 0.1, {{0, 1}, {0, 1}, {0, 1}});
  add_sheet({0, 1, 0}, 0.1, {{0, 1}});
  Complex complex = axis_;
  // Two thirds of the first sheet were in sheet 7, which is a large enough part. The rest was in sheet 2. The second
  // sheet was in sheet 5.
  order_sheets_as(complex, std::vector<std::int32_t>{7, 7, 7, 7, 2, 2, 5, 5});
  EXPECT_EQ(numbers_in(complex), (std::vector<std::int32_t>{0, 1}));
  order_sheets_as(complex, std::vector<std::int32_t>{7, 7, 7, 7, 7, 2, 5, 5});
  EXPECT_EQ(numbers_in(complex), (std::vector<std::int32_t>{1, 0})) << "a sixth is none";
}

}  // namespace
}  // namespace blum
