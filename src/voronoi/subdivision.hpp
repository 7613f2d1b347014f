// Blum: the octree in which walls and surface are contractible. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/cell_tree.hpp"
#include "voronoi/cube_test.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/line_labels.hpp"
#include "voronoi/site_labels.hpp"
#include "voronoi/square_test.hpp"
#include "voronoi/voronoi_solid.hpp"

namespace blum::voronoi {

/// Splits squares and cubes of a CellTree. Each new edge starts at a node whose closest label is known, so no search
/// through all labels is needed. When an edge is split, its halves take over its events.
class CellSplitter {
 public:
  /// Side of the root cube, relative to the longest side of the mesh's bounding box.
  static constexpr double side_of_root = 1.4;

  CellSplitter(const MeshView& mesh, const SiteLabels& exact, const LabelGeometry& labels, CellTree& tree)
      : mesh_(mesh), exact_(exact), labels_(labels), lines_(exact, labels), tree_(tree) {}

  /// Makes the root cube around the mesh. Its sides lie outside the solid.
  /// @param grid  number of the grid, counted from 0. Each number has its own position.
  void add_root(int grid);
  /// Splits each of the given squares into four. They must have no children.
  void split_squares(std::span<const CellId> squares, const Context& context);
  /// Splits each of the given cubes into eight. Squares on their boundaries may already have children.
  void split_cubes(std::span<const CellId> cubes, const Context& context);

  [[nodiscard]] LineCounts counts() const { return lines_.counts(); }
  /// Returns the number of contradictions at nodes. Either a node lies in a thin region, or two edges that lead to the
  /// node yield different closest sites.
  [[nodiscard]] std::size_t contradictions() const { return contradictions_.load(); }

 private:
  /// A new edge with its events, before it is stored.
  struct NewEdge {
    GridEdge edge;
    std::vector<LineEvent> events;
  };

  void split_edges(std::vector<CellId> edges, const Context& context);
  void split_edge(CellId id);
  [[nodiscard]] bool is_below(const GridEdge& edge, const LineEvent& event, const Node& node) const;
  /// Finds the events along an edge and the label at its upper end, starting from the label at its lower end.
  void find_events(NewEdge& made, std::span<const LabelIndex> among, std::span<const std::uint32_t> triangles) const;
  void pass_over_thin(std::vector<LineEvent>& events) const;
  [[nodiscard]] std::vector<std::uint32_t> crossed(const GridEdge& edge,
                                                   std::span<const std::uint32_t> triangles) const;
  [[nodiscard]] double crossing_at(const GridEdge& edge, std::uint32_t triangle) const;
  [[nodiscard]] NewEdge edge_between(std::size_t axis, const Node& low, std::uint32_t length, LabelIndex first,
                                     std::span<const LabelIndex> among, std::span<const std::uint32_t> triangles) const;
  void store(CellId id, NewEdge& made);
  void expect_same(LabelIndex a, LabelIndex b) const;
  [[nodiscard]] std::array<NewEdge, 4> inner_edges(const GridSquare& square) const;
  [[nodiscard]] std::array<NewEdge, 6> inner_edges(const GridCube& cube) const;
  void place_children(CellId id);
  void place_squares(const GridCube& cube, CellId first_edge, CellId first_square);
  void place_children(const GridCube& cube, CellId first_square);
  void find_contents(GridSquare& square, std::span<const LabelIndex> among,
                     std::span<const std::uint32_t> triangles) const;
  void find_contents(GridCube& cube, const GridCube& parent) const;
  [[nodiscard]] bool is_outside(const GridSquare& square) const;
  [[nodiscard]] bool is_outside(const GridCube& cube) const;

  const MeshView mesh_;
  const SiteLabels& exact_;
  const LabelGeometry& labels_;
  LineLabels lines_;
  CellTree& tree_;
  mutable std::atomic<std::size_t> contradictions_{0};
};

struct SubdivisionOptions {
  int grid = 0;                        ///< number of the grid, which sets its position
  int least_depth = 0;                 ///< least depth of cubes that may contain points of the requested part
  int most_depth = 16;                 ///< largest depth of cubes
  int most_square_depth = 9;           ///< largest number of splits of a cube's square before the cube itself is split
  std::size_t most_cubes = 1'000'000;  ///< largest number of cubes, including those that are split
};

struct Subdivision {
  /// If there are more undecided lines and contradictory nodes than this, splitting stops, because the grid has a bad
  /// position.
  static constexpr std::size_t most_undecided = 200;

  CellTree tree;
  std::vector<CellId> leaves;  ///< cubes that meet the solid and have no children
  std::vector<FailingCube> failing;
  bool passed_at_first = false;  ///< true if no cube failed before leaves were refined
  bool was_full = false;         ///< true if the largest number of cubes was reached
  std::size_t splits = 0;        ///< number of splits of cubes that did not pass
  LineCounts lines;
  std::size_t contradictions = 0;
  std::size_t governors = 0;  ///< sum of the numbers of governors over all leaves
};

/// Returns those of the given leaves that must be split although they pass.
using Refine = FunctionRef<std::vector<CellId>(const CellTree&, std::span<const CellId>)>;

struct RefineNothing {
  std::vector<CellId> operator()(const CellTree& /*tree*/, std::span<const CellId> /*leaves*/) const { return {}; }
};

/// Splits a cube around the mesh until each leaf passes CubeTest or a limit of the options is reached. Then splits the
/// leaves that `refine` returns, in at most six rounds.
[[nodiscard]] Subdivision subdivide(const VoronoiSolid& solid, const SubdivisionOptions& options,
                                    const Context& context, const Refine& refine = RefineNothing{});

}  // namespace blum::voronoi
