// Blum: the part of an axis between different patches. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/axis/axis_graph.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"

namespace blum::detail {

/// The curves of an axis, and its triangles between different patches. The column `sheet` contains their `patch_sheet`.
class PatchAxis {
 public:
  /// @param axis  passes problem_of_medial().
  /// @throws InvalidOption unless the triangles have the columns patch_a, patch_b and patch_sheet; Cancelled.
  PatchAxis(const Complex& axis, const Context& context);

  [[nodiscard]] const Complex& get() const { return axis_; }
  /// Adds the patches on the sides of each sheet, and replaces numbers of vertices by those of the given axis.
  void complete(AxisGraph& graph) const;

 private:
  void pick_vertices(const Complex& axis);

  Complex axis_;
  std::vector<std::uint32_t> vertices_;  ///< for each vertex, its number in the given axis
};

}  // namespace blum::detail
