// Proves that homology() counts components, tunnels and voids over Z/2. The references are dense Gaussian elimination
// on random complexes, and spaces of known Betti numbers. Invalid complexes are rejected.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <set>
#include <stop_token>
#include <vector>

#include "blum/complex/homology.hpp"
#include "blum/core/error.hpp"
#include "blum/core/random.hpp"

namespace blum {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

struct Cells {
  std::size_t vertices = 0;
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

BettiNumbers homology_of(const Cells& c, const Context& context = {}) {
  return homology({c.vertices, c.edges, c.faces}, context);
}

constexpr std::size_t most_rows = 1024;
using Column = std::bitset<most_rows>;

/// The rank over Z/2 of a matrix given by its columns, by plain elimination row by row.
std::int64_t dense_rank(std::vector<Column> columns) {
  std::int64_t rank = 0;
  for (std::size_t row = 0; row < most_rows; ++row) {
    const auto first = columns.begin() + rank;
    const auto pivot = std::find_if(first, columns.end(), [&](const Column& c) { return c[row]; });
    if (pivot == columns.end()) continue;
    std::iter_swap(first, pivot);
    for (auto other = first + 1; other != columns.end(); ++other) {
      if ((*other)[row]) *other ^= *first;
    }
    ++rank;
  }
  return rank;
}

/// Betti numbers by definition: numbers of cells minus the ranks of the two boundary maps.
BettiNumbers dense_homology(const Cells& c) {
  std::set<Face> faces;
  std::set<Edge> edges;
  for (Edge e : c.edges) edges.insert({std::min(e[0], e[1]), std::max(e[0], e[1])});
  for (Face f : c.faces) {
    std::sort(f.begin(), f.end());
    faces.insert(f);
    for (const Edge& e : {Edge{f[0], f[1]}, Edge{f[0], f[2]}, Edge{f[1], f[2]}}) edges.insert(e);
  }
  const auto row = [&](std::uint32_t a, std::uint32_t b) {
    return static_cast<std::size_t>(std::distance(edges.begin(), edges.find({a, b})));
  };
  std::vector<Column> from_edges;
  for (const Edge& e : edges) from_edges.emplace_back().set(e[0]).set(e[1]);
  std::vector<Column> from_faces;
  for (const Face& f : faces) from_faces.emplace_back().set(row(f[0], f[1])).set(row(f[0], f[2])).set(row(f[1], f[2]));
  const std::int64_t rank_1 = dense_rank(from_edges);
  const std::int64_t rank_2 = dense_rank(from_faces);
  return {static_cast<std::int64_t>(c.vertices) - rank_1, static_cast<std::int64_t>(edges.size()) - rank_1 - rank_2,
          static_cast<std::int64_t>(faces.size()) - rank_2};
}

template <std::size_t n>
std::array<std::uint32_t, n> random_cell(std::size_t vertices, Random& random) {
  std::array<std::uint32_t, n> cell;
  do {
    for (auto& v : cell) v = static_cast<std::uint32_t>(random.below(vertices));
  } while (std::set<std::uint32_t>(cell.begin(), cell.end()).size() < n);
  return cell;
}

/// A rectangle of quads, each cut in two, with opposite sides glued: a torus, or with a flip a Klein bottle.
Cells glued_rectangle(std::uint32_t m, std::uint32_t n, bool flips) {
  Cells c;
  const auto vertex = [&](std::uint32_t i, std::uint32_t j) {
    if (j >= n && flips) i = m - i;
    return j % n * m + i % m;
  };
  c.vertices = std::size_t{m} * n;
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < m; ++i) {
      c.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      c.faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return c;
}

Cells sphere() {
  return {4, {}, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};
}

/// The projective plane with six vertices.
Cells projective_plane() {
  return {
      6,
      {},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}, {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}}};
}

Cells disjoint(const Cells& a, const Cells& b) {
  Cells sum = a;
  const auto shift = static_cast<std::uint32_t>(a.vertices);
  sum.vertices += b.vertices;
  for (const Edge& e : b.edges) sum.edges.push_back({e[0] + shift, e[1] + shift});
  for (const Face& f : b.faces) sum.faces.push_back({f[0] + shift, f[1] + shift, f[2] + shift});
  return sum;
}

/// The same complex with renumbered vertices. Its cells are reordered, rotated and listed several times.
Cells shuffled(const Cells& c, Random& random) {
  std::vector<std::uint32_t> name(c.vertices);
  for (std::uint32_t v = 0; v < c.vertices; ++v) name[v] = v;
  const auto shuffle = [&](auto& list) {
    for (std::size_t k = list.size(); k > 1; --k) std::swap(list[k - 1], list[random.below(k)]);
  };
  shuffle(name);
  Cells out{c.vertices, c.edges, c.faces};
  for (const Edge& e : c.edges) out.edges.push_back({e[1], e[0]});
  for (const Face& f : c.faces) out.faces.push_back({f[2], f[0], f[1]});
  for (const Face& f : c.faces) out.edges.push_back({f[2], f[0]});
  for (auto& e : out.edges) e = {name[e[0]], name[e[1]]};
  for (auto& f : out.faces) f = {name[f[0]], name[f[1]], name[f[2]]};
  shuffle(out.edges);
  shuffle(out.faces);
  return out;
}

TEST(Homology, RandomComplexesHaveTheRanksOfDenseMatrices) {
  Random random(7);
  std::set<BettiNumbers> seen;
  for (int trial = 0; trial < 800; ++trial) {
    Cells c;
    c.vertices = 3 + random.below(14);
    const std::size_t edges = random.below(2 * c.vertices);
    const std::size_t faces = random.below(1 + static_cast<std::uint64_t>(trial % 4 + 1) * c.vertices);
    for (std::size_t e = 0; e < edges; ++e) c.edges.push_back(random_cell<2>(c.vertices, random));
    for (std::size_t f = 0; f < faces; ++f) c.faces.push_back(random_cell<3>(c.vertices, random));
    const BettiNumbers expected = dense_homology(c);
    ASSERT_EQ(homology_of(c), expected) << "trial " << trial;
    ASSERT_EQ(homology_of(shuffled(c, random)), expected) << "trial " << trial << ", shuffled";
    seen.insert(expected);
  }
  EXPECT_GT(seen.size(), 100U) << "random complexes should differ";
}

TEST(Homology, RandomSurfacesWithSeamsHaveTheRanksOfDenseMatrices) {
  Random random(8);
  for (int trial = 0; trial < 60; ++trial) {
    Cells c = glued_rectangle(5, 6, trial % 2 == 1);
    c = disjoint(c, disjoint(sphere(), projective_plane()));
    // Random vertices are identified, so the surfaces meet and fold onto themselves.
    for (std::uint64_t k = random.below(8); k > 0; --k) {
      const Edge pair = random_cell<2>(c.vertices, random);
      for (Face& f : c.faces) std::replace(f.begin(), f.end(), pair[0], pair[1]);
    }
    std::erase_if(c.faces, [](const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[0] == f[2]; });
    for (std::uint64_t k = random.below(12); k > 0; --k) c.faces.push_back(random_cell<3>(c.vertices, random));
    for (std::uint64_t k = random.below(12); k > 0; --k) c.faces.erase(c.faces.begin() + trial % 40);
    ASSERT_EQ(homology_of(c), dense_homology(c)) << "trial " << trial;
  }
}

TEST(Homology, KnownSpaces) {
  EXPECT_EQ(homology_of({}), (BettiNumbers{0, 0, 0})) << "empty";
  EXPECT_EQ(homology_of({5, {}, {}}), (BettiNumbers{5, 0, 0})) << "isolated vertices";
  EXPECT_EQ(homology_of({3, {}, {{0, 1, 2}}}), (BettiNumbers{1, 0, 0})) << "a triangle";
  EXPECT_EQ(homology_of({3, {{0, 1}, {1, 2}, {2, 0}}, {}}), (BettiNumbers{1, 1, 0})) << "a circle";
  EXPECT_EQ(homology_of({5, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}}, {}}), (BettiNumbers{1, 2, 0}))
      << "a wedge of two circles";
  EXPECT_EQ(homology_of(sphere()), (BettiNumbers{1, 0, 1}));
  EXPECT_EQ(homology_of(projective_plane()), (BettiNumbers{1, 1, 1}));
  EXPECT_EQ(homology_of(glued_rectangle(5, 7, false)), (BettiNumbers{1, 2, 1})) << "a torus";
  EXPECT_EQ(homology_of(glued_rectangle(5, 7, true)), (BettiNumbers{1, 2, 1})) << "a Klein bottle";
  Cells strip = glued_rectangle(6, 6, false);
  strip.faces.resize(12);
  strip.vertices = 36;
  EXPECT_EQ(homology_of(strip), (BettiNumbers{25, 1, 0})) << "a ring, and the 24 vertices that it does not touch";
  Cells theta_sheet{5, {}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  EXPECT_EQ(homology_of(theta_sheet), (BettiNumbers{1, 0, 0})) << "three sheets at a seam";
  theta_sheet.edges = {{2, 3}, {3, 4}, {4, 2}};
  EXPECT_EQ(homology_of(theta_sheet), (BettiNumbers{1, 3, 0}));
}

TEST(Homology, DisjointUnionsAddUp) {
  Random random(9);
  const std::vector<Cells> parts{
      sphere(),    projective_plane(), glued_rectangle(4, 9, true), glued_rectangle(5, 5, false),
      {2, {}, {}}, {2, {{0, 1}}, {}}};
  Cells all;
  BettiNumbers expected{0, 0, 0};
  for (int k = 0; k < 20; ++k) {
    const Cells& part = parts[random.below(parts.size())];
    const BettiNumbers own = homology_of(part);
    all = disjoint(all, part);
    for (std::size_t d = 0; d < 3; ++d) expected[d] += own[d];
  }
  EXPECT_EQ(homology_of(all), expected);
  EXPECT_EQ(homology_of(shuffled(all, random)), expected);
}

/// Each sphere shares a disc with its neighbours, like rooms along a corridor. The number of voids equals the number of
/// rooms.
TEST(Homology, RoomsWithCommonWallsAreVoids) {
  const std::uint32_t rooms = 50;
  Cells c;
  c.vertices = 4 * (rooms + 1);
  for (std::uint32_t wall = 0; wall <= rooms; ++wall) {
    const std::uint32_t a = 4 * wall;
    c.faces.push_back({a, a + 1, a + 2});
    c.faces.push_back({a, a + 2, a + 3});
    if (wall == rooms) continue;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (k + 1) % 4;
      c.faces.push_back({a + k, a + next, a + 4 + next});
      c.faces.push_back({a + k, a + 4 + next, a + 4 + k});
    }
  }
  EXPECT_EQ(homology_of(c), (BettiNumbers{1, 0, rooms}));
}

TEST(Homology, RejectsInvalidComplexes) {
  EXPECT_THROW((void)homology_of({3, {{0, 3}}, {}}), InvalidOption);
  EXPECT_THROW((void)homology_of({3, {}, {{0, 1, 0xffffffffU}}}), InvalidOption);
  EXPECT_THROW((void)homology_of({3, {{1, 1}}, {}}), InvalidOption);
  EXPECT_THROW((void)homology_of({3, {}, {{0, 1, 0}}}), InvalidOption);
  EXPECT_THROW((void)homology_of({0, {}, {{0, 1, 2}}}), InvalidOption);
}

TEST(Homology, CancelStopsIt) {
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)homology_of(glued_rectangle(9, 9, false), {.cancel = source.get_token()}), Cancelled);
}

TEST(HomologySlow, LargeTorusInAnyOrder) {
  const auto timed = [](const char* what, const Cells& c, const BettiNumbers& expected) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(homology_of(c), expected) << what;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::cout << "500 x 500 grid, " << what << ": " << seconds.count() << " s\n";
  };
  Cells torus = glued_rectangle(500, 500, false);
  Random random(3);
  timed("torus", torus, {1, 2, 1});
  timed("torus, shuffled, each cell twice", shuffled(torus, random), {1, 2, 1});
  timed("Klein bottle", glued_rectangle(500, 500, true), {1, 2, 1});
  torus.faces.pop_back();
  timed("torus with a hole", torus, {1, 2, 0});
}

}  // namespace
}  // namespace blum
