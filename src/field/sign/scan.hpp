// Blum: winding numbers of a closed mesh at all nodes of a grid, by scan conversion.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Crossings of the rows of a grid (lines along its x axis) with a closed mesh, and their directions. The winding
/// number of a node is the sum of the directions in front of it.
///
/// The result is exact. Every slice cuts the triangles, and every row cuts these cuts. Triangles that share an edge
/// (two vertices at the same positions) get the very same point where a slice cuts it. A point exactly on a slice or
/// row counts below it for all of them. So cuts are closed chains whatever rounding does. Rounding moves chains by
/// about 1e-15 of the diagonal of the box around mesh and grid. Nodes further than that from the surface get the
/// winding number of the full sum. This holds if the mesh crosses itself, folds, or has triangles without area, too.
/// Distances and sites are not used.
class SignScan {
 public:
  /// Finds the crossings of a mesh.
  /// @param mesh  every edge is run along equally often in both directions; segments and points are ignored.
  /// @return      none if there are more crossings than a quarter of the nodes plus 2^20 (a heap of shapes that overlap
  ///              many times over).
  /// Cost: O(triangles + crossings). A crossing takes 24 bytes; about one exists for each node next to the surface.
  [[nodiscard]] static std::optional<SignScan> make(const MeshView& mesh, const GridSpec& grid, const Context& context);

  /// Negates the distances of nodes inside.
  /// @param field  unsigned distances of this grid. Zeros stay as they are.
  /// @param level  nodes with a winding number above it are inside: 0, or -1 to follow the normals of meshes that are
  ///               inside out.
  /// Cost: one pass over the distances inside.
  void apply(Field& field, int level, const Context& context) const;

 private:
  explicit SignScan(const GridSpec& grid) : grid_(grid), slices_(static_cast<std::size_t>(grid.size[2]) + 1) {}

  GridSpec grid_;
  std::vector<std::size_t> slices_;       ///< start of each slice's crossings, and the end
  std::vector<std::uint64_t> crossings_;  ///< ascending in each slice: twice the first node behind it, plus 1 going in
};

}  // namespace blum
