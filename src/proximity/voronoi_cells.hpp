// Blum: what primitives may be closest to each other, by second-order Voronoi diagrams. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/bvh.hpp"
#include "proximity/scene_primitives.hpp"

namespace blum::detail {

/// A primitive, and its distance from the middle of a cell.
struct CellEntry {
  std::uint32_t row = 0;
  double distance = 0;
};

/// A sparse grid of the cells that primitives touch, and for each the primitives that may be the closest one of any
/// point of a primitive in it (Sud 2006, 4.3; docs/theory/proximity.md).
class VoronoiCells {
 public:
  /// @param cell_size     of the side of a cell for that of the box around a primitive, in the mean.
  /// @param max_distance  further primitives do not count.
  /// @param is_closest    whether only the closest ones are asked for; else all within max_distance.
  /// @throws Cancelled.
  VoronoiCells(const ScenePrimitives& primitives, double cell_size, double max_distance, bool is_closest,
               const Context& context);

  /// The cells that a primitive touches; none where it is left to the hierarchy: it touches too many, or one of them
  /// has too many primitives near it.
  [[nodiscard]] std::span<const std::uint32_t> cells(std::uint32_t row) const;
  [[nodiscard]] bool is_left_over(std::uint32_t row) const { return is_left_over_[row] != 0; }
  /// How many are.
  [[nodiscard]] std::size_t left_over() const;
  /// Those near a cell, by rising distance from its middle.
  [[nodiscard]] std::span<const CellEntry> entries(std::uint32_t cell) const;
  /// Distances of entries are compared with those of the middle; they may be further by this for points of the cell.
  [[nodiscard]] double radius() const { return radius_; }
  /// How wrong sums of distances may be.
  [[nodiscard]] double rounding() const { return rounding_; }
  /// How many cells there are.
  [[nodiscard]] std::size_t size() const { return cell_first_.size(); }

 private:
  struct Place;
  void make_cells(double cell_size, const Context& context);
  void fill_cells(double max_distance, bool is_closest, const Context& context);
  [[nodiscard]] Vec3d middle(std::uint64_t key) const;
  bool fill_closest(const Bvh& bvh, std::uint32_t cell, double max_distance, std::vector<CellEntry>& out) const;
  bool fill_within(const Bvh& bvh, std::uint32_t cell, double distance, std::vector<CellEntry>& out) const;
  [[nodiscard]] std::span<const std::uint32_t> touching(std::uint32_t cell) const;

  const ScenePrimitives& primitives_;
  Vec3d origin_;
  double side_ = 1;
  double radius_ = 0;
  double rounding_ = 0;
  std::vector<std::uint64_t> keys_;         ///< of cells
  std::vector<std::uint32_t> rows_;         ///< primitives that touch cells, cell by cell
  std::vector<std::uint32_t> cell_first_;   ///< of each cell, in rows_
  std::vector<std::uint32_t> cells_;        ///< that primitives touch, primitive by primitive
  std::vector<std::uint32_t> row_first_;    ///< of each primitive, in cells_; one more at the end
  std::vector<std::uint8_t> is_left_over_;  ///< of each primitive
  std::vector<std::vector<CellEntry>> entries_;
};

}  // namespace blum::detail
