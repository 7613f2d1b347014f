// Blum: the octree in which walls and surface are contractible. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "voronoi/cell_splitter.hpp"
#include "voronoi/cube_test.hpp"
#include "voronoi/part_square_test.hpp"
#include "voronoi/voronoi_solid.hpp"

namespace blum::voronoi {

struct SubdivisionOptions {
  int grid = 0;                        ///< which place of the grid
  int least_depth = 0;                 ///< all cubes that meet the solid are split at least so often
  int most_depth = 16;                 ///< and at most so often
  int most_square_depth = 9;           ///< how often squares of a cube are split before the cube is
  std::size_t most_cubes = 1'000'000;  ///< those that are split included
};

struct Subdivision {
  /// With more lines or nodes that are not certain nothing is split any more: the place of the grid is a bad one.
  static constexpr std::size_t most_undecided = 200;

  CellTree tree;
  std::vector<CellId> leaves;  ///< cubes that meet the solid and have no children
  std::vector<FailingCube> failing;
  bool passed_at_first = false;  ///< whether none failed before leaves were refined
  bool was_full = false;         ///< whether there were as many cubes as there may be
  std::size_t splits = 0;        ///< of cubes that did not pass
  LineCounts lines;
  std::size_t contradictions = 0;
  std::size_t governors = 0;  ///< sum over leaves
};

/// Which of some leaves are to be smaller though they pass.
using Refine = FunctionRef<std::vector<CellId>(const CellTree&, std::span<const CellId>)>;

struct RefineNothing {
  std::vector<CellId> operator()(const CellTree& /*tree*/, std::span<const CellId> /*leaves*/) const { return {}; }
};

/// Splits a cube around the mesh until each leaf passes CubeTest, or is at the largest depth; and then those that
/// `refine` asks for, six times at most.
[[nodiscard]] Subdivision subdivide(const VoronoiSolid& solid, const SubdivisionOptions& options,
                                    const Context& context, const Refine& refine = RefineNothing{});

}  // namespace blum::voronoi
