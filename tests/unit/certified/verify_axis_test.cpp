// Proves that claims of an axis are compared with its solid. False rules, false sides of voxels and missing attributes
// are rejected, and true claims are accepted.
#include "blum/certified/verify_axis.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

MedialClaims claims_for(const MedialAxis& axis) {
  MedialClaims claims;
  claims.metadata.version = "1";
  claims.metadata.solid_rule = to_string(axis.report().rule);
  claims.metadata.grid = axis.report().grid;
  claims.metadata.site_ids = axis.report().rule == SolidRule::voxels ? SiteIds::voxels : SiteIds::features;
  return claims;
}

TEST(VerifyMedial, RejectsFalseClaimsOfAnAxisOfAMesh) {
  const TriangleMesh mesh = make_box({});
  const MedialAxis axis = medial_axis(mesh, {.resolution = 16});
  const auto piece = axis.simplify(60);
  const MedialClaims claims = claims_for(axis);
  EXPECT_TRUE(verify(piece, claims, mesh).holds());
  const auto refused = [&](const std::function<void(MedialClaims&)>& falsify, const std::string& reason) {
    MedialClaims wrong = claims;
    falsify(wrong);
    const std::vector<std::string> mismatches = verify(piece, wrong, mesh).mismatches;
    ASSERT_EQ(mismatches.size(), 1U) << reason;
    EXPECT_NE(mismatches.front().find(reason), std::string::npos) << mismatches.front();
  };
  refused([](MedialClaims& c) { c.metadata.solid_rule = "winding"; }, "its solid is 'winding', but it is 'polyhedron'");
  refused([](MedialClaims& c) { c.has_radii = false; }, "contains no radii");
  refused([](MedialClaims& c) { c.metadata.site_ids = SiteIds::voxels; }, "contains no sites of this kind of solid");
  MedialClaims of_others = claims;
  of_others.metadata.version.clear();
  of_others.has_footprints = of_others.has_sites = false;
  EXPECT_TRUE(verify(piece, of_others, mesh).holds()) << "other programs need not write all of it";
}

TEST(VerifyMedial, VoxelsOfAnOpenMeshMustBeNamed) {
  TriangleMesh mesh = make_box({});
  mesh.triangles.pop_back();
  const MedialAxis axis = medial_axis(mesh, {.resolution = 16});
  MedialClaims claims = claims_for(axis);
  const Certificate certificate = verify(axis.simplify(60), claims, mesh);
  EXPECT_TRUE(certificate.holds());
  EXPECT_EQ(certificate.against, SolidRule::winding);
  EXPECT_THROW((void)verify(axis.simplify(60), claims, mesh, {}, 1000), OutOfMemory);
  claims.metadata.grid.reset();
  EXPECT_THROW((void)verify(axis.simplify(60), claims, mesh), UnknownVoxels);
}

TEST(VerifyMedial, RejectsCoarseGridsAndOtherSpacingsOfAnOpenMesh) {
  TriangleMesh mesh = make_box({});
  mesh.triangles.pop_back();
  const MedialAxis axis = medial_axis(mesh, {.resolution = 16});
  const auto piece = axis.simplify(60);
  MedialClaims claims = claims_for(axis);
  claims.metadata.spacing = claims.metadata.grid->spacing.x;
  const Certificate certificate = verify(piece, claims, mesh);
  EXPECT_TRUE(certificate.holds());
  EXPECT_EQ(certificate.voxel, claims.metadata.spacing);
  claims.metadata.spacing = 0.5 * claims.metadata.grid->spacing.x;
  const Certificate other = verify(piece, claims, mesh);
  ASSERT_EQ(other.mismatches.size(), 1U);
  EXPECT_NE(other.mismatches.front().find("but its grid has a spacing of"), std::string::npos)
      << other.mismatches.front();
  // Steps of 1/4 along one side. The grid still covers the mesh.
  GridSpec& grid = *claims.metadata.grid;
  grid.spacing.x = 0.25;
  claims.metadata.spacing.reset();
  EXPECT_THROW((void)verify(piece, claims, mesh), InvalidGrid);
}

TEST(VerifyMedial, SidesOfVoxelsEqualThoseOfTheImage) {
  VoxelImage image;
  image.grid = {{0, 0, 0}, {1, 1, 1}, {8, 8, 8}, {}};
  std::vector<std::uint8_t> values(512, 0);
  for (std::size_t i = 200; i < 208; ++i) values[i] = 2;
  image.values = values;
  const LabelSelection selection = LabelSelection::of_label(2);
  const MedialAxis axis = medial_axis(image, {.selection = selection});
  MedialClaims claims = claims_for(axis);
  EXPECT_TRUE(verify(axis.simplify(60), claims, image, selection).holds());
  claims.metadata.grid->spacing = {1, 1, 2};
  EXPECT_FALSE(verify(axis.simplify(60), claims, image, selection).holds());
}

}  // namespace
}  // namespace blum
