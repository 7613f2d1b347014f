// Blum: the boundary of a triangle soup, and how strongly it is felt at a distance. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "geometry/box_tree.hpp"

namespace blum {

/// The edges that are left when all directed edges of all triangles are added up, with multiplicities: nothing for a
/// closed surface, the rims of holes for an open one. Ends are compared by position.
///
/// The winding number changes, where no triangle lies between, only by the solid angles of this chain: its gradient is
/// the chain's Biot-Savart field over 4 pi, so an edge of length L at a distance d contributes at most L / (4 pi d^2),
/// and at most 1 / (2 pi d) however long it is.
class BoundaryChain {
 public:
  BoundaryChain() = default;
  /// @param scale  coordinates are multiplied by it, and those of queries must have been. A power of two.
  BoundaryChain(const MeshView& mesh, const SiteTable& sites, double scale, const Context& context);

  [[nodiscard]] bool is_empty() const { return tree_.is_empty(); }
  /// A bound on |grad w| over a box, in scaled coordinates. Allocates nothing.
  [[nodiscard]] double gradient_bound(const Box3& box) const;

 private:
  BoxTree tree_;  ///< level 0: single pieces of edges
  /// Per level and block: sums of lengths times multiplicities.
  std::vector<std::vector<std::array<double, lanes>>> weights_;
  /// Per piece: its multiplicity.
  std::vector<double> multiplicity_;
};

}  // namespace blum
