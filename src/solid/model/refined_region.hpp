// Blum: cubes of a grid that are split until all components in them are balls. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "solid/model/box_cells.hpp"
#include "solid/model/box_splitter.hpp"
#include "solid/model/cut_grid.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// A box that fails and could not be split further, with its obstacle.
struct StuckBox {
  BoxCell box;
  ModelObstacle obstacle;
  double cuts_left = 0;
};

/// Some cubes of a grid, split into boxes, with the solid's components in the cells of the boxes. Conventions are those
/// of CutGrid, with boxes for cubes, rectangles for squares and segments for edges. If a rectangle or segment is a
/// whole cell of the grid, its components have the same numbers as in CutGrid.
class RefinedRegion {
 public:
  /// @param cubes  the cubes to split and all cubes around them, in ascending order.
  /// @param triangles  for each of the cubes: all triangles that may meet it.
  /// @param most_splits  limit on successive cuts of each cube.
  /// @param finer  see BoxSplitter.
  /// @throws Cancelled.
  RefinedRegion(const SurfaceMesh& mesh, const CutGrid& grid, std::span<const Cell> cubes,
                std::vector<std::vector<std::uint32_t>> triangles, int most_splits, std::span<const Box3> finer,
                const Context& context);

  [[nodiscard]] std::span<const Cell> cubes() const { return cubes_; }
  [[nodiscard]] std::span<const BoxCell> boxes() const { return boxes_; }
  [[nodiscard]] const BoxCells& cells() const { return *cells_; }
  [[nodiscard]] bool is_inside(std::uint32_t corner) const { return inside_[corner] != 0; }
  [[nodiscard]] std::uint32_t components_of_segment(std::uint32_t segment) const {
    return segments_[segment].components;
  }
  [[nodiscard]] std::uint32_t components_of_rectangle(std::uint32_t rectangle) const {
    return rectangles_[rectangle].components;
  }
  [[nodiscard]] std::uint32_t components_of_box(std::uint32_t box) const { return box_components_[box]; }
  /// Returns the component of a rectangle that contains an interval of a segment at the rectangle's border.
  [[nodiscard]] std::uint32_t component_of_interval(std::uint32_t rectangle, std::uint32_t segment,
                                                    std::uint32_t interval) const;
  /// Returns the component of a box that contains component `part` of a rectangle at the box's border.
  [[nodiscard]] std::uint32_t component_of_part(std::uint32_t box, std::uint32_t rectangle, std::uint32_t part) const;
  /// Returns the triangles that cross a segment, in the order of their crossings upwards along it.
  [[nodiscard]] std::span<const std::uint32_t> crossings(std::uint32_t segment) const {
    return segments_[segment].crossings;
  }

  /// For a component of a rectangle without intervals, returns the edges of the mesh on its border, each twice. Empty
  /// if the component has intervals.
  [[nodiscard]] std::vector<ArcEnd> loose_ends(std::uint32_t rectangle, std::uint32_t component) const;
  /// Returns one vertex of each body that lies wholly in a box. These bodies are the last components of the box.
  [[nodiscard]] std::span<const std::uint32_t> bodies_in(std::uint32_t box) const { return bodies_of_box_[box]; }

  /// Returns the boxes that fail; empty if all boxes pass.
  [[nodiscard]] std::span<const StuckBox> stuck() const { return stuck_; }
  /// Returns the number of boxes that are smaller than a cube.
  [[nodiscard]] std::size_t split_boxes() const { return split_boxes_; }
  /// Returns the largest number of successive cuts between a cube and a box.
  [[nodiscard]] int depth() const { return depth_; }

 private:
  struct SegmentSurface {
    std::vector<std::uint32_t> crossings;  ///< triangles, upwards along the segment
    bool begins_inside = false;
    std::uint32_t components = 0;
  };
  struct BoxArc {
    std::uint32_t triangle = 0;
    std::array<ArcEnd, 2> ends;  ///< the id of an end on the border is a segment
    std::uint32_t component = 0;
  };
  struct RectangleSurface {
    std::vector<BoxArc> arcs;
    std::vector<std::uint32_t> interval_component;  ///< for all intervals of the sides, in order
    /// Pairs of a segment and the index of its first interval in `interval_component`; sorted by segment.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> first_interval;
    std::uint32_t components = 0;
  };
  struct Scratch;

  /// Returns the index in `interval_component` of the first interval of a segment.
  [[nodiscard]] static std::uint32_t first_interval(const RectangleSurface& rectangle, std::uint32_t segment);
  [[nodiscard]] SplitBox whole_box(Cell cube, std::vector<std::uint32_t> triangles) const;
  void take(SplitBox part);
  void connect(const Context& context);
  void find_crossings(std::uint32_t segment);
  void find_inside();
  void find_arcs(std::uint32_t rectangle);
  void connect_rectangle(std::uint32_t rectangle, Scratch& scratch);
  void connect_box(std::uint32_t box, Scratch& scratch);
  void join_at_segments(std::uint32_t box, CubeComponents& components) const;
  [[nodiscard]] const std::vector<std::uint32_t>& candidates(std::span<const BoxRef> boxes) const;
  [[nodiscard]] std::size_t part_offset(std::uint32_t box, std::uint32_t rectangle) const;

  const SurfaceMesh& mesh_;
  const CutGrid& grid_;
  std::vector<Cell> cubes_;
  std::vector<BoxCell> boxes_;
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< for each box: all that meet it
  std::unique_ptr<BoxCells> cells_;
  std::vector<std::uint8_t> inside_;  ///< for each corner: 1 if inside the solid, otherwise 0
  std::vector<SegmentSurface> segments_;
  std::vector<RectangleSurface> rectangles_;
  std::vector<std::vector<std::uint32_t>> rectangles_of_box_;  ///< for each box, ascending
  std::vector<std::vector<std::uint32_t>> segments_of_box_;    ///< for each box, ascending
  std::vector<std::vector<std::uint32_t>> part_component_;     ///< for each box and part
  std::vector<std::uint32_t> box_components_;
  std::vector<std::vector<std::uint32_t>> bodies_of_box_;  ///< for each box: see bodies_in()
  std::vector<StuckBox> stuck_;
  std::size_t split_boxes_ = 0;
  int depth_ = 0;
};

}  // namespace blum::detail
