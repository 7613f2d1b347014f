// Blum: closed meshes without needles and needless vertices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// Effects of cleaning a mesh.
struct CleanReport {
  std::size_t vertices_before = 0;  ///< Vertices of the input that triangles use.
  std::size_t vertices = 0;         ///< Vertices of the result.
  std::size_t triangles_before = 0;
  std::size_t triangles = 0;
  std::size_t reversed_triangles = 0;  ///< Triangles that faced against the majority of their shell.
  std::size_t reversed_shells = 0;     ///< Shells that faced into the solid.
  std::size_t collapses = 0;           ///< Vertices that were moved onto a neighbour.
  std::size_t flips = 0;               ///< Edges that were flipped.
  /// Upper bound on the Hausdorff distance between input and result, rounding included, mesh units. The bound is at
  /// most the tolerance.
  double deviation = 0;
  double smallest_height_before = 0;  ///< Smallest height of an input triangle above its longest side, mesh units.
  double smallest_height = 0;
  BettiNumbers betti_before{};  ///< Components, tunnels and voids of the solid.
  BettiNumbers betti{};         ///< Components, tunnels and voids of the result's solid; equal to betti_before.
};

template <>
struct Description<CleanReport> {
  static constexpr std::string_view name = "CleanReport";
  static constexpr std::string_view doc = "Changes of a mesh by cleaning";
  static constexpr std::tuple members{
      Member{"vertices_before", &CleanReport::vertices_before, "", "vertices that triangles of the mesh use"},
      Member{"vertices", &CleanReport::vertices, "", "vertices of the result"},
      Member{"triangles_before", &CleanReport::triangles_before, "", "triangles of the mesh"},
      Member{"triangles", &CleanReport::triangles, "", "triangles of the result"},
      Member{"reversed_triangles", &CleanReport::reversed_triangles, "",
             "triangles that faced against the majority of their shell"},
      Member{"reversed_shells", &CleanReport::reversed_shells, "", "shells that faced into the solid"},
      Member{"collapses", &CleanReport::collapses, "", "vertices that were moved onto a neighbour"},
      Member{"flips", &CleanReport::flips, "", "edges that were flipped"},
      Member{"deviation", &CleanReport::deviation, "mesh units",
             "upper bound on the Hausdorff distance between mesh and result"},
      Member{"smallest_height_before", &CleanReport::smallest_height_before, "mesh units",
             "smallest height of a triangle of the mesh above its longest side"},
      Member{"smallest_height", &CleanReport::smallest_height, "mesh units",
             "smallest height of a triangle of the result"},
      Member{"betti_before", &CleanReport::betti_before, "", "components, tunnels, voids of the solid"},
      Member{"betti", &CleanReport::betti, "",
             "components, tunnels, voids of the result's solid: equal to betti_before"},
  };
};

/// Cleaned mesh.
struct CleanedMesh {
  TriangleMesh mesh;  ///< Vertices of the input come first, in the input's order. New vertices at crossings follow.
  /// For each vertex of `mesh`: its index in the input, ascending; SolidBody::no_vertex at crossings.
  std::vector<std::uint32_t> vertex_of;
  CleanReport report;
  Solid solid;                         ///< Solid that `mesh` bounds, from the final check.
  std::vector<Warning> warnings = {};  ///< If a mesh was given: warnings about reversed triangles and shells
                                       ///< (reversal_warnings()), and about segments and points that were left out.
};

/// Removes needless vertices and needles (thin triangles) from a closed mesh, within a tolerance. Use it before
/// voronoi_complex(), whose cost grows with the number of sites. Small sites cost most.
///
/// Steps are made one by one. The next step is always the step that changes the surface least. A step moves a vertex
/// onto a neighbour, or flips the longest side of a flat triangle. The surface stays homeomorphic to the input (the
/// link condition). Each step has a bound on how far it moves the surface. Bounds of successive steps that move the
/// same part of the surface are added. Exact arithmetic checks that no new triangle crosses or touches another
/// triangle. Steps that would fold the surface over are not made. A step that makes no needle may lower the smallest
/// height of the triangles around it to a quarter of its value, but not further. Finally the whole result is checked
/// again. All vertices of the result keep their positions. Method and proof of the bound: docs/theory/solid.md.
///
/// @param solid      polyhedron whose bodies do not touch. Solid::surface() is cleaned. Coordinates of the surface must
///                   be 0, or have magnitudes of 1e-45 to 1e45.
/// @param tolerance  largest distance between surface and result, in both directions, mesh units. The tolerance must be
///                   at least 1e-12 times the diagonal of the box around the surface, and at most that diagonal.
/// @return           the cleaned mesh; it is the same for any number of threads.
/// @throws InvalidMesh if the solid is not a polyhedron whose bodies do not touch. InvalidOption if the tolerance is
/// out of range. Cancelled. Error if the check of the result fails, which would be a bug in Blum.
/// Cost: 500 bytes of memory per triangle. On one core, about 12 microseconds per triangle if most triangles are
/// removed, and 3 microseconds if none are removed.
[[nodiscard]] CleanedMesh clean_mesh(const Solid& solid, double tolerance, const Context& context = {});

/// Cleans the surface of the solid that a mesh bounds, found by Solid::of().
/// @param mesh  closed. The mesh may face inwards or outwards. The mesh may cross itself if Solid::of() resolves the
///              crossings. Triangles without area are allowed if flips of their longest sides can remove them.
///              Segments, points and unused vertices are left out.
[[nodiscard]] CleanedMesh clean_mesh(const MeshView& mesh, double tolerance, const Context& context = {});

}  // namespace blum
