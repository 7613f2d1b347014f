// Blum: self-intersections of a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Two triangles that share more than a corner or an edge.
struct TrianglePair {
  TriangleId first;  ///< the smaller id
  TriangleId second;
  /// true if they cross: they lie in two planes, and some points are inside both. Else they touch: a corner or an edge
  /// of one lies on the other, or they overlap in one plane, as equal triangles do.
  bool crosses = false;
};

struct SelfIntersections {
  std::vector<TrianglePair> pairs;  ///< in rising order of (first, second)
  std::size_t crossing = 0;         ///< pairs that cross
  std::size_t touching = 0;         ///< pairs that only touch
  bool complete = true;             ///< false if the search ended because it found more pairs than the limit
};

/// Returns the pairs of triangles that cross or touch beyond shared corners and edges. Corners are shared if they have
/// one index or one position (-0.0 equals 0.0), so the mesh need not be welded.
///
/// The answer is exact for the given coordinates, if these are 0 or at least 1e-80 of the largest one. No tolerance is
/// used: parts that only nearly touch are not found. Parts that are meant to touch may miss or cross by a rounding
/// error. Triangles without area, segments and points are ignored.
///
/// An edge may lie exactly in another triangle. Then both triangles at the edge touch that triangle, even if the
/// surface crosses it there. So a mesh is certainly free of crossings only if `pairs` is empty.
///
/// @param mesh   must pass validate(mesh).
/// @param limit  the search ends when it finds more pairs. `pairs` then has this many of them, the same for any number
/// of threads.
/// @throws InvalidMesh, Cancelled.
/// Cost: O(n log n) for n triangles, and the pairs whose boxes touch. That takes about 0.05 s for 70,000 triangles and
/// 0.8 s for 1.6 million, on two cores; 250 bytes per triangle.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::size_t limit = 100000,
                                                        const Context& context = {});

/// Returns the same for a given order of the triangles that keeps neighbours in space together (OrientedBvh::order()).
/// Computing this order takes a third of the time. The pairs found depend on it only if there are more than the limit.
/// @throws InvalidOption if the order has another size.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order,
                                                        std::size_t limit, const Context& context = {});

/// Returns the same if it is known which vertices lie in one place. The mesh must pass validate(mesh); this is not
/// checked.
/// @param corners  weld_clusters(mesh.vertices). @throws InvalidOption if it has another size.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order,
                                                        std::span<const std::uint32_t> corners, std::size_t limit,
                                                        const Context& context = {});

/// Search that decides frame after frame if a deforming mesh crosses or touches itself. It keeps the order of the
/// triangles in space while groups of neighbours stay together. Computing the order takes as long as all the rest. The
/// answers do not depend on it.
class SelfIntersectionSearch {
 public:
  SelfIntersectionSearch() = default;
  /// @param order  order of the first mesh's triangles, which then need not be computed. Bvh::order() gives it for
  /// meshes of triangles only. An order of another size is ignored.
  explicit SelfIntersectionSearch(std::span<const std::uint32_t> order) : order_(order.begin(), order.end()) {}

  /// Returns true if find_self_intersections() finds a pair. Each mesh may have other triangles than the one before.
  /// @param mesh  must pass validate(mesh). @throws InvalidMesh, Cancelled.
  /// Cost: about 0.15 microseconds per triangle of a fine mesh, on two cores.
  [[nodiscard]] bool finds_any(const MeshView& mesh, const Context& context = {});

 private:
  std::vector<std::uint32_t> order_;
  double looseness_ = -1;  ///< of the groups when they were made; negative for new groups
};

}  // namespace blum
