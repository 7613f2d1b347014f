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

/// Points in the normalised frame, along a Morton curve through the cells of a cube.
struct MortonPoints {
  static constexpr unsigned levels = 10;
  /// Whole vectors may be read past the end.
  static constexpr std::size_t padding = 64;

  std::array<Buffer<float>, 3> coordinate;
  std::vector<std::uint32_t> code;  ///< Code of each point's cell, of 2^levels per side; ascending.
  Vec3d lower;                      ///< Corner of the cube.
  double side = 0;                  ///< Side of the cube.

  [[nodiscard]] std::size_t size() const { return code.size(); }
};

/// Points that lie in one cube: a cell of some level, or a part of its points if they are many.
struct PointCell {
  std::size_t begin = 0;
  std::size_t end = 0;
  unsigned level = 0;  ///< 0: the cube of all points
  Vec3f center;
  float half = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Results for each point.
struct PointResults {
  /// Squared distance to a point of the surface, normalised. If the site is known, it is the closest point, within
  /// rounding.
  Buffer<float> squared;
  Buffer<std::uint32_t> site;   ///< dead_record if it is left to a search of its own
  Buffer<std::uint32_t> other;  ///< as close within rounding; dead_record if none
};

/// Input of all cells, and the output of their results.
struct PointJob {
  FieldJob field;  ///< only its sites, hierarchies and cancellation are used
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

/// Returns cells that together hold all points. Each has at most some thousand points, and there are enough for this
/// many threads.
[[nodiscard]] std::vector<PointCell> point_cells(const MortonPoints& points, int threads);

/// Finds the closest sites of the points of a cell, by culling as for the tiles of a field.
void compute_point_cell(const PointJob& job, const PointCell& cell, PointScratch& scratch);

}  // namespace blum::cpu
