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
  std::size_t vertices_before = 0;  ///< Vertices that triangles name.
  std::size_t vertices = 0;         ///< Vertices of the result.
  std::size_t triangles_before = 0;
  std::size_t triangles = 0;
  std::size_t reversed_triangles = 0;  ///< Triangles that faced another way than most of their shell.
  std::size_t reversed_shells = 0;     ///< Shells that faced the solid.
  std::size_t collapses = 0;           ///< Vertices that were moved onto a neighbour.
  std::size_t flips = 0;               ///< Edges that were flipped.
  /// Bound on the Hausdorff distance of the mesh and the result, rounding included, at most the tolerance. Mesh units.
  double deviation = 0;
  double smallest_height_before = 0;  ///< Height of a triangle above its longest side, mesh units.
  double smallest_height = 0;
  BettiNumbers betti_before{};  ///< Components, tunnels and voids of the solid.
  BettiNumbers betti{};         ///< Those of the result's solid, which are the same.
};

template <>
struct Description<CleanReport> {
  static constexpr std::string_view name = "CleanReport";
  static constexpr std::string_view doc = "Changes by cleaning a mesh";
  static constexpr std::tuple members{
      Member{"vertices_before", &CleanReport::vertices_before, "", "vertices that triangles of the mesh name"},
      Member{"vertices", &CleanReport::vertices, "", "vertices of the result"},
      Member{"triangles_before", &CleanReport::triangles_before, "", "triangles of the mesh"},
      Member{"triangles", &CleanReport::triangles, "", "triangles of the result"},
      Member{"reversed_triangles", &CleanReport::reversed_triangles, "",
             "triangles that faced another way than most of their shell"},
      Member{"reversed_shells", &CleanReport::reversed_shells, "", "shells that faced the solid"},
      Member{"collapses", &CleanReport::collapses, "", "vertices that were moved onto a neighbour"},
      Member{"flips", &CleanReport::flips, "", "edges that were flipped"},
      Member{"deviation", &CleanReport::deviation, "mesh units", "bound of the distance between mesh and result"},
      Member{"smallest_height_before", &CleanReport::smallest_height_before, "mesh units",
             "smallest height of a triangle of the mesh above its longest side"},
      Member{"smallest_height", &CleanReport::smallest_height, "mesh units",
             "smallest height of a triangle of the result"},
      Member{"betti_before", &CleanReport::betti_before, "", "components, tunnels, voids of the solid"},
      Member{"betti", &CleanReport::betti, "", "components, tunnels, voids of the result's solid: the same"},
  };
};

/// Cleaned mesh.
struct CleanedMesh {
  TriangleMesh mesh;  ///< Its vertices are some of the input's, in their order, then those at crossings.
  std::vector<std::uint32_t> vertex_of;  ///< Vertex of the input, ascending; SolidBody::no_vertex at crossings.
  CleanReport report;
  Solid solid;                         ///< Solid that the mesh bounds, as found when the result was checked.
  std::vector<Warning> warnings = {};  ///< For a mesh: what was reversed (reversal_warnings()) or left out.
};

/// Removes needless vertices and needles from a closed mesh, within a tolerance. Use it before voronoi_complex(), whose
/// cost grows with the number of sites, and most with small ones.
///
/// Steps are made one by one, the smallest change of the surface first. A step moves a vertex onto a neighbour, or
/// flips an edge of a flat triangle. It keeps the surface up to homeomorphism (the link condition). It has a bound on
/// how far the surface moves, which adds to what its place has moved before. Exact arithmetic checks that no new
/// triangle crosses or touches another one. Steps that would fold the surface over are left out. So are steps that
/// lower the smallest height of triangles, unless it stays above a quarter and no needle results. Finally the whole
/// result is checked again. Vertices never move to new places. Method and proof of the bound: docs/theory/solid.md.
///
/// @param solid      polyhedron whose bodies do not touch. Its surface is cleaned, and the result is near this surface.
///                   Coordinates have magnitude 1e-45 to 1e45, or are 0.
/// @param tolerance  largest distance between surface and result, in both directions, mesh units. At least 1e-12 of the
///                   diagonal of the box around the surface, and at most that diagonal.
/// @return           the same for any number of threads.
/// @throws InvalidMesh if the solid is not such a polyhedron. InvalidOption if the tolerance is out of range.
/// Cancelled. Error if the check of the result fails, which would be an error in Blum.
/// Cost: on one core about 12 microseconds per triangle if most are removed, 3 if none are; 500 bytes.
[[nodiscard]] CleanedMesh clean_mesh(const Solid& solid, double tolerance, const Context& context = {});

/// Cleans the surface of the solid that a mesh bounds, found by Solid::of().
/// @param mesh  closed. It may face any way, and cross itself if that is resolved. It may have triangles without area
///              if flips of their longest sides remove them. Its segments, points and unused vertices are left out.
[[nodiscard]] CleanedMesh clean_mesh(const MeshView& mesh, double tolerance, const Context& context = {});

}  // namespace blum
