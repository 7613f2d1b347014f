// Blum: a cone that closes a surface with a short boundary. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "geometry/winding/boundary_chain.hpp"
#include "geometry/winding/winding_tree.hpp"

namespace blum {

/// Triangles from the boundary of a surface to a common point. With them the surface is closed: the winding numbers of
/// both add up to a whole number, so that the surface's is known exactly once it is known roughly.
class BoundaryCone {
 public:
  BoundaryCone() = default;
  /// @param edges  of the boundary, as the surface runs along it.
  explicit BoundaryCone(std::span<const BoundaryChain::Edge> edges);

  /// The cone's winding number, good to `error`; nullopt where it may not be: next to the edges of the cone's
  /// triangles.
  [[nodiscard]] std::optional<double> winding_number(const Vec3d& scaled_query) const;
  static constexpr double error = 1e-9;

 private:
  std::vector<TriangleBlock> blocks_;
};

}  // namespace blum
