// Proves that contraction of edges without length keeps topology and places, and leaves the curve of a ribbon. Every
// edge that may be contracted is contracted.
#include "medial_axis/fit/contract_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/random.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using detail::contract_points;

using test::AxisRows;
using test::EdgeRow;
using test::TriangleRow;
using test::VertexRow;

using Face = std::array<std::uint32_t, 3>;
using Edge = std::array<std::uint32_t, 2>;

AxisRows complex_of(const std::vector<Vec3d>& places, const std::vector<Face>& faces,
                    const std::vector<Edge>& curves = {}) {
  AxisRows complex;
  for (const Vec3d& place : places) complex.vertices.emplace_back().position = place;
  for (const Face& face : faces) {
    complex.triangles.push_back({face, static_cast<float>(10 + complex.triangles.size()), 0});
  }
  for (const Edge& edge : curves) complex.edges.push_back({edge, 5, MedialRole::curve});
  return complex;
}

void contract_points(AxisRows& axis) {
  Complex complex = axis;
  blum::contract_points(complex, Incidence(complex.view()));
  axis = complex;
}

BettiNumbers betti_of(const Complex& complex) {
  return homology(complex.view());
}

std::vector<std::array<double, 3>> places_of(const AxisRows& complex) {
  std::vector<std::array<double, 3>> places;
  for (const VertexRow& v : complex.vertices) places.push_back({v.position.x, v.position.y, v.position.z});
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

TEST(ContractPoints, ARibbonBecomesItsCurve) {
  constexpr std::uint32_t steps = 6;
  std::vector<Vec3d> places;
  std::vector<Face> faces;
  for (std::uint32_t k = 0; k <= steps; ++k) {
    for (int side = 0; side < 2; ++side) places.push_back({static_cast<double>(k), 0, 0});
    if (k == steps) break;
    faces.push_back({2 * k, 2 * k + 2, 2 * k + 3});
    faces.push_back({2 * k, 2 * k + 3, 2 * k + 1});
  }
  AxisRows complex = complex_of(places, faces);
  contract_points(complex);
  EXPECT_TRUE(complex.triangles.empty());
  ASSERT_EQ(complex.vertices.size(), steps + 1);
  ASSERT_EQ(complex.edges.size(), steps);
  for (const EdgeRow& edge : complex.edges) {
    EXPECT_EQ(edge.role, MedialRole::curve);
    EXPECT_GE(edge.separation_angle, 10) << "that of a triangle that it was a side of";
    EXPECT_EQ(length(complex.vertices[edge.vertices[0]].position - complex.vertices[edge.vertices[1]].position), 1);
  }
}

TEST(ContractPoints, ACircleStaysACircle) {
  AxisRows complex = complex_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {}, {{0, 1}, {1, 2}, {2, 0}});
  contract_points(complex);
  EXPECT_EQ(complex.edges.size(), 3U) << "two edges between the same vertices would be left";
  complex = complex_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}});
  contract_points(complex);
  EXPECT_EQ(complex.edges.size(), 3U);
  EXPECT_EQ(betti_of(complex), (BettiNumbers{1, 1, 0}));
}

TEST(ContractPoints, ASphereStaysASphere) {
  const std::vector<Face> faces{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  AxisRows complex = complex_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, faces);
  contract_points(complex);
  EXPECT_EQ(complex.triangles.size(), 4U) << "two triangles with the same corners would be left";
}

TEST(ContractPoints, VerticesAtOnePlaceBecomeOneVertex) {
  AxisRows complex = complex_of(std::vector<Vec3d>(5), {{0, 1, 2}, {2, 1, 3}}, {{3, 4}});
  contract_points(complex);
  EXPECT_EQ(complex.vertices.size(), 1U);
  EXPECT_TRUE(complex.triangles.empty() && complex.edges.empty());
}

/// Triangles and edges between random vertices. The edges are not sides of triangles.
AxisRows random_complex(Random& random) {
  const auto count = static_cast<std::uint32_t>(4 + random.below(9));
  std::vector<Vec3d> places;
  for (std::uint32_t v = 0; v < count; ++v) places.push_back({static_cast<double>(random.below(count / 2)), 0, 0});
  std::vector<Face> faces;
  std::vector<Edge> edges;
  const auto vertex = [&] { return static_cast<std::uint32_t>(random.below(count)); };
  for (std::uint64_t n = random.below(30); n > 0; --n) {
    Face face{vertex(), vertex(), vertex()};
    std::sort(face.begin(), face.end());
    if (face[0] != face[1] && face[1] != face[2]) faces.push_back(face);
  }
  for (std::uint64_t n = random.below(12); n > 0; --n) {
    Edge edge{vertex(), vertex()};
    std::sort(edge.begin(), edge.end());
    const bool is_side = std::any_of(faces.begin(), faces.end(), [&](const Face& face) {
      return std::count(face.begin(), face.end(), edge[0]) + std::count(face.begin(), face.end(), edge[1]) == 2;
    });
    if (edge[0] != edge[1] && !is_side) edges.push_back(edge);
  }
  const auto once = [](auto& cells) {
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  };
  once(faces);
  once(edges);
  return complex_of(places, faces, edges);
}

bool has_duplicates(const AxisRows& complex) {
  std::vector<Face> faces;
  for (const TriangleRow& triangle : complex.triangles) {
    faces.push_back(triangle.vertices);
    std::sort(faces.back().begin(), faces.back().end());
    if (std::adjacent_find(faces.back().begin(), faces.back().end()) != faces.back().end()) return true;
  }
  std::vector<Edge> edges;
  for (const EdgeRow& edge : complex.edges) {
    const auto [a, b] = edge.vertices;
    if (a == b) return true;
    edges.push_back({std::min(a, b), std::max(a, b)});
    const bool is_side = std::any_of(faces.begin(), faces.end(), [&, a = a, b = b](const Face& face) {
      return std::count(face.begin(), face.end(), a) + std::count(face.begin(), face.end(), b) == 2;
    });
    if (is_side) return true;
  }
  std::sort(faces.begin(), faces.end());
  std::sort(edges.begin(), edges.end());
  return std::adjacent_find(faces.begin(), faces.end()) != faces.end() ||
         std::adjacent_find(edges.begin(), edges.end()) != edges.end();
}

TEST(ContractPoints, RandomComplexesKeepTheirTopologyAndPlaces) {
  Random random(5);
  std::size_t contracted = 0;
  for (int n = 0; n < 5000; ++n) {
    const AxisRows before = random_complex(random);
    AxisRows after = before;
    contract_points(after);
    ASSERT_EQ(betti_of(after), betti_of(before)) << "complex " << n;
    ASSERT_EQ(places_of(after), places_of(before)) << "complex " << n;
    ASSERT_FALSE(has_duplicates(after)) << "complex " << n;
    contracted += before.vertices.size() - after.vertices.size();
    AxisRows again = after;
    contract_points(again);
    ASSERT_EQ(again.vertices.size(), after.vertices.size()) << "complex " << n;
  }
  EXPECT_GT(contracted, 1000U);
}

}  // namespace
}  // namespace blum
