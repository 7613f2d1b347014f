// Blum: removal of self-crossings from meshes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct ResolveOptions {
  /// Largest number of pairs of triangles that cross or touch. With more pairs, the mesh is not resolved.
  std::size_t most_pairs = 100000;
  /// Largest number of rounds. After each round, new vertices are rounded, which may make triangles cross anew; then
  /// another round follows. With 0 there is one round, and its result is not checked. Its parts and how they meet are
  /// exact, but triangles may cross by rounding errors.
  int most_rounds = 6;
  /// Points are inside if the mesh winds around them at least this often. With 2, these are the points that lie in two
  /// of its parts.
  int least_winding = 1;
};

/// Defects that keep a mesh from being the boundary of a solid, and their repair, as counts.
struct CrossingCounts {
  std::size_t crossing = 0;        ///< pairs of triangles that cross
  std::size_t touching = 0;        ///< pairs that overlap, or touch beyond what they share
  std::size_t flat = 0;            ///< triangles without area
  std::size_t crowded_edges = 0;   ///< edges with more than two triangles
  std::size_t cut = 0;             ///< triangles that others cross or touch, or that have a cut edge
  std::size_t new_vertices = 0;    ///< vertices of the result that the input does not have
  std::size_t touching_edges = 0;  ///< edges along which parts of the result only touch each other
  std::size_t pinches = 0;         ///< times a body of the result meets itself in a vertex, and is separated there
  std::size_t rounds = 0;          ///< rounds until the rounded vertices made no new crossings
};

template <>
struct Description<CrossingCounts> {
  static constexpr std::string_view name = "CrossingCounts";
  static constexpr std::string_view doc =
      "Defects that keep a mesh from being the boundary of a solid, and their repair, as counts";
  static constexpr std::tuple members{
      Member{"crossing", &CrossingCounts::crossing, "", "pairs of triangles that cross"},
      Member{"touching", &CrossingCounts::touching, "",
             "pairs of triangles that overlap, or touch beyond what they share"},
      Member{"flat", &CrossingCounts::flat, "", "triangles without area"},
      Member{"crowded_edges", &CrossingCounts::crowded_edges, "", "edges with more than two triangles"},
      Member{"cut", &CrossingCounts::cut, "", "triangles that others cross or touch, or that have a cut edge"},
      Member{"new_vertices", &CrossingCounts::new_vertices, "", "vertices of the result that the input does not have"},
      Member{"touching_edges", &CrossingCounts::touching_edges, "",
             "edges along which parts of the result only touch each other"},
      Member{"pinches", &CrossingCounts::pinches, "",
             "times a body of the result meets itself in a vertex, and is separated there"},
      Member{"rounds", &CrossingCounts::rounds, "", "rounds until the rounded vertices made no new crossings"},
  };
};

/// Mesh without crossings, or the reason why it was not found.
struct ResolvedMesh {
  static constexpr std::uint32_t no_vertex = 0xffffffffU;

  std::string obstacle;  ///< reason why crossings are not resolved, else empty; if set, the rest describes the attempt
  CrossingCounts counts;
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;    ///< of each vertex: its number in the input; no_vertex for new ones
  std::vector<std::uint32_t> triangle_of;  ///< of each triangle: the triangle of the input that it is part of

  /// For each triangle, the body that it bounds, by the number of the body's outer shell in topology(mesh). Set if the
  /// crossings are resolved.
  std::vector<std::uint32_t> body_of;
  bool has_inside = true;  ///< false if no point is inside, which is an obstacle, too

  [[nodiscard]] bool is_resolved() const { return obstacle.empty(); }
};

/// Computes the boundary of the points around which a closed mesh winds at least once, or options.least_winding times.
/// It resolves meshes that cross, overlap or touch themselves, have edges with more than two triangles, or have
/// triangles without area. Vertices at one place count as one.
///
/// Triangles are cut along their crossings, and the parts that are not on the boundary are removed. Triangles that
/// nothing crosses or touches are kept or removed as a whole. Exact arithmetic decides which parts exist and how they
/// meet. New vertices are then rounded to doubles.
///
/// The result is checked exactly. It must be closed and manifold, and its shells must face away from the solid. No two
/// triangles of one body may cross or touch beyond what they share. Its shells must have the genera that they had
/// before rounding. A result that fails is resolved again. If the last round fails, the obstacle is reported.
///
/// Parts of the solid that meet only in a vertex or along an edge are separated there, in one body or in two. Each part
/// has vertices of its own. All other vertices at one place become one.
///
/// @throws InvalidMesh if the mesh fails validate(mesh) or has no triangles; Cancelled.
/// Cost of a round: find_self_intersections() twice, topology(), Bvh, and 0.1 ms per pair, on one core.
[[nodiscard]] ResolvedMesh resolve_crossings(const MeshView& mesh, const ResolveOptions& options = {},
                                             const Context& context = {});

}  // namespace blum
