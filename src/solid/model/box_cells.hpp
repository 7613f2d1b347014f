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

/// Tree of planes that cut a large box into boxes, one cut after the other.
class SplitTree {
 public:
  SplitTree() = default;
  /// @param boxes  boxes of this tree and of others; the span must stay valid.
  /// @param own  indices of the boxes of this tree, at least one.
  SplitTree(std::span<const BoxCell> boxes, std::vector<std::uint32_t> own);

  /// Returns the box that contains a point of the large box. On a plane, the point counts as below it (false) or above
  /// it (true), as `up` states for each axis. Cost: the depth of the tree.
  [[nodiscard]] std::uint32_t find(const Vec3d& p, const std::array<bool, 3>& up) const;

 private:
  struct Node {
    std::size_t axis = 3;  ///< 3 for a leaf
    double at = 0;
    std::uint32_t below = 0;  ///< index of a node; of the box for a leaf
    std::uint32_t above = 0;
  };

  std::vector<Node> nodes_;
};

/// A box: a part of a cube of a grid, or a whole cube.
struct BoxCell {
  Vec3d low;
  Vec3d high;
  Cell cube = 0;
};

/// Returns a corner of a box.
/// @param k  bit 0, 1, 2: set for the high end along x, y, z.
inline Vec3d corner_of(const BoxCell& box, std::size_t k) {
  return {(k & 1U) != 0 ? box.high.x : box.low.x, (k & 2U) != 0 ? box.high.y : box.low.y,
          (k & 4U) != 0 ? box.high.z : box.low.z};
}

/// Reference to a box, or to a cube of the grid that is not split into boxes.
struct BoxRef {
  static constexpr std::uint32_t nothing = 0xffffffffU;
  std::uint32_t id = nothing;  ///< index of a box, or the cube's Cell
  bool is_box = false;

  [[nodiscard]] bool exists() const { return is_box || id != nothing; }
  [[nodiscard]] friend auto operator<=>(const BoxRef&, const BoxRef&) = default;
};

/// An edge of the decomposition: a segment of the boxes' edges along which the surrounding boxes stay the same.
struct BoxSegment {
  std::size_t axis = 0;
  std::array<std::uint32_t, 2> ends{0, 0};  ///< indices of corners, the lower end first
  /// The boxes around the segment. Index bit 0 is set above it along the next axis, bit 1 along the axis after that.
  /// Two entries may be equal.
  std::array<BoxRef, 4> around;
};

/// The rectangle shared by two boxes, or by a box and a cube of the grid.
struct BoxRectangle {
  std::size_t axis = 0;         ///< axis at a right angle to the rectangle
  std::array<BoxRef, 2> boxes;  ///< the box below and the box above
  /// Segments of the four sides, each in ascending order. Sides 0 and 1 run along the first of the other two axes, at
  /// the low and high end of the second. Sides 2 and 3 run along the second, at the low and high end of the first.
  std::array<std::vector<std::uint32_t>, 4> sides;
};

/// The cells of a decomposition into boxes, which fill some cubes of a grid, and the cubes around these. A corner of
/// one edge or rectangle may lie inside another edge or side.
class BoxCells {
 public:
  /// @param boxes  together fill each cube of which one is a part. The span must stay valid.
  /// @throws Cancelled.
  BoxCells(std::span<const BoxCell> boxes, const GridPlanes& planes, const CellLattice& lattice,
           const Context& context = {});

  [[nodiscard]] std::span<const Vec3d> corners() const { return corners_; }
  [[nodiscard]] std::span<const BoxSegment> segments() const { return segments_; }
  [[nodiscard]] std::span<const BoxRectangle> rectangles() const { return rectangles_; }
  /// Returns the index of the rectangle shared by two boxes. It must exist.
  [[nodiscard]] std::uint32_t rectangle(const BoxRef& one, const BoxRef& other) const;
  /// Returns the indices of the two rectangles of a box that meet at a segment. The box must be one of those around the
  /// segment.
  [[nodiscard]] std::array<std::uint32_t, 2> rectangles_at(const BoxSegment& segment, const BoxRef& box) const;

 private:
  void find_corners(const Context& context);
  [[nodiscard]] std::vector<Vec3d> crossings(std::size_t across) const;
  void find_segments(const Context& context);
  void find_rectangles();
  void order_sides();
  [[nodiscard]] std::uint32_t corner(const Vec3d& p) const;
  /// Returns the box or cube that contains a point. On a plane, the point counts as below it (false) or above it
  /// (true), as `up` states for each axis.
  [[nodiscard]] BoxRef locate(const Vec3d& p, const std::array<bool, 3>& up) const;

  std::span<const BoxCell> boxes_;
  const GridPlanes& planes_;
  const CellLattice& lattice_;
  std::unordered_map<Cell, SplitTree> boxes_of_cube_;
  std::vector<Vec3d> corners_;  ///< sorted by x, y, z
  std::vector<BoxSegment> segments_;
  std::vector<BoxRectangle> rectangles_;
  using BoxPair = std::array<BoxRef, 2>;
  std::vector<std::pair<BoxPair, std::uint32_t>> rectangle_of_;  ///< smaller box first; sorted
};

}  // namespace blum::detail
