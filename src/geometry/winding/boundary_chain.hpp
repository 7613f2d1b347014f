// Blum: the boundary of a triangle soup, and how strongly it is felt at a distance. SPDX-License-Identifier: Apache-2.0
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

/// The edges that are left when all directed edges of all triangles are added up, with multiplicities: nothing for a
/// closed surface, the rims of holes for an open one. Ends are compared by position.
///
/// The winding number changes, where no triangle lies between, only by the solid angles of this chain: its gradient is
/// the chain's Biot-Savart field over 4 pi, the sum of dl x R / R^3, R from the query to the edge. That is summed as a
/// vector, so that the two banks of a crack, or the two sides of a small hole far away, cancel; what the sum leaves out
/// (the extent of clusters and of the query's box) is bounded by the kernel's derivative, at most 2 / R^3.
class BoundaryChain {
 public:
  BoundaryChain() = default;
  /// @param scale  coordinates are multiplied by it, and those of queries must have been. A power of two.
  BoundaryChain(const MeshView& mesh, const SiteTable& sites, double scale, const Context& context);

  [[nodiscard]] bool is_empty() const { return levels_.empty(); }
  /// An edge as the surface runs along it, scaled.
  struct Edge {
    Vec3d from, to;
    std::int64_t multiplicity = 0;  ///< > 0
  };
  /// Empty where there are more than most_edges, counted as often as they occur.
  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  static constexpr std::int64_t most_edges = 2048;
  /// A bound on |grad w| over a box, in scaled coordinates; where it is above `enough`, any number above that.
  /// Allocates nothing.
  [[nodiscard]] double gradient_bound(const Box3& box, double enough = HUGE_VAL) const;

 private:
  /// Pieces of edges, or clusters of them.
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
  /// Level 0: pieces. Entry i of a level is made of entries 8 i ... 8 i + 7 of the level below; the last has one entry.
  std::vector<std::vector<Cluster>> levels_;
};

}  // namespace blum
