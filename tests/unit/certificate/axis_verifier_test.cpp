// Proves that one verifier returns the same certificates for all axes of a solid as separate verifiers, byte for byte.
// The axes are true and false, in any order, from many threads, for all shapes and images.
#include "blum/certificate/axis_verifier.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/described_text.hpp"
#include "support/shape_names.hpp"

namespace blum {
namespace {

using test::described_text;

constexpr std::array thetas{120.0, 20.0, 60.0};  ///< not ascending: the knowledge of a solid grows and is reused

/// An axis and the claims of its file.
struct Said {
  Complex axis;
  CertificateOptions options;
};

/// Lean axes of three angles, one axis with all vertices, and two false axes.
std::vector<Said> axes_of(const MedialAxis& axis) {
  std::vector<Said> all;
  const double voxel = axis.report().bodies.front().spacing;
  for (const double theta : thetas) {
    CertificateOptions options;
    options.theta = theta;
    options.lambda = 0;
    options.spacing = voxel;
    if (all.empty()) all.push_back({axis.simplify(theta), options});  // one axis with all vertices
    DecimatedAxis lean = decimate(axis.simplify(theta), voxel / 4);
    options.deviation = lean.deviation;
    all.push_back({std::move(lean.axis), options});
  }
  Said wrong = all.back();
  for (Vec3d& at : wrong.axis.positions) at += Vec3d{voxel, 0, 0};
  all.push_back(wrong);
  wrong = all.front();
  wrong.options.theta = 1;
  for (double& radius : wrong.axis.vertex_columns.edit<double>(medial_columns::radius)) radius *= 1.01;
  all.push_back(wrong);
  return all;
}

/// @param alone  returns the certificate of one axis by a new verifier.
template <class Alone>
void expect_as_alone(const AxisVerifier& verifier, const std::vector<Said>& axes, const Alone& alone) {
  for (const Said& said : axes) {
    const std::string expected = described_text(alone(said));
    EXPECT_EQ(described_text(verifier.certify(said.axis, said.options)), expected);
  }
  const Said& first = axes.front();
  EXPECT_EQ(described_text(verifier.certify(first.axis, first.options, {.threads = 3})),
            described_text(verifier.certify(first.axis, first.options, {.threads = 1})));
}

class AxesOfAShape : public testing::TestWithParam<std::string> {};

TEST_P(AxesOfAShape, GetTheSameCertificatesFromOneVerifier) {
  const TriangleMesh mesh = make_shape(GetParam());
  if (mesh.triangles.empty()) return;  // bounds nothing
  std::optional<MedialAxis> axis;
  try {
    axis = medial_axis(mesh, {.resolution = 12});
  } catch (const InvalidMesh&) {
    return;  // bounds nothing
  }
  const std::vector<Said> axes = axes_of(*axis);
  if (axis->report().rule == SolidRule::polyhedron) {
    const AxisVerifier verifier(mesh);
    EXPECT_EQ(verifier.rule().rule, SolidRule::polyhedron);
    EXPECT_EQ(verifier.rule().reason, solid_rule(mesh).reason);
    expect_as_alone(verifier, axes, [&](const Said& said) { return certify(said.axis, mesh, said.options); });
    const Complex& cells = axes.front().axis;
    EXPECT_EQ(described_text(verifier.certify_topology(cells)), described_text(certify_topology(cells, mesh)));
    return;
  }
  EXPECT_EQ(AxisVerifier(mesh).rule().reason, solid_rule(mesh).reason);
  EXPECT_THROW(static_cast<void>(AxisVerifier(mesh).certify(axes.front().axis)), InvalidMesh);
  MedialClaims claims;
  claims.metadata.grid = axis->report().grid;
  const MeshAxisVerifier verifier(mesh);
  for (const Said& said : axes) {
    EXPECT_EQ(described_text(verifier.verify(said.axis, claims, said.options)),
              described_text(verify(said.axis, claims, mesh, said.options)));
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, AxesOfAShape, testing::ValuesIn(test::catalog_names()),
                         [](const auto& each) { return test::test_name(each.param); });

TEST(AxisVerifier, CertifiesAllAxesOfAnImage) {
  for (const ImageInfo& info : image_catalog()) {
    SCOPED_TRACE(info.name);
    const bool is_noise = info.name == "noise_image";
    const VoxelImage image = is_noise ? make_noise_image({.size = 16, .density = 0.05}) : make_image(info.name);
    const VoxelSet voxels = selected_voxels(image, {});
    if (voxels.count() == 0 || voxels.count() > 20'000) continue;
    const AxisVerifier verifier(voxels, image.grid, nullptr);
    EXPECT_EQ(verifier.rule().rule, SolidRule::voxels);
    expect_as_alone(verifier, axes_of(medial_axis(image)),
                    [&](const Said& said) { return certify(said.axis, voxels, image.grid, nullptr, said.options); });
  }
}

TEST(AxisVerifier, MayBeUsedFromManyThreads) {
  const TriangleMesh mesh = make_bracket({});
  const std::vector<Said> axes = axes_of(medial_axis(mesh, {.resolution = 24}));
  std::vector<std::string> expected;
  for (const Said& said : axes) expected.push_back(described_text(certify(said.axis, mesh, said.options)));
  const AxisVerifier verifier(mesh);
  std::vector<std::string> found(axes.size());
  {
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      threads.emplace_back(
          [&, k] { found[k] = described_text(verifier.certify(axes[k].axis, axes[k].options, {.threads = 2})); });
    }
  }
  EXPECT_EQ(found, expected);
}

TEST(AxisVerifier, WorksOnAfterACancelledCall) {
  const TriangleMesh mesh = make_box({});
  const std::vector<Said> axes = axes_of(medial_axis(mesh, {.resolution = 16}));
  const AxisVerifier verifier(mesh);
  std::stop_source stop;
  stop.request_stop();
  Context cancelled;
  cancelled.cancel = stop.get_token();
  EXPECT_THROW(static_cast<void>(verifier.certify(axes.front().axis, {}, cancelled)), Cancelled);
  EXPECT_EQ(described_text(verifier.certify(axes.front().axis)), described_text(certify(axes.front().axis, mesh)));
}

TEST(AxisVerifier, RejectsInvalidMeshesAndVoxels) {
  TriangleMesh mesh = make_box({});
  mesh.triangles.front()[0] = 1000;
  EXPECT_THROW(AxisVerifier{mesh}, InvalidMesh);
  const GridSpec grid{{0, 0, 0}, {1, 1, 1}, {4, 4, 4}, {}};
  EXPECT_THROW(AxisVerifier(VoxelSet(grid.size), grid, nullptr), InvalidOption) << "no voxels";
  VoxelSet voxels({4, 4, 5});
  voxels.insert(1, 1, 1);
  EXPECT_THROW(AxisVerifier(voxels, grid, nullptr), InvalidOption) << "another size";
}

TEST(ImageAxisVerifier, SeparatesSelections) {
  const VoxelImage image = make_balls_image({.count = 2, .pitch = 10, .radius = 3});
  const ImageAxisVerifier verifier(image);
  MedialClaims claims;
  claims.metadata.site_ids = SiteIds::voxels;
  for (const std::int64_t label : {1, 2, 2, 1}) {
    const LabelSelection selection = LabelSelection::of_label(label);
    const Complex axis = medial_axis(image, {.selection = selection}).simplify(60);
    EXPECT_TRUE(verifier.verify(axis, claims, selection).holds());
    EXPECT_EQ(described_text(verifier.verify(axis, claims, selection)),
              described_text(verify(axis, claims, image, selection)));
    EXPECT_FALSE(verifier.verify(axis, claims, LabelSelection::of_label(3 - label)).holds());
    claims.metadata.smooth = 10;
    EXPECT_EQ(described_text(verifier.verify(axis, claims, selection)),
              described_text(verify(axis, claims, image, selection)));
    claims.metadata.smooth.reset();
  }
}

}  // namespace
}  // namespace blum
