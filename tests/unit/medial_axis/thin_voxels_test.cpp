// Proves that thinning keeps the topology and all important cells, for any number of threads. The result equals
// sequential thinning in the order of depth.
#include "medial_axis/cells/attached_voxels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stop_token>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using detail::AttachedVoxels;
using detail::CellComplex;
using detail::Importance;
using detail::thin_voxels;
using detail::VoxelSolid;

using Place = std::array<std::int64_t, 3>;

struct Sample {
  VoxelSolid solid;
  CellLattice lattice;
  Importance importance;
};

/// All cells of a voxel except the voxel itself.
std::vector<Cell> border_of(const CellLattice& lattice, const Place& at) {
  std::vector<Cell> cells;
  for (std::int64_t n = 0; n < 27; ++n) {
    const Place half{n % 3, n / 3 % 3, n / 9};
    CellAxes axes = 0;
    for (std::size_t a = 0; a < 3; ++a) axes |= half[a] == 1 ? 1U << a : 0;
    const std::size_t node = lattice.node(at[0] + half[0] / 2, at[1] + half[1] / 2, at[2] + half[2] / 2);
    if (axes != 7) cells.push_back(cell_at(node, axes));
  }
  return cells;
}

/// Gives importance to some cells of the voxels of a set.
void add_importance(Sample& s, double density, Random& random) {
  s.lattice = CellLattice(s.solid.voxels.size());
  std::vector<Importance::Entry> entries;
  test::for_each_voxel(s.solid.voxels.size(), 1, [&](auto i, auto j, auto k) {
    if (!s.solid.voxels.contains(i, j, k)) return;
    for (const Cell cell : border_of(s.lattice, {i, j, k})) {
      if (random.uniform() < density) entries.push_back({cell, 30});
    }
  });
  s.importance = Importance(s.lattice, entries);
}

/// Random voxels with random depths, many of them equal. Voxels outside the solid may be deep.
Sample random_sample(const Place& size, double density, double important, Random& random) {
  Sample s;
  s.solid.grid.size = size;
  s.solid.grid.spacing = {1, 0.5, 2};
  s.solid.voxels = test::random_voxels(size, density, random);
  s.solid.depth = Buffer<float>(s.solid.grid.node_count());
  for (float& d : s.solid.depth) d = static_cast<float>(random.below(9)) - 2;
  add_importance(s, important, random);
  return s;
}

/// The voxels of an image with their true depths.
Sample sample_of(const VoxelImage& image, double important, Random& random) {
  Sample s;
  Field field = distance_transform(image);
  s.solid.grid = image.grid;
  s.solid.voxels = selected_voxels(image, {});
  s.solid.depth = std::move(field.distance);
  for (float& d : s.solid.depth) d = -d;
  add_importance(s, important, random);
  return s;
}

std::vector<Sample> samples() {
  Random random(1);
  std::vector<Sample> all;
  for (int n = 0; n < 40; ++n) {
    const Place size{3 + static_cast<std::int64_t>(random.below(14)), 3 + static_cast<std::int64_t>(random.below(12)),
                     3 + static_cast<std::int64_t>(random.below(12))};
    all.push_back(random_sample(size, random.uniform(0.2, 1), n % 2 == 0 ? 0 : 0.02, random));
  }
  all.push_back(random_sample({140, 5, 6}, 0.9, 0.01, random));
  all.push_back(sample_of(make_ball_image({.size = 24, .inner_radius = 0.5}), 0, random));
  all.push_back(sample_of(make_tube_image({.nodes = 2, .pitch = 14, .radius = 3}), 0.001, random));
  all.push_back(sample_of(make_ball_image({.size = 20, .spacing = {1, 1.5, 3}}), 0.01, random));
  return all;
}

VoxelSet thinned(const Sample& s, int threads = 0) {
  const CellComplex model(s.solid.voxels, {});
  return thin_voxels(s.solid, {model, s.solid.voxels, s.importance}, s.lattice, s.importance, {.threads = threads});
}

/// True if an important cell of a voxel belongs to no other voxel.
bool holds_alone(const Sample& s, const VoxelSet& voxels, const Place& at) {
  VoxelSet others = voxels;
  others.erase(at[0], at[1], at[2]);
  for (const Cell cell : border_of(s.lattice, at)) {
    if (s.importance.of(cell) == 0) continue;
    bool is_shared = false;
    for (int n = 0; n < 27; ++n) {
      const Place next{at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
      if (!others.contains(next[0], next[1], next[2])) continue;
      const std::vector<Cell> cells = border_of(s.lattice, next);
      is_shared = is_shared || std::find(cells.begin(), cells.end(), cell) != cells.end();
    }
    if (!is_shared) return true;
  }
  return false;
}

/// Removes one voxel at a time, the shallowest first.
VoxelSet plainly_thinned(const Sample& s) {
  struct Turn {
    float depth;
    std::size_t index;
    Place at;
  };
  std::vector<Turn> turns;
  test::for_each_voxel(s.solid.voxels.size(), 1, [&](auto i, auto j, auto k) {
    const std::size_t index = s.solid.grid.index(i, j, k);
    const float depth = std::max(s.solid.depth[index], std::numeric_limits<float>::min());
    if (s.solid.voxels.contains(i, j, k)) turns.push_back({depth, index, {i, j, k}});
  });
  std::sort(turns.begin(), turns.end(),
            [](const Turn& a, const Turn& b) { return a.depth != b.depth ? a.depth < b.depth : a.index < b.index; });
  VoxelSet left = s.solid.voxels;
  for (const Turn& turn : turns) {
    const auto [i, j, k] = turn.at;
    if (is_simple(neighbourhood(left, i, j, k)) && !holds_alone(s, left, turn.at)) left.erase(i, j, k);
  }
  return left;
}

TEST(ThinVoxels, EqualsPlainThinningInTheOrderOfDepth) {
  for (const Sample& s : samples()) ASSERT_EQ(thinned(s), plainly_thinned(s));
}

TEST(ThinVoxels, KeepsTheTopology) {
  for (const Sample& s : samples()) ASSERT_EQ(betti_numbers(thinned(s)), betti_numbers(s.solid.voxels));
}

TEST(ThinVoxels, ImportantCellsKeepAVoxel) {
  for (const Sample& s : samples()) {
    const CellComplex before(s.solid.voxels, {});
    const CellComplex after(thinned(s), {});
    for (std::size_t node = 0; node < s.lattice.node_count(); ++node) {
      for (CellAxes axes = 0; axes < 7; ++axes) {
        const Cell cell = cell_at(node, axes);
        if (s.importance.of(cell) == 0) continue;
        ASSERT_EQ(after.contains(cell), before.contains(cell));
      }
    }
  }
}

TEST(ThinVoxels, ThreadsDoNotMatter) {
  for (const Sample& s : samples()) {
    const VoxelSet one = thinned(s, 1);
    ASSERT_EQ(thinned(s, 2), one);
    ASSERT_EQ(thinned(s, 7), one);
  }
}

TEST(ThinVoxels, ASolidBallBecomesAVoxel) {
  Random random(2);
  const Sample s = sample_of(make_ball_image({.size = 30}), 0, random);
  EXPECT_EQ(thinned(s).count(), 1U);
}

TEST(ThinVoxels, CancelStopsIt) {
  Random random(3);
  const Sample s = sample_of(make_ball_image({.size = 20}), 0, random);
  std::stop_source source;
  source.request_stop();
  const CellComplex model(s.solid.voxels, {});
  const AttachedVoxels attached(model, s.solid.voxels, s.importance);
  EXPECT_THROW((void)thin_voxels(s.solid, attached, s.lattice, s.importance, {.cancel = source.get_token()}),
               Cancelled);
}

}  // namespace
}  // namespace blum
