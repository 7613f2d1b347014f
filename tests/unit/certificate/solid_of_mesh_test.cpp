// Proves that the verifier's solid of a mesh distinguishes inside from outside beside faces, edges and corners of every
// kind, also in thin walls. The reference is the sum of the solid angles of all triangles.
#include <gtest/gtest.h>

#include <algorithm>
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

/// The winding number of a surface around a point (van Oosterom and Strackee 1983).
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

/// A point beside a random point on a corner, an edge or a face.
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
    const MeshView mesh = solid.bodies()[0].mesh;  // crossings are resolved
    // Rounding may shrink a void to a point that bounds nothing. certify() removes such a void first.
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

/// As close to a corner as rounding, the search misses some faces. Two overhanging faces alone would place points
/// beyond the corner inside.
TEST(SolidOfMesh, BeyondAnObliqueApexIsOutside) {
  Random random(4);
  std::size_t looked_at = 0;
  for (int k = 0; k < 100; ++k) {
    TriangleMesh pyramid;
    pyramid.vertices.push_back({0, 0, 0});
    for (std::uint32_t corner = 0; corner < 6; ++corner) {
      const double angle = std::numbers::pi * (corner + 0.5) / 3;
      pyramid.vertices.push_back({1.2 + 0.5 * std::cos(angle), 0.5 * std::sin(angle), -1});
      std::array<std::uint32_t, 3> side{0, 1 + corner, 1 + (corner + 1) % 6};
      std::rotate(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(random.below(3)), side.end());
      pyramid.triangles.push_back(side);
      if (corner > 0 && corner < 5) pyramid.triangles.push_back({1, 2 + corner, 1 + corner});
    }
    TriangleMesh mesh = test::turned(pyramid, random.bits());
    const Vec3d move = random.in_cube() * 3e3;  // increases rounding
    for (Vec3d& v : mesh.vertices) v += move;
    const verifier::KnownSolid known = verifier::solid_of_mesh(mesh, mesh, {});
    const Vec3d apex = mesh.vertices[0];
    for (int n = 0; n < 1500; ++n) {
      Vec3d way = random.in_ball();
      way = way / length(way);
      const bool is_beyond = std::all_of(mesh.vertices.begin() + 1, mesh.vertices.end(),
                                         [&](const Vec3d& corner) { return dot(corner - apex, way) < -0.05; });
      if (!is_beyond) continue;
      const Vec3d p = apex + way * (known.solid->diagonal() * std::pow(10.0, random.uniform(-8.9, -1)));
      ++looked_at;
      EXPECT_LT(known.solid->depth(p, 0), 0) << length(p - apex);
      EXPECT_GT(known.solid->locate(p).outside_by, 0) << length(p - apex);
    }
  }
  EXPECT_GT(looked_at, 1000U);
}

}  // namespace
}  // namespace blum
