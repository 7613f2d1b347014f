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

/// What cleaning a mesh has done.
struct CleanReport {
  std::size_t vertices_before = 0;  ///< that triangles name
  std::size_t vertices = 0;         ///< of the result
  std::size_t triangles_before = 0;
  std::size_t triangles = 0;
  std::size_t reversed_triangles = 0;  ///< that faced another way than most of their shell
  std::size_t reversed_shells = 0;     ///< that faced the solid
  std::size_t collapses = 0;           ///< vertices that were moved onto a neighbour
  std::size_t flips = 0;               ///< edges that were turned
  /// Each point of the result has one of the mesh that is no further away than this, and each point of the mesh one of
  /// the result: a bound, rounding included, of at most the tolerance. Mesh units.
  double deviation = 0;
  double smallest_height_before = 0;  ///< of a triangle, above its longest side; mesh units
  double smallest_height = 0;
  BettiNumbers betti_before{};  ///< of the solid: components, tunnels, voids
  BettiNumbers betti{};         ///< of the result's; they are the same
};

template <>
struct Description<CleanReport> {
  static constexpr std::string_view name = "CleanReport";
  static constexpr std::string_view doc = "What cleaning a mesh has done";
  static constexpr std::tuple members{
      Member{"vertices_before", &CleanReport::vertices_before, "", "that triangles of the mesh name"},
      Member{"vertices", &CleanReport::vertices, "", "of the result"},
      Member{"triangles_before", &CleanReport::triangles_before, "", "of the mesh"},
      Member{"triangles", &CleanReport::triangles, "", "of the result"},
      Member{"reversed_triangles", &CleanReport::reversed_triangles, "",
             "triangles that faced another way than most of their shell"},
      Member{"reversed_shells", &CleanReport::reversed_shells, "", "shells that faced the solid"},
      Member{"collapses", &CleanReport::collapses, "", "vertices that were moved onto a neighbour"},
      Member{"flips", &CleanReport::flips, "", "edges that were turned"},
      Member{"deviation", &CleanReport::deviation, "mesh units",
             "a bound: how far mesh and result are from each other at most"},
      Member{"smallest_height_before", &CleanReport::smallest_height_before, "mesh units",
             "of a triangle of the mesh, above its longest side"},
      Member{"smallest_height", &CleanReport::smallest_height, "mesh units", "of a triangle of the result"},
      Member{"betti_before", &CleanReport::betti_before, "", "components, tunnels, voids of the solid"},
      Member{"betti", &CleanReport::betti, "", "of the result's solid: the same"},
  };
};

/// A cleaned mesh.
struct CleanedMesh {
  TriangleMesh
      mesh;  ///< its vertices are some of the input's, in their order, behind them those where it crossed itself
  std::vector<std::uint32_t> vertex_of;  ///< of each vertex, in the input; rising; or SolidBody::no_vertex
  CleanReport report;
  Solid solid;                         ///< that the mesh bounds, as it was found when the result was checked
  std::vector<Warning> warnings = {};  ///< of a mesh: what was reversed (reversal_warnings()) or left out
};

/// A closed mesh without needles and vertices that it can do without, within a tolerance: what to do before
/// voronoi_complex(), whose cost grows with the number of sites, and with small ones most.
///
/// Vertices are moved onto neighbours and edges of flat triangles are turned, one by one, what moves the surface least
/// first. Each step keeps the surface what it is up to homeomorphism (the link condition), is bounded in how far the
/// surface moves, adds to what its place has moved before, and is checked in exact arithmetic against all triangles
/// around: no two cross or touch. Steps that would fold the surface over, or make triangles flatter than the tolerance
/// and than those which they replace, are left out. In the end the whole result is checked anew. Vertices never move
/// to new places. Method, and why the bound holds: docs/theory/solid.md.
///
/// @param solid      a polyhedron whose bodies do not touch. Its surface is what is cleaned, and what the result is
/// near
///                   to; coordinates of magnitude 1e-45 to 1e45, or 0.
/// @param tolerance  the result is nowhere further from the surface than this, nor the surface from it: mesh units; at
///                   least 1e-12 of the diagonal of the box around it, and at most that diagonal.
/// @return           the same for any number of threads.
/// @throws InvalidMesh where the solid is none such; InvalidOption for tolerances out of range; Cancelled; Error where
/// the result's check fails, which would be a mistake of Blum's.
/// Cost: about 12 microseconds for each triangle on one core where most go, 3 where none do; 500 bytes.
[[nodiscard]] CleanedMesh clean_mesh(const Solid& solid, double tolerance, const Context& context = {});

/// The same of the solid that a mesh bounds, found by Solid::of().
/// @param mesh  closed; it may face any way, and cross itself where that is resolved. Triangles without area may be in
///              it where a flip of their longest side takes them out. Its segments, points and vertices that no
///              triangle names are left out.
[[nodiscard]] CleanedMesh clean_mesh(const MeshView& mesh, double tolerance, const Context& context = {});

}  // namespace blum
