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

/// A box that fails and could not be split further.
struct StuckBox {
  BoxCell box;
  ModelObstacle obstacle;
  double cuts_left = 0;
};

/// Some cubes of a grid, split into boxes, with the solid's components in their cells. Conventions are those of
/// CutGrid, with boxes for cubes, rectangles for squares and segments for edges. Components of rectangles and segments
/// that are whole cells of the grid have the same numbers as there.
class RefinedRegion {
 public:
  /// @param cubes  those that fail, and all around them, rising.
  /// @param triangles  for each of the cubes, all that may meet it.
  /// @param most_splits  limit for each cube.
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
  /// Returns the component of a rectangle to which an interval of a segment at its border belongs.
  [[nodiscard]] std::uint32_t component_of_interval(std::uint32_t rectangle, std::uint32_t segment,
                                                    std::uint32_t interval) const;
  /// Returns the component of a box to which a component of a rectangle at its border belongs.
  [[nodiscard]] std::uint32_t component_of_part(std::uint32_t box, std::uint32_t rectangle, std::uint32_t part) const;
  /// Returns the triangles that cross a segment, from below.
  [[nodiscard]] std::span<const std::uint32_t> crossings(std::uint32_t segment) const {
    return segments_[segment].crossings;
  }

  /// Returns the edges of the mesh around a component of a rectangle without intervals, each twice. Empty if the
  /// component has intervals.
  [[nodiscard]] std::vector<ArcEnd> loose_ends(std::uint32_t rectangle, std::uint32_t component) const;
  /// Returns a vertex of each body that lies wholly in a box. These bodies are the last components of the box.
  [[nodiscard]] std::span<const std::uint32_t> bodies_in(std::uint32_t box) const { return bodies_of_box_[box]; }

  /// Returns the boxes that fail; empty if all cells pass.
  [[nodiscard]] std::span<const StuckBox> stuck() const { return stuck_; }
  /// Returns the number of boxes that come from splits.
  [[nodiscard]] std::size_t split_boxes() const { return split_boxes_; }
  /// Returns the largest number of splits that led to a box.
  [[nodiscard]] int depth() const { return depth_; }

 private:
  struct SegmentSurface {
    std::vector<std::uint32_t> crossings;  ///< triangles
    bool begins_inside = false;
    std::uint32_t components = 0;
  };
  struct BoxArc {
    std::uint32_t triangle = 0;
    std::array<ArcEnd, 2> ends;  ///< ids on the border: segments
    std::uint32_t component = 0;
  };
  struct RectangleSurface {
    std::vector<BoxArc> arcs;
    std::vector<std::uint32_t> interval_component;  ///< for the intervals of all sides, one side after the other
    /// First entry of each segment among these; by segment.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> first_interval;
    std::uint32_t components = 0;
  };
  struct Scratch;

  /// Returns the first entry of a segment at the border of a rectangle.
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
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< by box: all that meet it
  std::unique_ptr<BoxCells> cells_;
  std::vector<std::uint8_t> inside_;  ///< by corner
  std::vector<SegmentSurface> segments_;
  std::vector<RectangleSurface> rectangles_;
  std::vector<std::vector<std::uint32_t>> rectangles_of_box_;  ///< rising
  std::vector<std::vector<std::uint32_t>> segments_of_box_;    ///< rising
  std::vector<std::vector<std::uint32_t>> part_component_;     ///< by box
  std::vector<std::uint32_t> box_components_;
  std::vector<std::vector<std::uint32_t>> bodies_of_box_;  ///< a vertex of each body that lies wholly in the box
  std::vector<StuckBox> stuck_;
  std::size_t split_boxes_ = 0;
  int depth_ = 0;
};

}  // namespace blum::detail
