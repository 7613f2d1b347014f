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
  /// Largest number of pairs of triangles that may cross or touch. If there are more pairs, the mesh is not resolved.
  std::size_t most_pairs = 100000;
  /// Largest number of rounds. At the end of a round, new vertices are rounded. If rounding makes triangles cross
  /// again, another round follows. With 0, there is one round, and its result is not checked: its connectivity is
  /// exact, but triangles may cross because of rounding errors.
  int most_rounds = 6;
  /// Points with at least this winding number are inside. With 2, the inside consists of the points that two
  /// overlapping parts of the mesh both enclose.
  int least_winding = 1;
};

/// Counts of the defects that keep a mesh from bounding a solid, and of the changes that repair them.
struct CrossingCounts {
  std::size_t crossing = 0;        ///< pairs of triangles that cross
  std::size_t touching = 0;        ///< pairs that overlap, or touch beyond shared corners and edges
  std::size_t flat = 0;            ///< triangles without area
  std::size_t crowded_edges = 0;   ///< edges with more than two triangles
  std::size_t cut = 0;             ///< triangles that other triangles cross or touch, or that have a cut edge
  std::size_t new_vertices = 0;    ///< vertices of the result that the input does not have
  std::size_t touching_edges = 0;  ///< edges along which parts of the result only touch each other
  std::size_t pinches = 0;         ///< times a body of the result meets itself in a vertex, and is separated there
  std::size_t rounds = 0;          ///< number of rounds until rounded vertices made no new crossings
};

template <>
struct Description<CrossingCounts> {
  static constexpr std::string_view name = "CrossingCounts";
  static constexpr std::string_view doc =
      "Counts of the defects that keep a mesh from bounding a solid, and of the changes that repair them";
  static constexpr std::tuple members{
      Member{"crossing", &CrossingCounts::crossing, "", "pairs of triangles that cross"},
      Member{"touching", &CrossingCounts::touching, "",
             "pairs of triangles that overlap, or touch beyond their common corners and edges"},
      Member{"flat", &CrossingCounts::flat, "", "triangles without area"},
      Member{"crowded_edges", &CrossingCounts::crowded_edges, "", "edges with more than two triangles"},
      Member{"cut", &CrossingCounts::cut, "", "triangles that other triangles cross or touch, or that have a cut edge"},
      Member{"new_vertices", &CrossingCounts::new_vertices, "", "vertices of the result that the input does not have"},
      Member{"touching_edges", &CrossingCounts::touching_edges, "",
             "edges along which parts of the result only touch each other"},
      Member{"pinches", &CrossingCounts::pinches, "",
             "number of times that a body of the result meets itself in a vertex, and is separated there"},
      Member{"rounds", &CrossingCounts::rounds, "",
             "rounds of cutting until rounding the vertices made no new crossings"},
  };
};

/// Mesh without crossings, or the reason why the crossings were not resolved.
struct ResolvedMesh {
  static constexpr std::uint32_t no_vertex = 0xffffffffU;

  std::string obstacle;  ///< reason why crossings are not resolved; empty if they are. If there is a reason, the other
                         ///< members describe the failed attempt
  CrossingCounts counts;
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;    ///< for each vertex of `mesh`: its index in the input; no_vertex for new
                                           ///< vertices
  std::vector<std::uint32_t> triangle_of;  ///< for each triangle of `mesh`: the triangle of the input that contains it

  /// For each triangle of `mesh`: the body that it bounds, as the index of the body's outer shell in topology(mesh).
  /// The list is empty if the crossings are not resolved.
  std::vector<std::uint32_t> body_of;
  bool has_inside = true;  ///< false if no point is inside; `obstacle` then contains this reason

  [[nodiscard]] bool is_resolved() const { return obstacle.empty(); }
};

/// Computes the boundary of the set of points around which a closed mesh winds at least options.least_winding times (by
/// default once). The mesh may cross, overlap or touch itself, have edges with more than two triangles, or have
/// triangles without area. Vertices at the same position count as one vertex.
///
/// Triangles are cut along their crossings, and the parts that are not on the boundary are removed. Triangles that
/// nothing crosses or touches are kept or removed as a whole. Exact arithmetic decides which parts exist and how they
/// are connected. New vertices are then rounded to doubles.
///
/// The result is checked exactly. The mesh must be closed and manifold, and its shells must face away from the solid.
/// No two triangles of one body may cross, or touch beyond shared corners and edges. Rounding must not change the genus
/// of any shell. If the result fails this check, its crossings are resolved in another round. If the last round fails,
/// ResolvedMesh::obstacle contains the reason.
///
/// If parts of the solid meet only in a vertex or an edge, the mesh is separated there: each part gets separate
/// vertices. Both parts of one body and parts of different bodies are separated. All other vertices at the same
/// position become one vertex.
///
/// @throws InvalidMesh if the mesh fails validate(mesh) or has no triangles; Cancelled.
/// Cost of a round, on one core: find_self_intersections() twice, topology(), a Bvh, and 0.1 ms for each pair of
/// triangles that cross or touch.
[[nodiscard]] ResolvedMesh resolve_crossings(const MeshView& mesh, const ResolveOptions& options = {},
                                             const Context& context = {});

}  // namespace blum
