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
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/impact.hpp"

namespace blum {

/// Vertex that meets a triangle.
struct VertexFaceCollision {
  std::uint32_t vertex = 0;
  TriangleId face;
  double time = 0;  ///< Time of impact, as from vertex_face_impact().
};

/// Two edges that meet.
struct EdgeEdgeCollision {
  Segment first{};  ///< Edge by its ends, the smaller first. The smaller edge is first.
  Segment second{};
  double time = 0;  ///< Time of impact, as from edge_edge_impact().
};

struct ContinuousCollisions {
  std::vector<VertexFaceCollision> vertex_face;  ///< By ascending (vertex, face).
  std::vector<EdgeEdgeCollision> edge_edge;      ///< By ascending (first, second).
  std::size_t box_pairs = 0;                     ///< Pairs of features whose moving boxes touch.
  std::size_t exact_tests = 0;                   ///< Pairs that were tested, because no direction separates them.
  std::vector<PhaseTime> phases;

  /// Returns the earliest time of impact; nullopt if nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

/// Returns all colliding pairs of a vertex and a triangle, and of two edges, of a moving mesh. Vertices move along
/// straight lines from time 0 to time 1. Each pair has the time at which it first meets.
///
/// The set of pairs is exact for the given coordinates: see vertex_face_impact(). Pairs that share a vertex are left
/// out. Vertices in the same place at the start and at the end are one vertex, so a mesh need not be welded. The result
/// names the smallest of their indices that occurs in the mesh. Edges are those of triangles and the segments of the
/// mesh, each once. Vertices are those of triangles, segments and points. Triangles without area take part.
///
/// @param mesh  at time 0; must pass validate(mesh).
/// @param end   vertices at time 1: as many, finite where the mesh names them, of magnitude at most 1e150.
/// @return      the same bytes for any number of threads.
/// @throws InvalidMesh, InvalidOption, Cancelled; OutOfMemory if more than 2^26 pairs collide.
/// Cost: O(n log n) and the pairs whose boxes touch. A cloth of 92,000 triangles with 114,000 colliding pairs takes
/// about half a second on one core.
/// Method: docs/theory/proximity.md.
[[nodiscard]] ContinuousCollisions continuous_collisions(const MeshView& mesh, std::span<const Vec3d> end,
                                                         const ImpactOptions& options = {},
                                                         const Context& context = {});

}  // namespace blum
