// Proves that one call computes the axis of a solid, a mesh or an image. A mesh without interior is rejected with the
// reason.
#include "blum/medial_axis/medial_axis.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"

namespace blum {
namespace {

void expect_same(const MedialAxis& a, const MedialAxis& b) {
  EXPECT_EQ(a.report().rule, b.report().rule);
  EXPECT_EQ(a.report().reason, b.report().reason);
  EXPECT_EQ(a.report().betti, b.report().betti);
  const auto first = a.simplify(60);
  const auto second = b.simplify(60);
  EXPECT_EQ(first.triangles.size(), second.triangles.size());
  EXPECT_EQ(first.edges.size(), second.edges.size());
}

TEST(MedialAxis, ASolidGivesTheAxisOfItsMeshOrImage) {
  const TriangleMesh mesh = make_torus({.ring_segments = 24, .tube_segments = 12});
  TriangleMesh open = mesh;
  open.triangles.pop_back();
  const MedialAxisOptions options{.resolution = 24};
  for (const TriangleMesh& input : {mesh, open}) {
    expect_same(medial_axis(Solid::of(input), options), medial_axis(input, options));
  }
  VoxelImage image;
  image.grid = {{0, 0, 0}, {1, 1, 1}, {6, 6, 6}, {}};
  std::vector<std::uint8_t> values(216, 3);
  values[0] = 1;
  image.values = values;
  const LabelSelection selection = LabelSelection::of_label(3);
  expect_same(medial_axis(Solid::of(image, selection)), medial_axis(image, {.selection = selection}));
}

TEST(MedialAxis, WarnsOfReversedShellsAndVoxels) {
  const TriangleMesh box = make_box({});
  const MedialAxisOptions options{.resolution = 12};
  EXPECT_TRUE(medial_axis(box, options).report().warnings.empty());
  TriangleMesh inwards = box;
  inwards.triangles = reversed_triangles(box.triangles);
  EXPECT_EQ(medial_axis(inwards, options).report().warnings,
            (std::vector<Warning>{{WarningCode::reversed_shells, "1 shell faces the wrong way and was reversed"}}));
  TriangleMesh open = box;
  open.triangles.pop_back();
  const MedialAxis axis = medial_axis(open, options);
  EXPECT_EQ(axis.report().warnings,
            (std::vector<Warning>{{WarningCode::solid_of_voxels, axis.report().reason + ", as voxels"}}));
}

/// The message with which medial_axis() rejects a mesh without interior.
std::string refusal_of(const TriangleMesh& mesh) {
  try {
    (void)medial_axis(mesh, {.resolution = 16, .max_resolution = 16});
  } catch (const InvalidMesh& error) {
    return error.what();
  }
  return {};
}

TEST(MedialAxis, RecommendsFlippingMeshesThatFaceInwards) {
  TriangleMesh inwards = make_box({});
  inwards.triangles.pop_back();
  inwards.triangles = reversed_triangles(inwards.triangles);
  EXPECT_TRUE(refusal_of(inwards).ends_with("; its triangles face inwards: flip them")) << refusal_of(inwards);
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}};
  EXPECT_TRUE(refusal_of(sheet).starts_with("the mesh has no interior: ")) << refusal_of(sheet);
  EXPECT_EQ(refusal_of(sheet).find("flip"), std::string::npos);
}

TEST(MedialAxis, CancelStopsSimplifyAndNested) {
  const MedialAxis axis = medial_axis(make_box({}), {.resolution = 12});
  std::stop_source source;
  source.request_stop();
  const Context stopped{.cancel = source.get_token()};
  EXPECT_THROW((void)axis.simplify(60, stopped), Cancelled);
  EXPECT_THROW((void)axis.nested(stopped), Cancelled);
  EXPECT_FALSE(axis.simplify(60).triangles.empty());
}

}  // namespace
}  // namespace blum
