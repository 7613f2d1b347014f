// Blum: where a mesh crosses itself. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Two triangles that have more in common than a corner or an edge.
struct TrianglePair {
  TriangleId first;  ///< the smaller one
  TriangleId second;
  /// Whether they cross: there are points inside both, and they lie in two planes. Else they touch: a corner or an edge
  /// of one lies on the other, or they lie in one plane and overlap, as equal triangles do.
  bool crosses = false;
};

struct SelfIntersections {
  std::vector<TrianglePair> pairs;  ///< in rising order of (first, second)
  std::size_t crossing = 0;         ///< how many of them cross
  std::size_t touching = 0;         ///< how many only touch
  bool complete = true;             ///< false where the search ended because there are more pairs than the limit
};

/// The pairs of triangles that cross or touch, besides the corners and edges that they share. Corners are shared where
/// they have one index or one position (-0.0 equals 0.0), so that a mesh need not be welded.
///
/// The answer is exact for the coordinates as they are, where these are at least 1e-80 of the largest one, or 0: no
/// tolerance is used, so parts that only nearly touch do not, and what is meant to touch may miss or cross by a
/// rounding. Triangles without area, segments and points are left out. Where an edge lies exactly in another triangle,
/// the two triangles at that edge touch that one, even if the surface crosses it there: a mesh is free of crossings for
/// certain only where `pairs` is empty.
///
/// @param mesh   must pass validate(mesh).
/// @param limit  the search ends when more pairs are found; `pairs` then holds this many of them, the same for any
///               number of threads.
/// @throws InvalidMesh, Cancelled.
/// Cost: O(n log n) for n triangles and the pairs whose boxes touch; about 0.05 s for 70,000 triangles and
/// 0.8 s for 1.6 million on two cores; 250 bytes per triangle.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::size_t limit = 100000,
                                                        const Context& context = {});

/// The same with an order of the triangles in which neighbours in space are together, which takes a third of the time
/// to find: OrientedBvh::order(). What is found does not depend on it, but where there is more than the limit.
/// @throws InvalidOption where it has another size.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order,
                                                        std::size_t limit, const Context& context = {});

/// The same for a mesh that passes validate(mesh), where it is known which vertices are in one place.
/// @param corners  weld_clusters(mesh.vertices). @throws InvalidOption where there are more or fewer.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order,
                                                        std::span<const std::uint32_t> corners, std::size_t limit,
                                                        const Context& context = {});

/// Asks frame after frame whether a mesh that deforms crosses or touches itself. It keeps the order of the triangles in
/// space, which takes as long to find as all the rest, for as long as groups of neighbours stay together; the answers
/// do not depend on it.
class SelfIntersectionSearch {
 public:
  SelfIntersectionSearch() = default;
  /// @param order  of the first mesh's triangles, such as Bvh::order() where it has nothing else: it need not be found.
  ///               One of another size is not looked at.
  explicit SelfIntersectionSearch(std::span<const std::uint32_t> order) : order_(order.begin(), order.end()) {}

  /// Whether find_self_intersections() finds a pair. Meshes may have other triangles than the ones before.
  /// @param mesh must pass validate(mesh). @throws InvalidMesh, Cancelled.
  /// Cost: about 0.15 microseconds for each triangle of a fine mesh on two cores.
  [[nodiscard]] bool finds_any(const MeshView& mesh, const Context& context = {});

 private:
  std::vector<std::uint32_t> order_;
  double looseness_ = -1;  ///< of the groups when they were made; negative where they are new
};

}  // namespace blum
