// Blum: finds the closest sites of scattered points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/radix_sort.hpp"
#include "blum/core/vec3.hpp"
#include "field/cpu/tile_kernel.hpp"

namespace blum::cpu {

/// Indices of points, each with the Morton code of its cell: the cells of a cube, 2^levels per side.
using MortonOrder = std::span<const detail::KeyedIndex>;
constexpr unsigned morton_levels = 10;

/// Points of a cell in the normalised frame, sorted along the Morton curve.
struct MortonPoints {
  /// Vectors may be read this far past the end.
  static constexpr std::size_t padding = 64;

  std::array<Buffer<float>, 3> coordinate;
  MortonOrder order;
};

/// Points that lie in one cube: a cell of some level. If a cell of the last level has too many points, a PointCell
/// contains a part of these points.
struct PointCell {
  std::size_t begin = 0;
  std::size_t end = 0;
  unsigned level = 0;  ///< level 0 is the cube of all points
  Vec3f center;
  float half = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Results for each point of a cell.
struct PointResults {
  /// Squared distance to a point of the surface, normalised. If `site` is known, the point is the closest one within
  /// rounding.
  Buffer<float> squared;
  Buffer<std::uint32_t> site;   ///< dead_record if the point is left to a separate search
  Buffer<std::uint32_t> other;  ///< another site as close within rounding; dead_record if none
};

/// Input of a cell, and the memory for its results.
struct PointJob {
  FieldJob field;  ///< only its sites, forest and cancellation are used
  const MortonPoints* points = nullptr;
  PointResults* results = nullptr;
};

/// Memory that a worker keeps from cell to cell.
class PointScratch {
 public:
  PointScratch();
  PointScratch(PointScratch&&) noexcept;
  PointScratch& operator=(PointScratch&&) noexcept;
  ~PointScratch();

  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Returns the largest number of points of a cell, at most 16384. If possible, there are enough cells for the given
/// number of threads.
[[nodiscard]] std::size_t most_per_cell(std::size_t points, int threads);

/// Returns cells that together contain all points. Each has at most `most` points.
/// @param order  sorted by the codes of cells that have more than `most` points, and by those of their children.
/// @param root   the cube of all points.
[[nodiscard]] std::vector<PointCell> point_cells(MortonOrder order, const PointCell& root, std::size_t most);

/// Finds the closest sites of the points of a cell. Culls sites as for the tiles of a field.
void compute_point_cell(const PointJob& job, const PointCell& cell, PointScratch& scratch);

}  // namespace blum::cpu
