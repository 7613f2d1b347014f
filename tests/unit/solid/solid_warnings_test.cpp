// Proves that a solid warns of reversed triangles and resolved crossings, and that a correct mesh causes no warning.
#include "blum/solid/solid_warnings.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "blum/core/warning.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;

TEST(SolidWarnings, ABoxHasNone) {
  EXPECT_TRUE(solid_warnings(Solid::of(box_between({0, 0, 0}, {1, 1, 1}))).empty());
}

TEST(SolidWarnings, ReportReversedShellsAndTriangles) {
  TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  mesh.triangles = reversed_triangles(mesh.triangles);
  const Warning shell{WarningCode::reversed_shells, "1 shell faces the wrong way and was reversed"};
  EXPECT_EQ(solid_warnings(Solid::of(mesh)), std::vector{shell});
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  const Warning triangle{WarningCode::reversed_shells,
                         "1 triangle faces another way than neighbouring triangles and was reversed"};
  EXPECT_EQ(solid_warnings(Solid::of(mesh)), (std::vector{triangle, shell}));
  EXPECT_EQ(reversal_warnings(0, 2)[0].text, "2 shells face the wrong way and were reversed");
  EXPECT_EQ(reversal_warnings(3, 0)[0].text,
            "3 triangles face another way than neighbouring triangles and were reversed");
}

TEST(SolidWarnings, ReportCrossings) {
  TriangleMesh mesh = box_between({0, 0, 0}, {2, 2, 2});
  append(mesh, box_between({1, 1, 1}, {3, 3, 3}));
  const Solid solid = Solid::of(mesh);
  EXPECT_EQ(solid_warnings(solid),
            (std::vector<Warning>{{WarningCode::crossings_removed,
                                   solid.reason() + "; sites are those of its surface without the crossings"}}));
}

}  // namespace
}  // namespace blum
