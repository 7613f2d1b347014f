// Proves that complexes without columns are compared with solids by their Betti numbers, body by body, and by the
// places of their vertices and edges.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "blum/certificate/certificate.hpp"
#include "blum/core/error.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

/// Adds a polygon around the z axis, and a fan of triangles over it if `is_filled`.
void add_ring(Complex& complex, double radius, bool is_filled, std::uint32_t parts = 96) {
  const auto first = static_cast<std::uint32_t>(complex.positions.size());
  for (std::uint32_t k = 0; k < parts; ++k) {
    const double angle = 2 * std::numbers::pi * k / parts;
    complex.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    complex.edges.push_back({first + k, first + (k + 1) % parts});
  }
  if (!is_filled) return;
  complex.positions.push_back({0, 0, 0});
  for (std::uint32_t k = 0; k < parts; ++k) {
    complex.triangles.push_back({first + k, first + (k + 1) % parts, first + parts});
  }
}

bool mentions(const Certificate& certificate, const std::string& text) {
  for (const std::string& one : certificate.mismatches) {
    if (one.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST(CertifyTopology, ACircleHasTheTopologyOfATorus) {
  Complex circle;
  add_ring(circle, 1, false);
  const Certificate found = certify_topology(circle, make_torus());
  EXPECT_TRUE(found.holds());
  EXPECT_EQ(found.axis, (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(found.edges.edges, 96U);
  EXPECT_FALSE(found.checked.radii);
}

TEST(CertifyTopology, FindsWrongNumbersAndWrongPlaces) {
  Complex disc;
  add_ring(disc, 1, true);
  const Certificate filled = certify_topology(disc, make_torus());
  EXPECT_FALSE(filled.topology_holds);
  EXPECT_TRUE(mentions(filled, "the solid has 1 tunnel, the axis has 0"));
  EXPECT_FALSE(filled.geometry.holds) << "the middle lies in the hole of the ring";

  Complex beside;
  add_ring(beside, 2, false);
  const Certificate outside = certify_topology(beside, make_torus());
  EXPECT_TRUE(outside.topology_holds);
  EXPECT_FALSE(outside.geometry.holds);

  Complex two;
  add_ring(two, 0.9, false);
  add_ring(two, 1.1, false);
  EXPECT_TRUE(mentions(certify_topology(two, make_torus()), "the solid has 1 component, the axis has 2"));
}

TEST(CertifyTopology, OfVoxels) {
  const VoxelImage image = make_ball_image({.size = 24});
  const VoxelSet voxels = selected_voxels(image, {});
  Complex point;
  point.positions = {image.grid.position(12, 12, 12)};
  EXPECT_TRUE(certify_topology(point, voxels, image.grid, nullptr).holds());
  point.positions = {image.grid.position(0, 0, 0)};
  EXPECT_FALSE(certify_topology(point, voxels, image.grid, nullptr).holds());
}

TEST(CertifyTopology, RejectsInvalidComplexes) {
  Complex wrong;
  wrong.positions = {{1, 0, 0}};
  wrong.edges = {{0, 1}};
  EXPECT_THROW((void)certify_topology(wrong, make_torus()), InvalidOption);
}

}  // namespace
}  // namespace blum
