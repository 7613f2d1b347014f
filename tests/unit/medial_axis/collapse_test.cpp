// Proves that every collapse is elementary, follows the order of importance and keeps the topology. The tests replay
// and check each recorded removal.
#include "medial_axis/cells/collapse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using detail::CellComplex;
using detail::collapse;
using detail::CollapseOrder;
using detail::Importance;
using detail::Removal;

std::vector<Cell> cells_of(const CellComplex& complex) {
  std::vector<Cell> cells;
  for (std::size_t node = 0; node < complex.bytes().size(); ++node) {
    for (CellAxes axes = 0; axes < 8; ++axes) {
      if (complex.contains(cell_at(node, axes))) cells.push_back(cell_at(node, axes));
    }
  }
  return cells;
}

/// Betti numbers of squares, edges and vertices, computed by the verifier.
BettiNumbers betti_of(const CellComplex& complex) {
  const CellLattice& lattice = complex.lattice();
  std::vector<std::uint32_t> number(lattice.node_count(), 0);
  ComplexView view;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const std::vector<Cell> cells = cells_of(complex);
  for (const Cell cell : cells) {
    if (dimension_of(cell) == 0) number[node_of(cell)] = static_cast<std::uint32_t>(view.vertex_count++);
  }
  for (const Cell cell : cells) {
    std::vector<std::uint32_t> corners;
    for (unsigned corner = 0; corner < 8; ++corner) {
      if ((corner & ~axes_of(cell)) != 0) continue;
      std::size_t node = node_of(cell);
      for (std::size_t a = 0; a < 3; ++a) node += (corner >> a & 1U) * lattice.stride(a);
      corners.push_back(number[node]);
    }
    if (corners.size() == 2) edges.push_back({corners[0], corners[1]});
    if (corners.size() != 4) continue;
    triangles.push_back({corners[0], corners[1], corners[2]});
    triangles.push_back({corners[1], corners[2], corners[3]});
  }
  view.edges = edges;
  view.triangles = triangles;
  return homology(view);
}

/// A set of voxels with the depths and importance that order a collapse.
struct Sample {
  VoxelSet voxels;
  CellComplex complex;
  std::vector<float> depth;
  Importance importance;
};

Sample random_sample(Random& random, double density, std::size_t important) {
  Sample s;
  const std::array<std::int64_t, 3> size{4 + static_cast<std::int64_t>(random.below(9)),
                                         4 + static_cast<std::int64_t>(random.below(9)),
                                         4 + static_cast<std::int64_t>(random.below(9))};
  s.voxels = test::random_voxels(size, density, random);
  s.complex = CellComplex(s.voxels, {});
  s.depth.resize(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  for (float& d : s.depth) d = static_cast<float>(random.uniform(-1, 4));
  const std::vector<Cell> cells = cells_of(s.complex);
  std::vector<Importance::Entry> entries;
  for (std::size_t n = 0; n < important && !cells.empty(); ++n) {
    const Cell cell = cells[random.below(cells.size())];
    if (dimension_of(cell) < 3) entries.push_back({cell, static_cast<float>(10 * (1 + random.below(17)))});
  }
  s.importance = Importance(s.complex.lattice(), entries);
  return s;
}

CollapseOrder collapse_of(const Sample& s) {
  return collapse(s.complex.clone(), {s.depth}, 0.25, s.importance, HUGE_VAL, {});
}

std::vector<Sample> random_samples() {
  Random random(1);
  std::vector<Sample> samples;
  for (int n = 0; n < 60; ++n) {
    samples.push_back(random_sample(random, n % 3 == 0 ? 0.9 : random.uniform(0.1, 1), random.below(120)));
  }
  return samples;
}

TEST(Collapse, TheBaseHasNoCubesAndKeepsTheTopology) {
  for (const Sample& s : random_samples()) {
    const CellComplex base = collapse_of(s).base;
    for (const Cell cell : cells_of(base)) {
      ASSERT_LT(dimension_of(cell), 3);
      ASSERT_TRUE(s.complex.contains(cell));
      base.lattice().for_each_face(cell, [&](Cell face) { ASSERT_TRUE(base.contains(face)); });
    }
    ASSERT_EQ(betti_of(base), betti_numbers(s.voxels));
  }
}

TEST(Collapse, EveryRemovalIsElementary) {
  std::size_t removals = 0;
  for (const Sample& s : random_samples()) {
    const CollapseOrder order = collapse_of(s);
    CellComplex left = order.base.clone();
    for (const Removal& r : order.removals) {
      ASSERT_TRUE(left.contains(r.cell) && left.contains(r.face));
      ASSERT_EQ(dimension_of(r.cell), dimension_of(r.face) + 1);
      ASSERT_EQ(left.only_coface(r.face), r.cell) << "the face is another cell's as well";
      ASSERT_EQ(left.only_coface(r.cell), r.cell);
      left.lattice().for_each_coface(r.cell, [&](Cell coface) { ASSERT_FALSE(left.contains(coface)); });
      left.erase(r.cell);
      left.erase(r.face);
      ++removals;
    }
    ASSERT_EQ(betti_of(left), betti_numbers(s.voxels));
    for (const Cell cell : cells_of(left)) ASSERT_EQ(left.only_coface(cell), cell) << "a free face is left over";
  }
  EXPECT_GT(removals, 1000U);
}

TEST(Collapse, LevelsAreTheLargestImportanceSoFar) {
  for (const Sample& s : random_samples()) {
    float level = 0;
    for (const Removal& r : collapse_of(s).removals) {
      level = std::max(level, s.importance.of(r.face));
      ASSERT_EQ(r.level, level);
      ASSERT_GE(r.level, s.importance.of(r.cell));
    }
  }
}

/// The removals up to a level are the first removals of the complete order.
TEST(Collapse, ALevelLimitTruncatesTheOrder) {
  std::size_t fewer = 0;
  for (const Sample& s : random_samples()) {
    const CollapseOrder all = collapse_of(s);
    const CollapseOrder some = collapse(s.complex.clone(), {s.depth}, 0.25, s.importance, 80, {});
    EXPECT_EQ(cells_of(some.base), cells_of(all.base));
    std::size_t count = 0;
    while (count < all.removals.size() && all.removals[count].level <= 80) ++count;
    ASSERT_EQ(some.removals.size(), count);
    for (std::size_t n = 0; n < count; ++n) {
      EXPECT_EQ(some.removals[n].cell, all.removals[n].cell);
      EXPECT_EQ(some.removals[n].face, all.removals[n].face);
    }
    fewer += count < all.removals.size() ? 1 : 0;
  }
  EXPECT_GT(fewer, 10U);
}

/// Each removed cube takes one square with it, which may be important if no other square is free. All other cells
/// removed with the cubes have no importance.
TEST(Collapse, ImportantCellsStayUntilTheirLevel) {
  for (const Sample& s : random_samples()) {
    const CellComplex base = collapse_of(s).base;
    std::size_t squares = 0;
    for (const Cell cell : cells_of(s.complex)) {
      if (base.contains(cell) || dimension_of(cell) == 3) continue;
      if (dimension_of(cell) == 2) {
        squares += s.importance.of(cell) > 0 ? 1 : 0;
      } else {
        ASSERT_EQ(s.importance.of(cell), 0);
      }
    }
    ASSERT_LE(squares, s.voxels.count());
  }
}

TEST(Collapse, ASlabCollapsesToItsImportantMiddle) {
  Sample s;
  s.voxels = VoxelSet({14, 12, 6});
  test::for_each_voxel(s.voxels.size(), 1, [&](auto i, auto j, auto k) { s.voxels.insert(i, j, k); });
  s.complex = CellComplex(s.voxels, {});
  for (const float of_layer : {0.0F, 1.0F, 2.0F, 2.0F, 1.0F, 0.0F}) s.depth.insert(s.depth.end(), 14 * 12, of_layer);
  std::vector<Importance::Entry> middle;
  for (std::int64_t j = 3; j < 9; ++j) {
    for (std::int64_t i = 3; i < 11; ++i) middle.push_back({cell_at(s.complex.lattice().node(i, j, 3), 3), 90});
  }
  s.importance = Importance(s.complex.lattice(), middle);
  const CollapseOrder order = collapse_of(s);
  const std::vector<Cell> base = cells_of(order.base);
  EXPECT_EQ(base.size(), s.importance.count());
  for (const Cell cell : base) EXPECT_EQ(s.importance.of(cell), 90);
  EXPECT_EQ(2 * order.removals.size(), base.size() - 1) << "a disc goes down to a vertex";
}

TEST(Collapse, ABlockWithoutImportanceBecomesAVertex) {
  Random random(2);
  Sample s = random_sample(random, 1, 0);
  const CollapseOrder order = collapse_of(s);
  EXPECT_EQ(cells_of(order.base).size(), 1U);
  EXPECT_TRUE(order.removals.empty());
}

TEST(Collapse, CancelStopsIt) {
  std::stop_source source;
  source.request_stop();
  const VoxelSet voxels = test::voxels_where({60, 60, 60}, [](auto...) { return true; });
  const std::vector<float> depth(60 * 60 * 60, 1);
  EXPECT_THROW((void)collapse(CellComplex(voxels, {}), {depth}, 1, {}, HUGE_VAL, {.cancel = source.get_token()}),
               Cancelled);
}

}  // namespace
}  // namespace blum
