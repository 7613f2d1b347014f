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

/// Crossings of the rows of a grid (lines along its x axis) with a closed mesh, and their directions (in or out). The
/// winding number of a node is the sum of the directions of all crossings before it in its row.
///
/// The result is exact. Every slice cuts the triangles, and every row crosses these cuts. Triangles that share an edge
/// (two vertices at the same positions) get bitwise the same point where a slice cuts the edge. A point exactly on a
/// slice or row counts as below it, for all triangles. So the cuts form closed chains, for any rounding errors.
/// Rounding moves chains by about 1e-15 of the diagonal of the box around mesh and grid. Nodes further than that from
/// the surface get the exact winding number. The winding numbers are also exact if the mesh crosses itself, folds, or
/// has triangles without area. Distances and sites are not used.
class SignScan {
 public:
  /// Finds the crossings of a mesh.
  /// @param mesh  every edge must be traversed equally often in both directions; segments and points are ignored.
  /// @return      nothing if there are more crossings than a quarter of the nodes plus 2^20 (for example, for many
  ///              shapes that overlap each other).
  /// Cost: O(triangles + crossings). A crossing needs 24 bytes. Typically there is about one for each node next to the
  /// surface.
  [[nodiscard]] static std::optional<SignScan> make(const MeshView& mesh, const GridSpec& grid, const Context& context);

  /// Negates the distances of nodes inside.
  /// @param field  unsigned distances for the same grid. Zeros are not changed.
  /// @param level  nodes with a winding number above `level` are inside. Use 0, or -1 to follow the normals of an
  ///               inside-out mesh.
  /// Cost: one pass over the distances of nodes inside.
  void apply(Field& field, int level, const Context& context) const;

 private:
  explicit SignScan(const GridSpec& grid) : grid_(grid), slices_(static_cast<std::size_t>(grid.size[2]) + 1) {}

  GridSpec grid_;
  std::vector<std::size_t> slices_;  ///< Index of each slice's first crossing; the last entry is the total.
  /// Ascending within each slice: twice the index of the first node behind the crossing, plus 1 if it goes in.
  std::vector<std::uint64_t> crossings_;
};

}  // namespace blum
