// Proves that the verifier's solid of a mesh tells inside from outside next to faces, edges and corners of every kind,
// also in thin walls: as the solid angles of all triangles do, added up.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/solid/solid.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/triangle_search.hpp"
#include "support/model_solids.hpp"

namespace blum {
namespace {

/// How often a surface goes round a point (van Oosterom and Strackee 1983).
double winding_number(const MeshView& mesh, const Vec3d& p) {
  double sum = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corners = verifier::corners_of(mesh, t);
    const Vec3d a = corners[0] - p;
    const Vec3d b = corners[1] - p;
    const Vec3d c = corners[2] - p;
    const double volume = dot(a, cross(b, c));
    const double part =
        length(a) * length(b) * length(c) + dot(a, b) * length(c) + dot(b, c) * length(a) + dot(c, a) * length(b);
    sum += 2 * std::atan2(volume, part);
  }
  return sum / (4 * std::numbers::pi);
}

/// A point beside a random point of a corner, an edge or a face.
Vec3d beside_surface(const MeshView& mesh, double diagonal, Random& random) {
  const auto [a, b, c] = verifier::corners_of(mesh, static_cast<std::uint32_t>(random.below(mesh.triangles.size())));
  const double s = random.uniform();
  const double t = random.uniform() * (1 - s);
  const std::array<Vec3d, 3> places{a, a + (b - a) * s, a + (b - a) * s + (c - a) * t};
  const double away = diagonal * std::pow(10.0, random.uniform(-7, -0.5));
  return places[random.below(3)] + random.in_ball() * away;
}

TEST(SolidOfMesh, DepthsHaveTheSignOfTheWindingNumber) {
  std::vector<test::NamedMesh> meshes = test::thin_solids();
  for (test::NamedMesh& mesh : test::whole_solids()) meshes.push_back(std::move(mesh));
  Random random(77);
  std::size_t inside = 0;
  std::size_t outside = 0;
  std::size_t at_edges = 0;
  for (const test::NamedMesh& named : meshes) {
    const Solid solid = Solid::of(named.mesh);
    if (solid.rule() != SolidRule::polyhedron || solid.bodies().size() != 1) continue;
    const MeshView mesh = solid.bodies()[0].mesh;  // without crossings
    // A void that rounding shrinks to a point bounds nothing; certify() leaves it out first.
    if (named.name == "shell") continue;
    SCOPED_TRACE(named.name);
    const verifier::KnownSolid known = verifier::solid_of_mesh(mesh, mesh, {});
    const verifier::TriangleSearch search(mesh, {}, {});
    for (int n = 0; n < 300; ++n) {
      const Vec3d p = beside_surface(mesh, known.solid->diagonal(), random);
      const double depth = known.solid->depth(p, 0);
      if (std::abs(depth) < 1e-8 * known.solid->diagonal()) continue;
      const double winding = std::abs(winding_number(mesh, p));
      ASSERT_LT(std::abs(winding - std::round(winding)), 1e-3) << named.name;
      ASSERT_EQ(depth > 0, winding > 0.5) << named.name << ", depth " << depth;
      const verifier::TriangleSearch::Nearest nearest = search.nearest(p);
      at_edges += nearest.others == 1U ? 1 : 0;
      ++(depth > 0 ? inside : outside);
    }
  }
  EXPECT_GT(inside, 2000U);
  EXPECT_GT(outside, 2000U);
  EXPECT_GT(at_edges, 1000U) << "points whose closest one lies on an edge";
}

}  // namespace
}  // namespace blum
