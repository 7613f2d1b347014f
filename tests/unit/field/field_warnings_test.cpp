// Proves that fields warn of meshes that face the wrong way and of grids without a node inside. Each warning is tested
// with its smallest case. Valid input causes no warning.
#include "blum/field/field_warnings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/warning.hpp"
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
  return field_warnings(distance_field(mesh, grid(), options), mesh);
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
  EXPECT_EQ(text.rfind("3 edges lie between triangles that face different ways, so signs near them", 0), 0U) << text;
}

TEST(SignWarnings, NeedNoGrid) {
  const TriangleMesh box = box_between({0, 0, 0}, {2, 2, 2});
  EXPECT_TRUE(sign_warnings(box, SignRule::normals).empty());
  EXPECT_TRUE(sign_warnings(reversed(box), SignRule::none).empty());
  const std::vector<Warning> found = sign_warnings(reversed(box), SignRule::winding);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found, warnings_of(reversed(box)));
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

TEST(FieldWarnings, OfABoxInsideOut) {
  const TriangleMesh inwards = reversed(box_between({0, 0, 0}, {2, 2, 2}));
  for (const SignMode sign : {SignMode::automatic, SignMode::normals, SignMode::winding}) {
    EXPECT_TRUE(text_of(inwards, WarningCode::facing, {.sign = sign}).starts_with("the mesh is inside out"));
  }
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
            "no node is inside: 1 edge lies between triangles that face different ways, so their winding numbers "
            "cancel; orient the mesh first, with oriented_mesh() or `blum clean`");
}

TEST(FieldWarnings, AreTheSameWithAGivenOrientation) {
  for (const TriangleMesh& mesh :
       {box_between({0, 0, 0}, {2, 2, 2}), reversed(box_between({0, 0, 0}, {2, 2, 2})), test::flat_sheet(2)}) {
    const Field field = distance_field(mesh, grid());
    EXPECT_EQ(field_warnings(field, mesh, orientation(mesh, SiteTable(mesh))), field_warnings(field, mesh));
  }
}

}  // namespace
}  // namespace blum
