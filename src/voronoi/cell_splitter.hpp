// Blum: splitting the cells of an octree, with what is closest along new edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/cell_tree.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/line_labels.hpp"
#include "voronoi/site_labels.hpp"

namespace blum::voronoi {

/// Splits squares and cubes of a CellTree. New edges begin at a node where the closest label is known, so that nothing
/// is ever searched among all labels; an edge that is split shares its events among its halves.
class CellSplitter {
 public:
  /// The side of the first cube, over the longest side of the box around the mesh.
  static constexpr double side_of_root = 1.4;

  CellSplitter(const MeshView& mesh, const SiteLabels& exact, const LabelGeometry& labels, CellTree& tree)
      : mesh_(mesh), exact_(exact), labels_(labels), lines_(exact, labels), tree_(tree) {}

  /// Makes one cube, around the mesh, whose sides lie outside of the solid.
  /// @param grid  a number: each has its place of its own.
  void add_root(int grid);
  /// Splits squares that have no children into four each.
  void split_squares(std::span<const CellId> squares, const Context& context);
  /// Splits cubes into eight each; their squares may have been split before.
  void split_cubes(std::span<const CellId> cubes, const Context& context);

  [[nodiscard]] LineCounts counts() const { return lines_.counts(); }
  /// Nodes in thin regions, or that two ways to them tell different sites of, as signs contradict each other.
  [[nodiscard]] std::size_t contradictions() const { return contradictions_.load(); }

 private:
  /// What is known of an edge to be made.
  struct NewEdge {
    GridEdge edge;
    std::vector<LineEvent> events;
  };

  void split_edges(std::vector<CellId> edges, const Context& context);
  void split_edge(CellId id);
  [[nodiscard]] bool is_below(const GridEdge& edge, const LineEvent& event, const Node& node) const;
  /// Finds what is closest along an edge from what is at its lower end.
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

}  // namespace blum::voronoi
