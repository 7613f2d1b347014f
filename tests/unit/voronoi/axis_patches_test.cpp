// Proves that the patches on both sides of an axis are those of the exact diagram, which knows them by construction.
#include "blum/voronoi/axis_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "blum/axis/collapse_axis.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

double area_of(const Complex& axis, std::size_t t) {
  const auto& [a, b, c] = axis.triangles[t];
  return 0.5 * length(cross(axis.positions[b] - axis.positions[a], axis.positions[c] - axis.positions[a]));
}

/// Returns the share of the area of an exact axis on which add_axis_patch_columns() finds the patches that the diagram
/// has.
double share_found(const TriangleMesh& mesh, double theta, const VoronoiPatchOptions& options) {
  const Solid solid = Solid::of(mesh);
  VoronoiOptions how;
  how.part = VoronoiPart::medial_axis;
  how.method = VoronoiMethod::traced;
  VoronoiComplex walls = voronoi_complex(solid, how);
  const std::vector<VoronoiSite> sites = voronoi_sites(solid.surface().mesh, walls.report);
  add_patch_columns(walls.complex, voronoi_patches(solid.surface().mesh, sites, options));
  const Complex exact = collapse_axis(walls.complex, theta);
  Complex searched = exact;
  add_axis_patch_columns(searched, solid, options);
  double same = 0;
  double all = 0;
  for (std::size_t t = 0; t < exact.triangles.size(); ++t) {
    bool is_same = true;
    for (const std::string_view name : medial_columns::patches) {
      is_same = is_same && exact.triangle_columns.get<std::int32_t>(name)[t] ==
                               searched.triangle_columns.get<std::int32_t>(name)[t];
    }
    all += area_of(exact, t);
    if (is_same) same += area_of(exact, t);
  }
  return all > 0 ? same / all : 0;
}

TEST(AxisPatches, AreThoseOfTheExactDiagram) {
  for (const TriangleMesh& mesh : {make_box({{3, 2, 1}}), make_wedge()}) {
    for (const double angle : {0.0, 30.0}) EXPECT_DOUBLE_EQ(share_found(mesh, 10, {angle}), 1);
    EXPECT_DOUBLE_EQ(share_found(test::turned(mesh), 1, {30}), 1);
  }
  EXPECT_GT(share_found(make_gear({.teeth = 6, .openings = 3}), 10, {30}), 0.9999)
      << "rounding decides along the axis of its bore";
  EXPECT_GT(share_found(make_bracket({.holes = 1, .hole_segments = 12}), 60, {0}), 0.9999);
}

/// Patches of fitted shapes are found in the same way.
TEST(AxisPatches, OfFittedShapesAreThoseOfTheExactDiagram) {
  VoronoiPatchOptions fitted;
  fitted.patch_fit = 1e-6;
  EXPECT_GT(share_found(make_cylinder({.sides = 24}), 10, fitted), 0.9999);
}

std::string message(Complex axis, const Solid& solid, const VoronoiPatchOptions& options = {}) {
  try {
    add_axis_patch_columns(axis, solid, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(AxisPatches, WrongArgumentsAreRefused) {
  const TriangleMesh mesh = make_box();
  const Solid box = Solid::of(mesh);
  Complex axis;
  axis.positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
  axis.triangles = {{0, 1, 2}};
  EXPECT_NE(message(axis, box).find("'radius'"), std::string::npos);
  add_missing_medial_columns(axis);
  EXPECT_EQ(message(axis, box), "");
  EXPECT_EQ(message(Complex{}, box), "") << "an empty axis has no triangles to label";
  EXPECT_NE(message(axis, box, {.patch_angle = 200}).find("patch_angle"), std::string::npos);
  TriangleMesh open = mesh;
  open.triangles.pop_back();
  EXPECT_NE(message(axis, Solid::of(open)), "");
  std::vector<VoronoiSite> sites = voronoi_sites(mesh);
  const std::vector<VoronoiPatch> patches = voronoi_patches(mesh, sites);
  EXPECT_NO_THROW(add_axis_patch_columns(axis, mesh, sites, patches));
  EXPECT_THROW(add_axis_patch_columns(axis, mesh, sites, {}), InvalidOption);
  sites.push_back({SiteKind::edge, {}, {0, 1000}});
  EXPECT_THROW(add_axis_patch_columns(axis, mesh, sites, patches), InvalidOption);
}

/// This triangle is not midway between walls. Within the reach of its radii there is only one contact.
TEST(AxisPatches, WithoutASecondContactBothSidesAreEqual) {
  Complex axis;
  axis.positions = {{0.5, 0.5, 0.1}, {0.6, 0.5, 0.1}, {0.5, 0.6, 0.1}};
  axis.triangles = {{0, 1, 2}};
  add_missing_medial_columns(axis);
  const auto radius = axis.vertex_columns.edit<double>(medial_columns::radius);
  std::fill(radius.begin(), radius.end(), 0.1);
  const TriangleMesh mesh = make_box();
  TriangleMesh at_origin = mesh;
  const Vec3d low = bounds(mesh).lower;
  for (Vec3d& v : at_origin.vertices) v -= low;
  add_axis_patch_columns(axis, Solid::of(at_origin));
  const auto a = axis.triangle_columns.get<std::int32_t>(medial_columns::patches[0]);
  const auto b = axis.triangle_columns.get<std::int32_t>(medial_columns::patches[1]);
  EXPECT_EQ(a[0], b[0]);
  EXPECT_GE(a[0], 0);
}

}  // namespace
}  // namespace blum
