// Blum: what of a moving mesh collides with what. SPDX-License-Identifier: Apache-2.0
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

/// A vertex that meets a triangle.
struct VertexFaceCollision {
  std::uint32_t vertex = 0;
  TriangleId face;
  double time = 0;  ///< of impact, as vertex_face_impact() tells it
};

/// Two edges that meet.
struct EdgeEdgeCollision {
  Segment first{};  ///< by their ends, the smaller first; the smaller edge first
  Segment second{};
  double time = 0;  ///< of impact, as edge_edge_impact() tells it
};

struct ContinuousCollisions {
  std::vector<VertexFaceCollision> vertex_face;  ///< by rising (vertex, face)
  std::vector<EdgeEdgeCollision> edge_edge;      ///< by rising (first, second)
  std::size_t box_pairs = 0;                     ///< pairs of features whose moving boxes touch
  std::size_t exact_tests = 0;                   ///< pairs that were tested: those that no direction tells apart
  std::vector<PhaseTime> phases;

  /// The earliest time of impact; nullopt where nothing collides.
  [[nodiscard]] std::optional<double> earliest() const;
};

/// All pairs of a vertex and a triangle, and of two edges, of a mesh that meet while its vertices move along straight
/// lines from time 0 to time 1, each with the time at which they first do.
///
/// Which pairs these are is exact for the coordinates as they are: see vertex_face_impact(). Pairs that share a vertex
/// are left out; vertices that are in the same place at the start and at the end are one vertex, so that a mesh need
/// not be welded: of those that the mesh names the one with the smallest index is told. Edges are those of triangles
/// and the segments of the mesh, each once; vertices are those of triangles, segments and points. Triangles without
/// area take part.
///
/// @param mesh  at time 0; must pass validate(mesh).
/// @param end   the vertices at time 1: as many, finite where the mesh names them, of magnitude at most 1e150.
/// @return      the same bytes for any number of threads.
/// @throws InvalidMesh, InvalidOption, Cancelled; OutOfMemory where more than 2^26 pairs collide.
/// Cost: O(n log n) and the pairs whose boxes touch; a cloth of 92,000 triangles with 114,000 colliding pairs takes
/// about half a second on one core. Method: docs/theory/proximity.md.
[[nodiscard]] ContinuousCollisions continuous_collisions(const MeshView& mesh, std::span<const Vec3d> end,
                                                         const ImpactOptions& options = {},
                                                         const Context& context = {});

}  // namespace blum
