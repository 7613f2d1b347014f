// Blum: winding numbers of a closed mesh at all nodes of a grid, by scan conversion. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Where the rows of a grid (lines along its x axis) cross a closed mesh, and in which direction: the winding number of
/// a node is the sum of the directions in front of it.
///
/// Exact: the triangles are cut by every slice and the cuts by every row. Triangles that share an edge (two vertices at
/// the same positions) get the very same point where a slice cuts it, and a point exactly on a slice or row counts
/// below it for all of them, so that cuts are closed chains whatever rounding does. Rounding moves chains by about
/// 1e-15 of the diagonal of the box around mesh and grid: nodes further than that from the surface get the winding
/// number of the full sum, whether the mesh crosses itself, folds, or has triangles without area. Distances and sites
/// play no part.
class SignScan {
 public:
  /// @param mesh  every edge is run along equally often in both directions; segments and points are left out.
  /// @return      none where the rows cross the mesh far more often than its distances take memory (a heap of shapes
  ///              that overlap many times over).
  /// Cost: O(triangles + crossings); 24 bytes per crossing, of which there is about one for each node next to the
  /// surface.
  [[nodiscard]] static std::optional<SignScan> make(const MeshView& mesh, const GridSpec& grid, const Context& context);

  /// Negates the distances of nodes inside.
  /// @param field  of this grid, unsigned. Zeros stay as they are.
  /// @param level  nodes with a winding number above it are inside: 0, or -1 to follow the normals of meshes that are
  ///               inside out.
  /// Cost: one pass over the distances inside.
  void apply(Field& field, int level, const Context& context) const;

 private:
  explicit SignScan(const GridSpec& grid) : grid_(grid), slices_(static_cast<std::size_t>(grid.size[2]) + 1) {}

  GridSpec grid_;
  std::vector<std::size_t> slices_;       ///< where each slice's crossings begin, and the end
  std::vector<std::uint64_t> crossings_;  ///< rising in each slice: twice the first node behind it, plus 1 going in
};

}  // namespace blum
