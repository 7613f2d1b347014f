// Blum: the cells of a decomposition into boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/cell_lattice.hpp"
#include "solid/model/grid_planes.hpp"

namespace blum::detail {

struct BoxCell;

/// Tree of planes over boxes that fill a larger box and come from cutting it repeatedly.
class SplitTree {
 public:
  SplitTree() = default;
  /// @param boxes  all boxes; the span must stay valid.
  /// @param own  the boxes of this tree, at least one.
  SplitTree(std::span<const BoxCell> boxes, std::vector<std::uint32_t> own);

  /// Returns the box that holds a point of the large box, if the point is moved infinitesimally along each axis: down
  /// (false) or up. Cost: the depth of the tree.
  [[nodiscard]] std::uint32_t find(const Vec3d& p, const std::array<bool, 3>& up) const;

 private:
  struct Node {
    std::size_t axis = 3;  ///< 3: a leaf
    double at = 0;
    std::uint32_t below = 0;  ///< node; for leaves the box
    std::uint32_t above = 0;
  };

  std::vector<Node> nodes_;
};

/// A part of a cube of a grid, or the whole cube.
struct BoxCell {
  Vec3d low;
  Vec3d high;
  Cell cube = 0;
};

/// Returns a corner of a box.
/// @param k  bits x, y, z: high.
inline Vec3d corner_of(const BoxCell& box, std::size_t k) {
  return {(k & 1U) != 0 ? box.high.x : box.low.x, (k & 2U) != 0 ? box.high.y : box.low.y,
          (k & 4U) != 0 ? box.high.z : box.low.z};
}

/// A box by its index, or a cube of the grid around all boxes.
struct BoxRef {
  static constexpr std::uint32_t nothing = 0xffffffffU;
  std::uint32_t id = nothing;  ///< of a box, or a cube (Cell)
  bool is_box = false;

  [[nodiscard]] bool exists() const { return is_box || id != nothing; }
  [[nodiscard]] friend auto operator<=>(const BoxRef&, const BoxRef&) = default;
};

/// An edge of the decomposition: a part of edges of boxes around which the boxes are the same.
struct BoxSegment {
  std::size_t axis = 0;
  std::array<std::uint32_t, 2> ends{0, 0};  ///< corners, the lower one first
  /// Boxes below and above along the next axis (bit 0) and the one after (bit 1). Two may be equal.
  std::array<BoxRef, 4> around;
};

/// The rectangle shared by two boxes. At least one of them is not a cube of the grid around.
struct BoxRectangle {
  std::size_t axis = 0;         ///< axis across which it lies
  std::array<BoxRef, 2> boxes;  ///< below and above
  /// Segments of the border. The first two sides run along the lower of the other axes, at its low and its high end.
  /// The last two run along the upper one. Each side is rising.
  std::array<std::vector<std::uint32_t>, 4> sides;
};

/// The cells of the common refinement of boxes that fill some cubes of a grid, and of the cubes around them. Edges and
/// rectangles may meet without sharing all of their ends: a corner of one may lie inside a side of another.
class BoxCells {
 public:
  /// @param boxes  fill the cubes of which they are parts. The span must stay valid.
  /// @throws Cancelled.
  BoxCells(std::span<const BoxCell> boxes, const GridPlanes& planes, const CellLattice& lattice,
           const Context& context = {});

  [[nodiscard]] std::span<const Vec3d> corners() const { return corners_; }
  [[nodiscard]] std::span<const BoxSegment> segments() const { return segments_; }
  [[nodiscard]] std::span<const BoxRectangle> rectangles() const { return rectangles_; }
  /// Returns the rectangle shared by two boxes, which must exist.
  [[nodiscard]] std::uint32_t rectangle(const BoxRef& one, const BoxRef& other) const;
  /// Returns the two rectangles of a box that share a segment around which the box lies.
  [[nodiscard]] std::array<std::uint32_t, 2> rectangles_at(const BoxSegment& segment, const BoxRef& box) const;

 private:
  void find_corners(const Context& context);
  [[nodiscard]] std::vector<Vec3d> crossings(std::size_t across) const;
  void find_segments(const Context& context);
  void find_rectangles();
  void order_sides();
  [[nodiscard]] std::uint32_t corner(const Vec3d& p) const;
  /// Returns the box or cube that holds a point, if the point is moved infinitesimally along each axis: down (false) or
  /// up.
  [[nodiscard]] BoxRef locate(const Vec3d& p, const std::array<bool, 3>& up) const;

  std::span<const BoxCell> boxes_;
  const GridPlanes& planes_;
  const CellLattice& lattice_;
  std::unordered_map<Cell, SplitTree> boxes_of_cube_;
  std::vector<Vec3d> corners_;  ///< sorted by x, y, z
  std::vector<BoxSegment> segments_;
  std::vector<BoxRectangle> rectangles_;
  using BoxPair = std::array<BoxRef, 2>;
  std::vector<std::pair<BoxPair, std::uint32_t>> rectangle_of_;  ///< lesser box first; sorted
};

}  // namespace blum::detail
