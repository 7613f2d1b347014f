// Blum: finds the closest sites of scattered points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/vec3.hpp"
#include "field/cpu/tile_kernel.hpp"

namespace blum::cpu {

/// Points in the normalised frame, sorted along a Morton curve through the cells of a cube.
struct MortonPoints {
  static constexpr unsigned levels = 10;
  /// Vectors may be read this far past the end.
  static constexpr std::size_t padding = 64;

  std::array<Buffer<float>, 3> coordinate;
  /// Morton code of each point's cell, ascending. The cube has 2^levels cells per side.
  std::vector<std::uint32_t> code;
  Vec3d lower;      ///< Corner of the cube.
  double side = 0;  ///< Side of the cube.

  [[nodiscard]] std::size_t size() const { return code.size(); }
};

/// Points that lie in one cube: a cell of some level. If a cell of the last level has too many points, this is a part
/// of them.
struct PointCell {
  std::size_t begin = 0;
  std::size_t end = 0;
  unsigned level = 0;  ///< level 0 is the cube of all points
  Vec3f center;
  float half = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Results for each point.
struct PointResults {
  /// Squared distance to a point of the surface, normalised. If `site` is known, the point is the closest one within
  /// rounding.
  Buffer<float> squared;
  Buffer<std::uint32_t> site;   ///< dead_record if the point is left to a search of its own
  Buffer<std::uint32_t> other;  ///< another site as close within rounding; dead_record if none
};

/// Input of all cells, and the memory for their results.
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

/// Returns cells that together contain all points. Each has at most 16384 points. If possible, there are enough cells
/// for the given number of threads.
[[nodiscard]] std::vector<PointCell> point_cells(const MortonPoints& points, int threads);

/// Finds the closest sites of the points of a cell. Culls sites as for the tiles of a field.
void compute_point_cell(const PointJob& job, const PointCell& cell, PointScratch& scratch);

}  // namespace blum::cpu
