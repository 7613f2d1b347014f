// Proves that signed results warn of meshes that face the wrong way, and of grids without a node inside. Closed meshes
// get their inside however their triangles face. Each warning is tested with its smallest case. Valid input causes no
// warning.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;

TriangleMesh reversed(TriangleMesh mesh) {
  mesh.triangles = reversed_triangles(mesh.triangles);
  return mesh;
}

TriangleMesh both(TriangleMesh mesh, const TriangleMesh& other) {
  append(mesh, other);
  return mesh;
}

const GridSpec& grid() {
  static const GridSpec spec = grid_in({{-1, -1, -1}, {3, 3, 3}}, 12);
  return spec;
}

std::vector<Warning> warnings_of(const MeshView& mesh, const FieldOptions& options = {}) {
  return distance_field(mesh, grid(), options).warnings;
}

/// Returns the text of the only warning.
std::string text_of(const MeshView& mesh, WarningCode code, const FieldOptions& options = {}) {
  const std::vector<Warning> found = warnings_of(mesh, options);
  EXPECT_EQ(found.size(), 1U);
  if (found.size() != 1) return {};
  EXPECT_EQ(found[0].code, code);
  return found[0].text;
}

/// The remaining triangles still put nodes inside, but signs near the reversed triangle are wrong.
TEST(FieldWarnings, ReportTrianglesThatFaceDifferentWaysEvenIfNodesAreInside) {
  TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  std::swap(box.triangles[0][0], box.triangles[0][1]);
  const Field field = distance_field(box, grid(), {.sign = SignMode::winding});
  ASSERT_TRUE(std::any_of(field.distance.begin(), field.distance.end(), [](float d) { return d < 0; }));
  const std::string text = text_of(box, WarningCode::facing, {.sign = SignMode::winding});
  EXPECT_EQ(text.rfind("3 edges lie between triangles that face different ways, so signs near these", 0), 0U) << text;
}

TEST(SignWarnings, NeedNoGrid) {
  const TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  EXPECT_TRUE(ClosestPointQuery(box).warnings().empty());
  EXPECT_TRUE(ClosestPointQuery(reversed(box), {.sign = SignMode::none}).warnings().empty());
  const ClosestPointQuery query(reversed(box), {.sign = SignMode::winding});
  ASSERT_EQ(query.warnings().size(), 1U);
  EXPECT_EQ(query.warnings()[0].code, WarningCode::facing);
  EXPECT_TRUE(query.warnings()[0].text.starts_with("the mesh is inside out"));
}

/// A closed mesh, and the same mesh with some of its triangles reversed.
struct Turned {
  std::string name;
  TriangleMesh right, wrong;
  std::string repair;
};

std::vector<Turned> turned_meshes() {
  const TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  const TriangleMesh other = box_between({2.2, 0, 0}, {2.9, 1, 1});
  const TriangleMesh hollow = both(box, reversed(box_between({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5})));
  TriangleMesh torn = both(box, other);
  for (const std::size_t t : {1U, 4U, 7U, 13U}) std::swap(torn.triangles[t][1], torn.triangles[t][2]);
  TriangleMesh torn_inwards = reversed(box);
  std::swap(torn_inwards.triangles[0][1], torn_inwards.triangles[0][2]);
  return {{"InsideOut", box, reversed(box), "1 shell was reversed"},
          {"InsideOutWithVoid", hollow, reversed(hollow), "2 shells were reversed"},
          {"OneOfTwoBodies", both(box, other), both(box, reversed(other)), "1 shell was reversed"},
          {"SomeTrianglesOfEach", both(box, other), torn, "4 triangles were reversed"},
          {"OneTriangleAndTheShell", box, torn_inwards, "1 triangle and 1 shell were reversed"}};
}

TEST(SignWarnings, ClosedMeshesGetTheirInsideHoweverTrianglesFace) {
  Random random(46);
  std::vector<Vec3d> queries(500);
  for (Vec3d& q : queries) q = Vec3d{1, 1, 1} + random.in_cube() * 4.0 - Vec3d{2, 2, 2};
  for (const Turned& turned : turned_meshes()) {
    SCOPED_TRACE(turned.name);
    const Field right = distance_field(turned.right, grid());
    const Field wrong = distance_field(turned.wrong, grid());
    EXPECT_TRUE(right.warnings.empty());
    ASSERT_EQ(wrong.warnings.size(), 1U);
    EXPECT_EQ(wrong.warnings[0].text, "parts of the mesh face the wrong way, and for the signs, " + turned.repair);
    EXPECT_EQ(wrong.sign_rule, SignRule::normals);
    EXPECT_TRUE(wrong.sign_reason.ends_with(", after " + turned.repair)) << wrong.sign_reason;
    for (std::size_t n = 0; n < right.distance.size(); ++n) {
      ASSERT_NEAR(wrong.distance[n], right.distance[n], 1e-6);
      ASSERT_EQ(std::signbit(wrong.distance[n]), std::signbit(right.distance[n]));
    }
    const ClosestPointQuery of_right(turned.right);
    ClosestPointQuery of_wrong(turned.wrong);
    EXPECT_EQ(of_wrong.warnings(), wrong.warnings);
    for (const Vec3d& q : queries) {
      ASSERT_NEAR(of_wrong.nearest(q).distance, of_right.nearest(q).distance, 1e-12);
      ASSERT_EQ(of_wrong.nearest(q).site, of_right.nearest(q).site);
    }
    // Moved vertices change nothing about the repair: it starts from the given triangles again.
    of_wrong.refit(turned.wrong.vertices);
    EXPECT_EQ(of_wrong.warnings(), wrong.warnings);
    for (const Vec3d& q : queries) ASSERT_NEAR(of_wrong.nearest(q).distance, of_right.nearest(q).distance, 1e-12);
  }
}

/// Returns the mesh without common vertices of triangles.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh half_flipped(TriangleMesh mesh, std::uint64_t seed) {
  Random random(seed);
  for (Triangle& t : mesh.triangles) {
    if (random.in_cube().x < 0.5) std::swap(t[1], t[2]);
  }
  return mesh;
}

TriangleMesh every_other_flipped(TriangleMesh mesh, std::size_t step = 2) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += step) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return mesh;
}

/// Meshes that are not closed, or whose shells cross. Each has the same distances as the mesh that faces outwards.
std::vector<Turned> turned_unclosed_meshes() {
  const TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  const TriangleMesh across = box_between({1, 1, 1}, {2.9, 2.9, 2.9});
  TriangleMesh sheet;
  sheet.vertices = {{2.5, 0, 0}, {2.5, 1, 0}, {2.5, 0, 1}};
  sheet.triangles = {{0, 1, 2}};
  const TriangleMesh other = box_between({2.2, 0, 0}, {2.9, 1, 1});
  TriangleMesh lidless = box;
  lidless.triangles.resize(10);
  const TriangleMesh sphere = make_sphere({.frequency = 4});
  TriangleMesh holed = sphere;
  holed.triangles.pop_back();
  TriangleMesh doubled = box;
  doubled.triangles.insert(doubled.triangles.end(), box.triangles.begin(), box.triangles.end());
  const TriangleMesh crossing = both(box, across);
  TriangleMesh two_holes = holed;
  two_holes.triangles.erase(two_holes.triangles.begin() + 7);
  return {{"WithoutLid", lidless, reversed(lidless), "1 part was reversed"},
          {"HalfFlippedWithoutLid", lidless, every_other_flipped(lidless), "5 triangles were reversed"},
          {"MostlyFlippedWithoutLid", lidless, every_other_flipped(reversed(lidless), 3),
           "4 triangles and 1 part were reversed"},
          {"HalfFlippedWithAHole", holed, half_flipped(holed, 4), ""},
          {"HalfFlippedWithTwoHoles", two_holes, half_flipped(two_holes, 5), ""},
          {"HalfFlippedSoupWithAHole", soup_of(holed), soup_of(half_flipped(holed, 6)), ""},
          {"HalfFlippedBesideAnotherWithoutLid", both(lidless, other), both(every_other_flipped(lidless), other),
           "5 triangles were reversed"},
          {"SphereWithAHole", holed, reversed(holed), "1 part was reversed"},
          {"BoxAndSheet", both(box, sheet), both(reversed(box), sheet), "1 shell was reversed"},
          {"Doubled", doubled, reversed(doubled), "1 part was reversed"},
          {"Soup", soup_of(sphere), soup_of(reversed(sphere)), "1 shell was reversed"},
          {"HalfFlippedSoup", soup_of(sphere), soup_of(half_flipped(sphere, 1)), ""},
          {"SecondOfTwoThatCross", crossing, both(box, reversed(across)), "1 shell was reversed"},
          {"FirstOfTwoThatCross", crossing, both(reversed(box), across), "1 shell was reversed"},
          {"BothThatCross", crossing, both(reversed(box), reversed(across)), "2 shells were reversed"},
          {"HalfFlippedThatCross", both(sphere, across), both(half_flipped(sphere, 2), half_flipped(across, 3)), ""}};
}

TEST(SignWarnings, UnclosedAndCrossingMeshesGetTheirInside) {
  Random random(47);
  std::vector<Vec3d> queries(500);
  for (Vec3d& q : queries) q = Vec3d{1, 1, 1} + random.in_cube() * 4.0 - Vec3d{2, 2, 2};
  for (const Turned& turned : turned_unclosed_meshes()) {
    SCOPED_TRACE(turned.name);
    const ClosestPointQuery of_right(turned.right);
    const ClosestPointQuery of_wrong(turned.wrong);
    EXPECT_TRUE(of_right.warnings().empty());
    ASSERT_EQ(of_wrong.warnings().size(), 1U);
    EXPECT_EQ(of_wrong.warnings()[0].code, WarningCode::facing);
    EXPECT_TRUE(of_wrong.warnings()[0].text.ends_with(turned.repair)) << of_wrong.warnings()[0].text;
    std::size_t inside = 0;
    for (const Vec3d& q : queries) {
      const double distance = of_right.nearest(q).distance;
      inside += distance < 0 ? 1 : 0;
      ASSERT_NEAR(of_wrong.nearest(q).distance, distance, 1e-12);
    }
    EXPECT_GT(inside, 0U);
    const ClosestPointQuery as_given(turned.wrong, {.sign = SignMode::winding});
    EXPECT_FALSE(as_given.warnings().empty());
  }
}

/// Corners of soups from STL files may differ in the last bit of single precision. Such soups are examined as if their
/// corners were joined. Their positions, and so their distances, stay the same.
TEST(SignWarnings, SoupsWithRoundedCornersGetTheirInside) {
  for (const Vec3d& at : {Vec3d{0, 0, 0}, Vec3d{700, -300, 20}}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const TriangleMesh sphere = test::moved(make_sphere({.frequency = 4}), 1, at);
      const TriangleMesh soup = soup_of(sphere);
      for (const TriangleMesh& turned : {soup_of(reversed(sphere)), soup_of(half_flipped(sphere, seed))}) {
        TriangleMesh rounded = turned;
        Random random(seed);
        for (Vec3d& v : rounded.vertices) {
          for (double* x : {&v.x, &v.y, &v.z}) {
            const auto single = static_cast<float>(*x);
            *x = std::nextafterf(single, random.in_cube().x < 0.5 ? -1e9F : 1e9F);
          }
        }
        const ClosestPointQuery right(soup);
        const ClosestPointQuery found(rounded);
        ASSERT_EQ(found.warnings().size(), 1U);
        EXPECT_EQ(found.warnings()[0].code, WarningCode::facing);
        for (int k = 0; k < 200; ++k) {
          const Vec3d q = at + random.in_cube() * 4.0 - Vec3d{2, 2, 2};
          const double distance = right.nearest(q).distance;
          if (std::abs(distance) < 1e-3) continue;
          ASSERT_NEAR(found.nearest(q).distance, distance, 1e-3);
        }
      }
    }
  }
}

/// A Moebius strip has no consistent orientation. Its triangles stay as they are, with a warning.
TEST(SignWarnings, OneSidedSheetsAreNotReversed) {
  TriangleMesh strip;
  constexpr std::uint32_t steps = 12;
  for (std::uint32_t k = 0; k < steps; ++k) {
    const double turn = 2 * 3.141592653589793 * k / steps;
    for (const double side : {-0.4, 0.4}) {
      const double radius = 1 + side * std::cos(turn / 2);
      strip.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), side * std::sin(turn / 2)});
    }
    const bool is_last = k + 1 == steps;
    const std::uint32_t a = 2 * k;
    const std::uint32_t next = is_last ? 1 : a + 2;
    const std::uint32_t after = is_last ? 0 : a + 3;
    strip.triangles.push_back({a, next, a + 1});
    strip.triangles.push_back({a + 1, next, after});
  }
  const ClosestPointQuery automatic(strip);
  const ClosestPointQuery as_given(strip, {.sign = SignMode::winding});
  ASSERT_EQ(automatic.warnings().size(), 1U);
  EXPECT_NE(automatic.warnings()[0].text.find("face different ways"), std::string::npos);
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    const Vec3d q = random.in_cube();
    ASSERT_EQ(automatic.nearest(q).distance, as_given.nearest(q).distance);
  }
}

/// Separate triangles surround no volume, so the winding numbers of the given mesh decide.
TEST(SignWarnings, SeparateTrianglesAreNotReversed) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SoupOptions options;
    options.triangles = 10 * seed;
    options.seed = seed;
    const TriangleMesh soup = make_soup(options);
    const ClosestPointQuery automatic(soup);
    const ClosestPointQuery as_given(soup, {.sign = SignMode::winding});
    EXPECT_TRUE(automatic.warnings().empty());
    EXPECT_TRUE(as_given.warnings().empty());
    Random random(seed);
    for (int k = 0; k < 100; ++k) {
      const Vec3d q = random.in_cube();
      ASSERT_EQ(automatic.nearest(q).distance, as_given.nearest(q).distance);
    }
  }
}

/// Voids, sheets and shells that cross face the right way.
TEST(SignWarnings, AreEmptyForOpenAndCrossingSolidsWithVoids) {
  const TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  const TriangleMesh hollow = both(box, reversed(box_between({0.5, 0.5, 0.5}, {0.9, 0.9, 0.9})));
  TriangleMesh open = hollow;
  open.triangles.erase(open.triangles.begin());
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const TriangleMesh& mesh :
       {open, both(hollow, box_between({1, 1, 1}, {2.9, 2.9, 2.9})), soup_of(hollow), sheet, reversed(sheet)}) {
    for (const SignMode sign : {SignMode::automatic, SignMode::winding}) {
      EXPECT_TRUE(ClosestPointQuery(mesh, {.sign = sign}).warnings().empty());
    }
    const ClosestPointQuery automatic(mesh);
    EXPECT_EQ(automatic.sign_reason().find("reversed"), std::string::npos);
  }
}

TEST(FieldWarnings, AreEmptyForABox) {
  const TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  for (const SignMode sign : {SignMode::automatic, SignMode::normals, SignMode::winding, SignMode::none}) {
    EXPECT_TRUE(warnings_of(box, {.sign = sign}).empty());
  }
  EXPECT_TRUE(warnings_of(reversed(box), {.sign = SignMode::none}).empty()) << "nothing is asked about the inside";
  TriangleMesh open = box;
  open.triangles.pop_back();
  EXPECT_TRUE(warnings_of(open).empty()) << "winding numbers know its inside";
}

TEST(FieldWarnings, OfABoxInsideOutThatIsUsedAsItIs) {
  const TriangleMesh inwards = reversed(box_between({0, 0, 0}, {2, 2, 2}));
  EXPECT_TRUE(text_of(inwards, WarningCode::facing, {.sign = SignMode::normals}).starts_with("the mesh is inside out"));
  EXPECT_TRUE(text_of(inwards, WarningCode::nothing_inside, {.sign = SignMode::winding})
                  .starts_with("no node is inside: the mesh is inside out"));
}

TEST(FieldWarnings, OfAVoidThatFacesAsItsSolidUnlessShellsCross) {
  const TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  const TriangleMesh nested = both(box, box_between({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  EXPECT_TRUE(text_of(nested, WarningCode::facing).starts_with("parts of the mesh face the wrong way"));
  const TriangleMesh crossing = both(box, box_between({1, 1, 1}, {2.5, 2.5, 2.5}));
  EXPECT_TRUE(warnings_of(crossing).empty());
}

TEST(FieldWarnings, OfGridsWithoutANodeInside) {
  EXPECT_EQ(text_of(box_between({7, 7, 7}, {8, 8, 8}), WarningCode::nothing_inside),
            "no node is inside: the shape encloses nothing, lies outside the grid, or is too thin for its spacing");
  TriangleMesh fold;
  fold.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  fold.triangles = {{0, 1, 2}, {1, 2, 3}};
  EXPECT_EQ(text_of(fold, WarningCode::nothing_inside),
            "no node is inside: 1 edge lies between triangles that face different ways, so signs near these edges may "
            "be wrong; orient the mesh first, with oriented_mesh() or `blum clean`");
}

}  // namespace
}  // namespace blum
