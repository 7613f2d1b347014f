// Blum: vertices and edges of an axis next to extra cells. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/surface/solid_paths.hpp"
#include "medial_axis/shape/witnesses.hpp"

namespace blum {

/// What is known of the corners of a piece that are extra cells, or next to such: there the solid may have holes
/// narrower than a voxel, and a vertex may lie beyond one of them.
class NearExtra {
 public:
  NearExtra(const AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses, const Context& context);

  /// @param place  of a vertex; those beyond the corners count as near.
  [[nodiscard]] bool is_near(std::uint32_t place) const { return place >= is_near_.size() || is_near_[place] != 0; }
  /// A point of the component of a vertex that is near.
  [[nodiscard]] const std::optional<Stop>& home(std::uint32_t place) const { return homes_[place]; }
  /// Whether an edge has the same ends as one before it. Files name edges by their ends.
  [[nodiscard]] bool has_twin(std::uint32_t edge) const;

 private:
  void find_twins(const AxisPiece& piece, const AxisCorners& corners);

  std::vector<std::uint32_t> twins_;   ///< rising
  std::vector<std::uint8_t> is_near_;  ///< of each vertex place
  std::vector<std::optional<Stop>> homes_;
};

}  // namespace blum
