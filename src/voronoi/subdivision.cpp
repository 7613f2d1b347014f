#include "voronoi/subdivision.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum::voronoi {
namespace {

constexpr std::size_t grain = 8;

class Subdivider {
 public:
  Subdivider(const VoronoiSolid& solid, const SubdivisionOptions& options, Subdivision& out, const Context& context)
      : solid_(solid),
        options_(options),
        out_(out),
        context_(context),
        splitter_(solid.mesh, solid.exact, solid.labels, out.tree),
        surface_(solid.mesh, solid.table, out.tree.lattice),
        square_test_(solid.labels, surface_, out.tree),
        part_test_(solid, square_test_, surface_, out.tree),
        cube_test_(solid, surface_, out.tree) {}

  void run(const Refine& refine) {
    splitter_.add_root(options_.grid);
    waiting_[0] = {0};
    divide_all();
    out_.passed_at_first = out_.failing.empty();
    constexpr int most_rounds = 6;
    std::vector<CellId> seen;  // rising
    for (int round = 0; round < most_rounds && out_.failing.empty() && !is_full(); ++round) {
      std::vector<CellId> all = out_.leaves;
      std::sort(all.begin(), all.end());
      std::vector<CellId> fresh;
      std::set_difference(all.begin(), all.end(), seen.begin(), seen.end(), std::back_inserter(fresh));
      seen = std::move(all);
      const std::vector<CellId> cubes = refine(out_.tree, fresh);
      if (cubes.empty() || out_.tree.cubes.size() + 8 * cubes.size() > options_.most_cubes) break;
      split_leaves(cubes);
      divide_all();
    }
    out_.lines = splitter_.counts();
    out_.contradictions = splitter_.contradictions();
    for (const CellId leaf : out_.leaves) out_.governors += out_.tree.cubes[leaf].governors.size();
  }

 private:
  [[nodiscard]] std::uint32_t count_squares(const GridCube& cube) const {
    std::uint32_t count = 0;
    for (const CellId square : cube.squares) out_.tree.visit_leaf_squares(square, [&](CellId) { ++count; });
    return count;
  }

  /// Divides the cubes that wait. What passes may have its squares split for a neighbour afterwards, which tells more
  /// of its boundary: it is tested again.
  void divide_all() {
    divide();
    for (;;) {
      std::vector<CellId> changed;
      for (const CellId leaf : out_.leaves) {
        const GridCube& cube = out_.tree.cubes[leaf];
        if (cube.state == CubeState::passed && count_squares(cube) != cube.tested_squares) changed.push_back(leaf);
      }
      if (changed.empty()) return;
      std::sort(changed.begin(), changed.end());
      std::erase_if(out_.leaves, [&](CellId leaf) { return std::binary_search(changed.begin(), changed.end(), leaf); });
      for (const CellId cube : changed) waiting_[depth_of(cube)].push_back(cube);
      divide();
    }
  }

  /// Divides the cubes that wait, the largest first.
  void divide() {
    while (!waiting_.empty()) {
      const auto [depth, cubes] = *waiting_.begin();
      waiting_.erase(waiting_.begin());
      divide(depth, cubes);
    }
  }

  /// @param cubes  all of one size.
  void divide(int depth, const std::vector<CellId>& cubes) {
    const bool is_last = depth >= options_.most_depth || is_full();
    std::vector<CellId> to_test;
    std::vector<CellId> crowded;
    for (const CellId cube : cubes) {
      (!is_last && is_crowded(out_.tree.cubes[cube], depth) ? crowded : to_test).push_back(cube);
    }
    std::vector<FailingCube> failed = test(to_test);
    if (!is_last && out_.tree.cubes.size() + 8 * (crowded.size() + failed.size()) <= options_.most_cubes) {
      out_.splits += failed.size();
      for (const FailingCube& one : failed) crowded.push_back(one.cube);
      std::sort(crowded.begin(), crowded.end());
      split(depth, crowded);
      return;
    }
    out_.was_full = out_.was_full || !is_last;
    const std::vector<FailingCube> more = test(crowded);
    failed.insert(failed.end(), more.begin(), more.end());
    for (const FailingCube& one : failed) out_.leaves.push_back(one.cube);
    out_.failing.insert(out_.failing.end(), failed.begin(), failed.end());
  }

  void split(int depth, const std::vector<CellId>& cubes) {
    splitter_.split_cubes(cubes, context_);
    for (const CellId cube : cubes) {
      for (CellId k = 0; k < 8; ++k) {
        const CellId child = out_.tree.cubes[cube].children + k;
        if (out_.tree.cubes[child].state != CubeState::trivial) waiting_[depth + 1].push_back(child);
      }
    }
  }

  [[nodiscard]] int depth_of(CellId cube) const {
    int depth = 0;
    while (out_.tree.cubes[cube].length << depth < Lattice::most) ++depth;
    return depth;
  }

  /// Splits leaves that pass, but are to be smaller.
  void split_leaves(const std::vector<CellId>& cubes) {
    std::map<int, std::vector<CellId>> by_depth;
    std::vector<CellId> gone;
    for (const CellId cube : cubes) {
      if (depth_of(cube) >= options_.most_depth) continue;
      by_depth[depth_of(cube)].push_back(cube);
      gone.push_back(cube);
    }
    std::sort(gone.begin(), gone.end());
    std::erase_if(out_.leaves, [&](CellId leaf) { return std::binary_search(gone.begin(), gone.end(), leaf); });
    for (auto& [depth, of_depth] : by_depth) {
      std::sort(of_depth.begin(), of_depth.end());
      split(depth, of_depth);
    }
  }

  /// Whether the part that is asked for may meet a cube.
  [[nodiscard]] bool may_hold_some(const GridCube& cube) const {
    if (solid_.rule.is_all()) return true;
    return std::any_of(cube.governors.begin(), cube.governors.end(), [&](LabelIndex label) {
      return solid_.labels[label].site != solid_.labels[cube.governors.front()].site;
    });
  }

  /// Whether a cube has so many governors that its test is not worth it, and splitting it makes them fewer.
  [[nodiscard]] bool is_crowded(const GridCube& cube, int depth) const {
    constexpr std::size_t many = 64;
    if (depth < 1) return true;
    if (depth < options_.least_depth && may_hold_some(cube)) return true;
    return cube.governors.size() > many && cube.governors.size() * 10 < cube.governors_of_parent * 9;
  }

  /// Whether there are so many cells, or so many that are not certain, that no more are made.
  [[nodiscard]] bool is_full() const {
    constexpr std::size_t squares_per_cube = 16;
    return out_.tree.squares.size() > squares_per_cube * options_.most_cubes ||
           splitter_.counts().undecided + splitter_.contradictions() > Subdivision::most_undecided;
  }

  /// Splits squares of cubes until each is resolved or small.
  void resolve_squares(const std::vector<CellId>& cubes) {
    std::vector<CellId> squares;
    for (const CellId cube : cubes) {
      for (const CellId square : out_.tree.cubes[cube].squares) {
        out_.tree.visit_leaf_squares(square, [&](CellId leaf) { squares.push_back(leaf); });
      }
    }
    const std::uint32_t length = cubes.empty() ? 1 : out_.tree.cubes[cubes.front()].length;
    const std::uint32_t least = std::max<std::uint32_t>(2, length >> options_.most_square_depth);
    while (!squares.empty()) {
      std::sort(squares.begin(), squares.end());
      squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
      std::erase_if(squares, [&](CellId id) { return out_.tree.squares[id].state == SquareState::resolved; });
      std::vector<std::uint8_t> is_left(squares.size());
      parallel_for(context_, squares.size(), grain, {}, [&](const WorkRange& range) {
        for (std::size_t k = range.begin; k < range.end; ++k) {
          is_left[k] = part_test_.resolve(out_.tree.squares[squares[k]]) ? 0 : 1;
        }
      });
      std::vector<CellId> left;
      for (std::size_t k = 0; k < squares.size(); ++k) {
        if (is_left[k] != 0 && out_.tree.squares[squares[k]].length >= 2 * least) left.push_back(squares[k]);
      }
      if (is_full()) return;
      splitter_.split_squares(left, context_);
      squares.clear();
      for (const CellId square : left) {
        for (CellId k = 0; k < 4; ++k) squares.push_back(out_.tree.squares[square].children + k);
      }
    }
  }

  /// Adds cubes that pass to the leaves; returns the others.
  std::vector<FailingCube> test(const std::vector<CellId>& cubes) {
    resolve_squares(cubes);
    std::vector<VoronoiObstacle> obstacles(cubes.size());
    parallel_for(context_, cubes.size(), grain, {}, [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        obstacles[k] = cube_test_.run(out_.tree.cubes[cubes[k]]).obstacle;
      }
    });
    std::vector<FailingCube> failed;
    for (std::size_t k = 0; k < cubes.size(); ++k) {
      GridCube& cube = out_.tree.cubes[cubes[k]];
      cube.tested_squares = count_squares(cube);
      if (obstacles[k] == VoronoiObstacle::none) {
        cube.state = CubeState::passed;
        out_.leaves.push_back(cubes[k]);
      } else {
        cube.state = CubeState::failed;
        failed.push_back({cubes[k], obstacles[k]});
      }
    }
    return failed;
  }

  const VoronoiSolid& solid_;
  const SubdivisionOptions& options_;
  Subdivision& out_;
  const Context& context_;
  CellSplitter splitter_;
  SurfaceInCells surface_;
  SquareTest square_test_;
  PartSquareTest part_test_;
  CubeTest cube_test_;
  std::map<int, std::vector<CellId>> waiting_;  ///< by depth
};

}  // namespace

Subdivision subdivide(const VoronoiSolid& solid, const SubdivisionOptions& options, const Context& context,
                      const Refine& refine) {
  Subdivision out;
  Subdivider(solid, options, out, context).run(refine);
  return out;
}

}  // namespace blum::voronoi
