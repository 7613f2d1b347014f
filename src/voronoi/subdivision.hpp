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

/// Splits squares and cubes of a CellTree. New edges begin at a node with a known closest label, so no search covers
/// all labels. An edge that is split shares its events among its halves.
class CellSplitter {
 public:
  /// Side of the first cube, divided by the longest side of the box around the mesh.
  static constexpr double side_of_root = 1.4;

  CellSplitter(const MeshView& mesh, const SiteLabels& exact, const LabelGeometry& labels, CellTree& tree)
      : mesh_(mesh), exact_(exact), labels_(labels), lines_(exact, labels), tree_(tree) {}

  /// Makes one cube around the mesh, whose sides lie outside of the solid.
  /// @param grid  number of the grid; each has its own position.
  void add_root(int grid);
  /// Splits squares that have no children into four each.
  void split_squares(std::span<const CellId> squares, const Context& context);
  /// Splits cubes into eight each; their squares may have been split before.
  void split_cubes(std::span<const CellId> cubes, const Context& context);

  [[nodiscard]] LineCounts counts() const { return lines_.counts(); }
  /// Returns the number of nodes at which signs contradict each other. These are nodes in thin regions, and nodes for
  /// which two ways to them yield different sites.
  [[nodiscard]] std::size_t contradictions() const { return contradictions_.load(); }

 private:
  /// An edge to be made, with its events.
  struct NewEdge {
    GridEdge edge;
    std::vector<LineEvent> events;
  };

  void split_edges(std::vector<CellId> edges, const Context& context);
  void split_edge(CellId id);
  [[nodiscard]] bool is_below(const GridEdge& edge, const LineEvent& event, const Node& node) const;
  /// Finds the labels along an edge from the one at its lower end.
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
  int grid = 0;                        ///< number of the grid's position
  int least_depth = 0;                 ///< cubes that may meet the part are split at least this often
  int most_depth = 16;                 ///< cubes are split at most this often
  int most_square_depth = 9;           ///< squares of a cube are split at most this often before the cube is
  std::size_t most_cubes = 1'000'000;  ///< largest number of cubes, including those that are split
};

struct Subdivision {
  /// With more undecided lines and contradictory nodes than this, splitting stops: the grid's position is bad.
  static constexpr std::size_t most_undecided = 200;

  CellTree tree;
  std::vector<CellId> leaves;  ///< cubes that meet the solid and have no children
  std::vector<FailingCube> failing;
  bool passed_at_first = false;  ///< true if no cube failed before leaves were refined
  bool was_full = false;         ///< true if the largest number of cubes was reached
  std::size_t splits = 0;        ///< number of splits of cubes that did not pass
  LineCounts lines;
  std::size_t contradictions = 0;
  std::size_t governors = 0;  ///< sum over leaves
};

/// Returns those of some leaves that must become smaller though they pass.
using Refine = FunctionRef<std::vector<CellId>(const CellTree&, std::span<const CellId>)>;

struct RefineNothing {
  std::vector<CellId> operator()(const CellTree& /*tree*/, std::span<const CellId> /*leaves*/) const { return {}; }
};

/// Splits a cube around the mesh until each leaf passes CubeTest or has the largest depth. Then splits the leaves that
/// `refine` returns, six times at most.
[[nodiscard]] Subdivision subdivide(const VoronoiSolid& solid, const SubdivisionOptions& options,
                                    const Context& context, const Refine& refine = RefineNothing{});

}  // namespace blum::voronoi
