// Proves that medial axes of solids with walls, gaps and tunnels far thinner than a voxel have the topology of the
// solid. The proof covers every angle, complexes and written files. If the cellular model passes, no step towards the
// axis changes the topology.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"
#include "medial_axis/cells/attached_voxels.hpp"
#include "medial_axis/cells/collapse.hpp"
#include "medial_axis/cells/voxelize.hpp"
#include "medial_axis/shape/separation_angles.hpp"
#include "medial_axis/surface/mesh_surface.hpp"
#include "support/medial_check.hpp"
#include "support/model_solids.hpp"

namespace blum {
namespace {

using detail::AttachedVoxels;
using detail::CellComplex;
using detail::collapse;
using detail::collapse_extra;
using detail::CollapseOrder;
using detail::GovernorField;
using detail::Importance;
using detail::MeshSurface;
using detail::separation_angles;
using detail::thin_voxels;
using detail::voxelize_body;
using detail::Voxelized;

std::int64_t euler_of(const CellComplex& complex) {
  std::int64_t sum = 0;
  complex.for_each_cell([&](Cell cell) { sum += complex.structure().dimension(cell) % 2 == 0 ? 1 : -1; });
  return sum;
}

/// Expects that each cell of a complex has its whole border in it: two ends, three or four sides, or four to six faces.
void expect_closed(const CellComplex& complex) {
  complex.for_each_cell([&](Cell cell) {
    int faces = 0;
    complex.structure().for_each_face(cell, [&](Cell face) { faces += complex.contains(face) ? 1 : 0; });
    const int dimension = complex.structure().dimension(cell);
    const int least = dimension == 0 ? 0 : dimension + 1;
    ASSERT_GE(faces, least) << "a cell of dimension " << dimension;
    ASSERT_LE(faces, 2 * dimension) << "a cell of dimension " << dimension;
  });
}

/// Checks the Euler number of a body's model and of the complex that remains after each step.
void expect_same_euler_numbers(const SolidBody& body, double spacing) {
  const Voxelized made = voxelize_body(body, spacing, {});
  if (!made.report.topology_matches) return;
  const std::int64_t wanted = body.betti[0] - body.betti[1] + body.betti[2];
  CellComplex complex(made.solid.voxels, made.solid.extra, {});
  expect_closed(complex);
  EXPECT_EQ(euler_of(complex), wanted) << "of the model";
  const SiteTable sites(body.mesh);
  const MeshSurface surface(body.mesh, sites, true, {});
  const Importance importance = separation_angles(GovernorField(made.solid, surface), complex, {}, {});
  collapse_extra(complex, importance);
  expect_closed(complex);
  EXPECT_EQ(euler_of(complex), wanted) << "after extra cells";
  const AttachedVoxels attached(complex, made.solid.voxels, importance);
  CellComplex thin = attached.rest(thin_voxels(made.solid, attached, complex.lattice(), importance, {}), {});
  expect_closed(thin);
  EXPECT_EQ(euler_of(thin), wanted) << "after thinning";
  const std::vector<float> depths(complex.structure().extra_count(), 0);
  const CollapseOrder order =
      collapse(std::move(thin), {made.solid.depth.span(), depths}, spacing / 4, importance, HUGE_VAL, {});
  expect_closed(order.base);
  EXPECT_EQ(euler_of(order.base), wanted) << "after collapse";
}

TEST(MedialModel, EachStepKeepsTheEulerNumber) {
  for (const test::NamedMesh& named : test::thin_solids()) {
    const Solid solid = Solid::of(named.mesh);
    if (solid.rule() != SolidRule::polyhedron) continue;
    const Vec3d size = solid.box().size();
    const double longest = std::max({size.x, size.y, size.z});
    for (const int resolution : {3, 9, 20}) {
      SCOPED_TRACE(named.name + " at " + std::to_string(resolution));
      for (const SolidBody& body : solid.bodies()) expect_same_euler_numbers(body, longest / resolution);
    }
  }
}

TEST(MedialModel, AxesOfThinSolidsHaveTheirBettiNumbersAtEveryAngle) {
  std::size_t seen = 0;
  for (const test::NamedMesh& named : test::thin_solids()) {
    for (const int resolution : {8, 15}) {
      SCOPED_TRACE(named.name + " at " + std::to_string(resolution));
      const Solid solid = Solid::of(named.mesh);
      if (solid.rule() != SolidRule::polyhedron) continue;
      const MedialAxis axis = medial_axis(solid, {.resolution = resolution, .max_resolution = 8});
      if (!axis.report().topology_matches) continue;
      ++seen;
      EXPECT_EQ(axis.report().betti, *solid.betti());
      test::expect_betti(axis, *solid.betti());
    }
  }
  EXPECT_GT(seen, 20U);
}

/// Returns a hollow ring with a thin wall.
TriangleMesh hollow_ring(double tube_radius, double wall, int ring_segments, int tube_segments) {
  const auto ring = [&](double radius) { return make_torus({1, radius, ring_segments, tube_segments}); };
  TriangleMesh mesh = ring(tube_radius);
  TriangleMesh inner = ring(tube_radius - wall);
  reverse_triangles(inner);
  append(mesh, inner);
  return mesh;
}

TEST(MedialModel, AxesOfThinTubesNarrowerThanVoxelsStayInThem) {
  // Within a voxel, the wall of a tube runs back and forth. Triangles between its ends crossed the hollow until the
  // model was refined there.
  for (const auto& [resolution, wall] : {std::pair{8, 1e-5}, std::pair{16, 1e-4}}) {
    SCOPED_TRACE(testing::Message() << "a wall of " << wall << " at " << resolution);
    const TriangleMesh mesh = hollow_ring(0.05, wall, 24, 8);
    const MedialAxis axis = medial_axis(mesh, {.resolution = resolution});
    test::expect_certified(axis, mesh, {1, 2, 1});
    const Certificate certificate = certify(axis.simplify(0), mesh);
    EXPECT_EQ(certificate.edges.pushed, 0U);
    EXPECT_EQ(certificate.edges.outside, 0U);
  }
}

TEST(MedialModel, TheSameForAnyNumberOfThreads) {
  for (const test::NamedMesh& named : test::thin_solids()) {
    SCOPED_TRACE(named.name);
    const Solid solid = Solid::of(named.mesh);
    if (solid.rule() != SolidRule::polyhedron) continue;
    const Complex one = medial_axis(solid, {.resolution = 10, .max_resolution = 8}, {.threads = 1}).simplify(20);
    for (const int threads : {2, 7}) {
      const Complex many =
          medial_axis(solid, {.resolution = 10, .max_resolution = 8}, {.threads = threads}).simplify(20);
      EXPECT_EQ(many.positions, one.positions);
      EXPECT_EQ(many.edges, one.edges);
      EXPECT_EQ(many.triangles, one.triangles);
    }
  }
}

}  // namespace
}  // namespace blum
