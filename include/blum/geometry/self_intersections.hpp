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

/// Two triangles whose common points are more than a shared corner or edge.
struct TrianglePair {
  TriangleId first;  ///< the smaller id
  TriangleId second;
  /// True if the triangles cross: they lie in different planes, and some points are inside both triangles. False if
  /// they touch: a corner or an edge of one lies on the other, or they overlap in one plane, as equal triangles do.
  bool crosses = false;
};

struct SelfIntersections {
  std::vector<TrianglePair> pairs;  ///< in rising order of (first, second)
  std::size_t crossing = 0;         ///< number of pairs that cross
  std::size_t touching = 0;         ///< number of pairs that only touch
  bool complete = true;             ///< false if the search ended because it found more pairs than the limit
};

/// Returns the pairs of triangles that cross or touch beyond shared corners and edges. Corners are shared if they have
/// the same index or the same position (-0.0 equals 0.0), so the mesh need not be welded.
///
/// The result is exact for the given coordinates, if the magnitude of each coordinate is 0 or at least 1e-80 times the
/// largest magnitude. No tolerance is used: parts that only nearly touch are not found. Parts that should touch may lie
/// apart or cross if coordinates were rounded. Triangles without area, segments and points are ignored.
///
/// If an edge lies exactly in another triangle, both triangles at the edge are reported as touching that triangle, even
/// if the surface crosses it. So a mesh is certainly free of crossings only if `pairs` is empty.
///
/// @param mesh   must pass validate(mesh).
/// @param limit  the search ends when it has found more than `limit` pairs. In this case, `pairs` has `limit` entries,
/// which are the same for any number of threads.
/// @throws InvalidMesh, Cancelled.
/// Cost: O(n log n) for n triangles, plus the number of pairs of triangles whose boxes touch. On two cores, this takes
/// about 0.05 s for 70,000 triangles and 0.8 s for 1.6 million. Memory: 250 bytes per triangle.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::size_t limit = 100000,
                                                        const Context& context = {});

/// Returns the pairs of find_self_intersections(mesh, limit), but uses a given order of the triangles that keeps
/// neighbours in space together (OrientedBvh::order()). A given order saves a third of the time of the search. The
/// pairs depend on the order only if there are more than `limit` pairs.
/// @throws InvalidOption if the number of entries is not the number of triangles.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order,
                                                        std::size_t limit, const Context& context = {});

/// Returns the pairs of find_self_intersections(mesh, limit), but uses a given table of vertices at the same position.
/// The mesh must pass validate(mesh); this is not checked.
/// @param corners  result of weld_clusters(mesh.vertices). @throws InvalidOption if the number of entries is not the
///                 number of vertices.
[[nodiscard]] SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order,
                                                        std::span<const std::uint32_t> corners, std::size_t limit,
                                                        const Context& context = {});

/// Search that decides, frame after frame, if a deforming mesh crosses or touches itself. Between frames, the search
/// keeps a spatial order of the triangles, until groups of neighbours have moved apart. Computing a spatial order takes
/// as long as the rest of a search. Results do not depend on the order.
class SelfIntersectionSearch {
 public:
  SelfIntersectionSearch() = default;
  /// @param order  order of the first mesh's triangles in space, so that it need not be computed. For a mesh without
  /// segments and points, it is Bvh::order(). It is ignored if its size is not the number of triangles.
  explicit SelfIntersectionSearch(std::span<const std::uint32_t> order) : order_(order.begin(), order.end()) {}

  /// Returns true if find_self_intersections() would find a pair. The triangles of `mesh` may differ from those of the
  /// mesh in the previous call.
  /// @param mesh  must pass validate(mesh). @throws InvalidMesh, Cancelled.
  /// Cost: about 0.15 microseconds per triangle of a fine mesh, on two cores.
  [[nodiscard]] bool finds_any(const MeshView& mesh, const Context& context = {});

 private:
  std::vector<std::uint32_t> order_;
  double looseness_ = -1;  ///< sum of the extents of the groups' boxes, divided by that of the triangles' boxes, when
                           ///< the groups were made; negative until it is computed
};

}  // namespace blum
