// Blum: meshes that cross themselves, without the crossings. SPDX-License-Identifier: Apache-2.0
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
  /// More pairs of triangles that cross or touch are not looked at.
  std::size_t most_pairs = 100000;
  /// A mesh whose new vertices, rounded, make triangles cross anew is resolved again, this often at most. With 0 the
  /// result is not checked: its parts and how they meet are exact, but triangles may cross by roundings.
  int most_rounds = 6;
  /// Points are inside where the mesh winds around them this often or more: with 2, what lies in two parts of it.
  int least_winding = 1;
};

/// What stood in the way of a mesh being the boundary of a solid.
struct CrossingCounts {
  std::size_t crossing = 0;        ///< pairs of triangles that cross
  std::size_t touching = 0;        ///< pairs that touch beside what they share, or overlap
  std::size_t flat = 0;            ///< triangles without area
  std::size_t crowded_edges = 0;   ///< edges with more than two triangles
  std::size_t cut = 0;             ///< triangles that were cut, or lost their place
  std::size_t new_vertices = 0;    ///< of the result, that the input does not have
  std::size_t touching_edges = 0;  ///< edges along which parts of the result only touch each other
  std::size_t pinches = 0;         ///< how often a part of the result meets itself in a vertex, and is apart there
  std::size_t rounds = 0;          ///< how often the mesh was resolved until its rounded vertices were in order
};

template <>
struct Description<CrossingCounts> {
  static constexpr std::string_view name = "CrossingCounts";
  static constexpr std::string_view doc = "What stood in the way of a mesh being the boundary of a solid";
  static constexpr std::tuple members{
      Member{"crossing", &CrossingCounts::crossing, "", "pairs of triangles that cross"},
      Member{"touching", &CrossingCounts::touching, "", "pairs that touch beside what they share, or overlap"},
      Member{"flat", &CrossingCounts::flat, "", "triangles without area"},
      Member{"crowded_edges", &CrossingCounts::crowded_edges, "", "edges with more than two triangles"},
      Member{"cut", &CrossingCounts::cut, "", "triangles that were cut, or lost their place"},
      Member{"new_vertices", &CrossingCounts::new_vertices, "", "of the result, that the input does not have"},
      Member{"touching_edges", &CrossingCounts::touching_edges, "",
             "edges along which parts of the result only touch each other"},
      Member{"pinches", &CrossingCounts::pinches, "",
             "how often a part of the result meets itself in a vertex, and is apart there"},
      Member{"rounds", &CrossingCounts::rounds, "",
             "how often the mesh was resolved until its rounded vertices were in order"},
  };
};

/// A mesh without crossings, or why there is none.
struct ResolvedMesh {
  static constexpr std::uint32_t no_vertex = 0xffffffffU;

  std::string obstacle;  ///< why the crossings are not resolved; empty where they are. The rest is then what was tried
  CrossingCounts counts;
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;    ///< of each vertex, in the input; no_vertex for new ones
  std::vector<std::uint32_t> triangle_of;  ///< of each triangle, the one of the input that it is a part of

  /// The body that each triangle bounds, by the number of its outer shell in topology(mesh). Where it is resolved.
  std::vector<std::uint32_t> body_of;
  bool has_inside = true;  ///< false where no point is inside: that is an obstacle, too

  [[nodiscard]] bool is_resolved() const { return obstacle.empty(); }
};

/// The boundary of the points around which a closed mesh winds once or more (or as often as asked), where the mesh
/// crosses, overlaps or touches itself, has edges with more than two triangles or has triangles without area. Vertices
/// at one place count as one.
///
/// Triangles are cut along what crosses them, and what is not on the boundary goes; triangles that nothing crosses or
/// touches are kept or go as a whole. Which parts there are, and how they meet, is decided in exact arithmetic; new
/// vertices are then rounded to doubles. The result is checked, exactly: it is closed and manifold, its shells face
/// away from the solid, no two triangles of one body cross or touch beside what they share, and its shells have the
/// genera that they had before rounding. What fails is resolved again, and in the end not resolved. Parts of the solid,
/// of one body or of two, that meet in a vertex or along an edge alone are apart there: each has vertices of its own.
/// Otherwise vertices at one place become one.
///
/// @throws InvalidMesh unless it passes validate(mesh), and where there are no triangles; Cancelled.
/// Cost of a round: that of find_self_intersections() twice, topology() and Bvh, and 0.1 ms for a pair, on one core.
[[nodiscard]] ResolvedMesh resolve_crossings(const MeshView& mesh, const ResolveOptions& options = {},
                                             const Context& context = {});

}  // namespace blum
