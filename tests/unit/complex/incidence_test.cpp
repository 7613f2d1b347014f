// Proves that the incidence of a complex equals a count cell by cell, on random complexes with repeated edges and
// triangles. Components, Euler numbers and unions are also tested.
#include "blum/complex/incidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "blum/complex/components.hpp"
#include "blum/complex/homology.hpp"

namespace blum {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

Edge rising(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

Complex random_complex(unsigned seed, std::uint32_t vertices, std::size_t edges, std::size_t triangles) {
  std::mt19937 random(seed);
  const auto vertex = [&] { return static_cast<std::uint32_t>(random() % vertices); };
  Complex complex;
  complex.positions.resize(vertices);
  while (complex.edges.size() < edges) {
    const Edge edge{vertex(), vertex()};
    if (edge[0] != edge[1]) complex.edges.push_back(edge);
  }
  while (complex.triangles.size() < triangles) {
    const Face face{vertex(), vertex(), vertex()};
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) complex.triangles.push_back(face);
  }
  return complex;
}

std::set<Edge> edges_of(const Complex& complex) {
  std::set<Edge> edges;
  for (const auto& [a, b] : complex.edges) edges.insert(rising(a, b));
  for (const auto& [a, b, c] : complex.triangles) edges.insert({rising(a, b), rising(b, c), rising(c, a)});
  return edges;
}

std::vector<std::uint32_t> list(std::span<const std::uint32_t> row) {
  return {row.begin(), row.end()};
}

/// Compares each table with a search over all cells.
void expect_right(const Complex& complex) {
  const Incidence incidence(complex.view());
  const std::set<Edge> wanted = edges_of(complex);
  const std::vector<Edge> edges(incidence.edges().begin(), incidence.edges().end());
  EXPECT_EQ(edges, std::vector<Edge>(wanted.begin(), wanted.end()));
  const auto has = [](const auto& cell, std::uint32_t v) {
    return std::find(cell.begin(), cell.end(), v) != cell.end();
  };
  ASSERT_EQ(incidence.edge_of_listed().size(), complex.edges.size());
  for (std::size_t i = 0; i < complex.edges.size(); ++i) {
    EXPECT_EQ(edges[incidence.edge_of_listed()[i]], rising(complex.edges[i][0], complex.edges[i][1]));
  }
  ASSERT_EQ(incidence.sides().size(), complex.triangles.size());
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Face& face = complex.triangles[t];
      EXPECT_EQ(edges[incidence.sides()[t][k]], rising(face[k], face[(k + 1) % 3]));
    }
  }
  ASSERT_EQ(incidence.triangles_of_edge().size(), edges.size());
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < complex.triangles.size(); ++t) {
      if (has(complex.triangles[t], edges[e][0]) && has(complex.triangles[t], edges[e][1])) triangles.push_back(t);
    }
    EXPECT_EQ(list(incidence.triangles_of_edge()[e]), triangles);
    EXPECT_EQ(incidence.find_edge(edges[e][1], edges[e][0]), e);
  }
  ASSERT_EQ(incidence.edges_of_vertex().size(), complex.positions.size());
  ASSERT_EQ(incidence.triangles_of_vertex().size(), complex.positions.size());
  for (std::uint32_t v = 0; v < complex.positions.size(); ++v) {
    std::vector<std::uint32_t> own_edges;
    std::vector<std::uint32_t> own_triangles;
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      if (has(edges[e], v)) own_edges.push_back(e);
    }
    for (std::uint32_t t = 0; t < complex.triangles.size(); ++t) {
      if (has(complex.triangles[t], v)) own_triangles.push_back(t);
    }
    EXPECT_EQ(list(incidence.edges_of_vertex()[v]), own_edges);
    EXPECT_EQ(list(incidence.triangles_of_vertex()[v]), own_triangles);
    for (std::uint32_t w = 0; w < complex.positions.size(); ++w) {
      EXPECT_EQ(incidence.find_edge(v, w).has_value(), wanted.contains(rising(v, w)));
    }
  }
}

TEST(Incidence, EqualsASearchOverAllCells) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const auto vertices = 3 + seed % 12;
    expect_right(random_complex(seed, vertices, seed * 7 % 30, seed * 11 % 40));
  }
}

TEST(Incidence, IsEmptyForAnEmptyComplex) {
  const Incidence incidence(ComplexView{});
  EXPECT_TRUE(incidence.edges().empty());
  EXPECT_EQ(incidence.edges_of_vertex().size(), 0U);
  EXPECT_EQ(Incidence({3, {}, {}}).edges_of_vertex()[2].size(), 0U);
  EXPECT_FALSE(Incidence({3, {}, {}}).find_edge(0, 2).has_value());
}

TEST(Incidence, RejectsInvalidComplexes) {
  const std::vector<Edge> beyond{{0, 1}, {1, 5}};
  const std::vector<Face> twice{{0, 1, 0}};
  const auto message = [](const ComplexView& view) {
    try {
      const Incidence incidence(view);
    } catch (const InvalidOption& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message({3, beyond, {}}).find("edge 1 uses vertex 5, but there are only 3"), std::string::npos);
  EXPECT_NE(message({3, {}, twice}).find("triangle 0 uses vertex 0 twice"), std::string::npos);
  EXPECT_THROW((void)components({3, beyond, {}}), InvalidOption);
  EXPECT_THROW((void)euler_characteristic({3, {}, twice}), InvalidOption);
}

TEST(Incidence, CancelStopsIt) {
  std::stop_source source;
  source.request_stop();
  const Complex complex = random_complex(1, 10, 10, 10);
  EXPECT_THROW((void)Incidence(complex.view(), {.cancel = source.get_token()}), Cancelled);
}

/// Spreads components along edges until nothing changes.
std::vector<std::uint32_t> components_by_spreading(const Complex& complex) {
  std::vector<std::uint32_t> least(complex.positions.size());
  for (std::uint32_t v = 0; v < least.size(); ++v) least[v] = v;
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (const auto& [a, b] : edges_of(complex)) {
      const std::uint32_t smaller = std::min(least[a], least[b]);
      is_changed = is_changed || least[a] != least[b];
      least[a] = least[b] = smaller;
    }
  }
  return least;
}

TEST(Components, EqualSpreadingAlongEdges) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const Complex complex = random_complex(seed, 4 + 2 * seed, seed * 5 % 23, seed * 3 % 17);
    EXPECT_EQ(components(complex.view()), components_by_spreading(complex));
  }
}

TEST(EulerCharacteristic, IsTheAlternatingSumOfBettiNumbers) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const Complex complex = random_complex(seed, 4 + seed % 9, seed * 5 % 23, seed * 3 % 17);
    const BettiNumbers betti = homology(complex.view());
    EXPECT_EQ(euler_characteristic(complex.view()), betti[0] - betti[1] + betti[2]);
  }
}

TEST(DisjointUnion, HasTheCellsColumnsAndBettiNumbersOfItsParts) {
  std::vector<Complex> parts{random_complex(3, 6, 4, 3), {}, random_complex(4, 5, 0, 6)};
  BettiNumbers sum{};
  for (Complex& part : parts) {
    const BettiNumbers betti = homology(part.view());
    for (std::size_t k = 0; k < 3; ++k) sum[k] += betti[k];
    if (part.positions.empty()) continue;
    part.vertex_columns = Columns(part.positions.size());
    part.vertex_columns.add<double>("radius", 1, static_cast<double>(part.positions.size()));
  }
  const Complex all = disjoint_union(parts);
  EXPECT_EQ(problem_of(all), "");
  EXPECT_EQ(all.positions.size(), 11U);
  EXPECT_EQ(all.edges, parts[0].edges);
  EXPECT_EQ(all.triangles[3],
            (Face{parts[2].triangles[0][0] + 6, parts[2].triangles[0][1] + 6, parts[2].triangles[0][2] + 6}));
  EXPECT_EQ(all.vertex_columns.get<double>("radius")[5], 6);
  EXPECT_EQ(all.vertex_columns.get<double>("radius")[6], 5);
  EXPECT_EQ(homology(all.view()), sum);
  EXPECT_TRUE(disjoint_union({}).positions.empty());
  parts[2].vertex_columns.erase("radius");
  EXPECT_THROW((void)disjoint_union(parts), InvalidOption);
}

}  // namespace
}  // namespace blum
