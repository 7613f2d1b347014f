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

/// The sum of the directed edges of all triangles, with multiplicities. It is empty for a closed surface, and consists
/// of the rims of holes for an open one. Ends are compared by position.
///
/// If no triangle lies between two points, their winding numbers differ only by the solid angles of this chain. The
/// winding number's gradient is the chain's Biot-Savart field over 4 pi: the sum of dl x R / R^3, R from the query to
/// the edge. It is summed as a vector, so that the two banks of a crack cancel, and the two sides of a small hole far
/// away. The sum leaves out the extent of clusters and of the query's box. The error is bounded by the kernel's
/// derivative, at most 2 / R^3.
class BoundaryChain {
 public:
  BoundaryChain() = default;
  /// @param scale  factor applied to coordinates, a power of two. Queries must be scaled by it beforehand.
  BoundaryChain(const MeshView& mesh, const SiteTable& sites, double scale, const Context& context);

  [[nodiscard]] bool is_empty() const { return levels_.empty(); }
  /// A scaled edge, in the direction in which the surface traverses it.
  struct Edge {
    Vec3d from, to;
    std::int64_t multiplicity = 0;  ///< > 0
  };
  /// Returns the edges; empty if there are more than most_edges, counted with multiplicity.
  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  static constexpr std::int64_t most_edges = 2048;
  /// Returns a bound on |grad w| over a box, in scaled coordinates. If it exceeds `enough`, returns any number above
  /// `enough`. Allocates nothing.
  [[nodiscard]] double gradient_bound(const Box3& box, double enough = HUGE_VAL) const;

 private:
  /// A piece of an edge, or a cluster of pieces.
  struct Cluster {
    Vec3d center;
    Vec3d vector;             ///< sum of directed lengths times multiplicities
    double weight = 0;        ///< sum of lengths times multiplicities
    double moment = 0;        ///< bound on the sum of lengths times multiplicities times distances from the centre
    double radius = 0;        ///< bound on the distance from the centre
    double multiplicity = 0;  ///< of a piece
    Box3 box;
  };
  [[nodiscard]] static Cluster merge(const Cluster* children, std::size_t count);

  std::vector<Edge> edges_;
  /// Level 0 holds pieces. Entry i of a level is made of entries 8 i ... 8 i + 7 of the level below. The last level has
  /// one entry.
  std::vector<std::vector<Cluster>> levels_;
};

}  // namespace blum
