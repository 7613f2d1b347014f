// Blum: the boundary of a triangle soup, and bounds on its effect at a distance. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Boundary chain of a surface: the sum of the directed edges of all triangles, with multiplicities. The chain is empty
/// for a closed surface. For an open surface, it consists of the rims of holes. Edges are combined if their ends have
/// the same positions.
///
/// If no triangle lies between two points, their winding numbers differ only by the solid angles of this chain. The
/// winding number's gradient is the chain's Biot-Savart field over 4 pi. The field is the sum of dl x R / R^3, with R
/// from the query to the edge. The field is summed as a vector. So the two banks of a crack cancel, and far away also
/// the two sides of a small hole. The sum neglects the extent of clusters and of the query's box. The error is bounded
/// with the kernel's derivative, which is at most 2 / R^3.
class BoundaryChain {
 public:
  BoundaryChain() = default;
  /// @param scale  factor applied to coordinates, a power of two. Callers must scale queries by it.
  BoundaryChain(const MeshView& mesh, const SiteTable& sites, double scale, const Context& context);

  [[nodiscard]] bool is_empty() const { return levels_.empty(); }
  /// A scaled edge, in the direction in which the surface traverses it.
  struct Edge {
    Vec3d from, to;
    std::int64_t multiplicity = 0;  ///< > 0
  };
  /// Returns the edges. Empty if their number, counted with multiplicity, exceeds most_edges.
  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  static constexpr std::int64_t most_edges = 2048;
  /// Returns a bound on |grad w| over a box, with w the winding number, in scaled coordinates. If the bound exceeds
  /// `enough`, the function may return any number above `enough`. Allocates nothing.
  [[nodiscard]] double gradient_bound(const Box3& box, double enough = HUGE_VAL) const;

 private:
  /// Piece of an edge, or cluster of pieces.
  struct Cluster {
    Vec3d center;
    Vec3d vector;             ///< sum over pieces of vector * multiplicity
    double weight = 0;        ///< sum over pieces of length * multiplicity
    double moment = 0;        ///< bound on the sum over pieces of length * multiplicity * distance from the centre
    double radius = 0;        ///< bound on distances from the centre
    double multiplicity = 0;  ///< only for pieces
    Box3 box;
  };
  [[nodiscard]] static Cluster merge(const Cluster* children, std::size_t count);

  std::vector<Edge> edges_;
  /// Level 0 contains the pieces. Entry i of a higher level combines entries 8 i ... 8 i + 7 of the level below. The
  /// last level has one entry.
  std::vector<std::vector<Cluster>> levels_;
};

}  // namespace blum
