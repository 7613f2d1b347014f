// Blum: continuous collisions within a moving mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/impact.hpp"

namespace blum {

/// Vertex that meets a triangle.
struct VertexFaceCollision {
  std::uint32_t vertex = 0;
  TriangleId face;
  double time = 0;  ///< Time of impact, as returned by vertex_face_impact().
};

/// Two edges that meet.
struct EdgeEdgeCollision {
  Segment first{};  ///< Vertices of the edge, smaller index first. `first` precedes `second` in lexicographic order.
  Segment second{};
  double time = 0;  ///< Time of impact, as returned by edge_edge_impact().
};

struct ContinuousCollisions {
  std::vector<VertexFaceCollision> vertex_face;  ///< By ascending (vertex, face).
  std::vector<EdgeEdgeCollision> edge_edge;      ///< By ascending (first, second).
  std::size_t box_pairs = 0;  ///< Pairs of a vertex and a face, or of two edges, whose moving boxes touch.
  /// Number of pairs in `box_pairs` that needed an exact test: no examined direction separates the two features.
  std::size_t exact_tests = 0;
  std::vector<PhaseTime> phases;

  /// Returns the earliest time of impact; nullopt if nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

/// Returns all collisions within a moving mesh: pairs of a vertex and a triangle, and pairs of two edges. Vertices move
/// along straight lines from time 0 to time 1. For each pair, the result contains the time of the first contact.
///
/// The set of pairs is exact for the given coordinates: see vertex_face_impact(). Pairs that share a vertex are left
/// out. Vertices that coincide both at the start and at the end count as one vertex, so a mesh need not be welded. The
/// result lists coinciding vertices under one index: the smallest of their indices that a primitive of the mesh uses.
/// Edges are all segments and all sides of triangles; a shared edge is tested once. Vertices are those of triangles,
/// segments and points. Triangles without area are also tested.
///
/// @param mesh  at time 0; must pass validate(mesh).
/// @param end   positions of all vertices of the mesh at time 1. Coordinates of vertices that primitives use must be
///              finite and of magnitude at most 1e150.
/// @return      the same bytes for any number of threads.
/// @throws InvalidMesh, InvalidOption, Cancelled; OutOfMemory if more than 2^26 pairs collide.
/// Cost: O(n log n) plus the number of pairs whose boxes touch. A cloth of 92,000 triangles with 114,000 colliding
/// pairs takes about half a second on one core.
/// Method: docs/theory/proximity.md.
[[nodiscard]] ContinuousCollisions continuous_collisions(const MeshView& mesh, std::span<const Vec3d> end,
                                                         const ImpactOptions& options = {},
                                                         const Context& context = {});

/// Returns a warning if pairs meet at the start of a motion, otherwise an empty list. The time of a pair that meets at
/// the start is 0, even if the two features move apart immediately.
/// @param pairs  number of pairs that meet at time 0.
[[nodiscard]] std::vector<Warning> start_warnings(std::size_t pairs);
/// Returns the warning for all pairs of a result that have the time 0, or an empty list.
[[nodiscard]] std::vector<Warning> start_warnings(const ContinuousCollisions& found);

}  // namespace blum
