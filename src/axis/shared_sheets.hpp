// Blum: the sheets of a medial axis, their extensions, and how these share vertices. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Sheets of a medial axis and strips that extend them.
struct ExtendedSheets {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 2>> curves;  ///< Edges without triangles.
  std::vector<double> thickness;                     ///< For each vertex, mesh units.
  std::vector<std::int32_t> is_new_vertex;           ///< 1 for vertices that the axis does not have.
  std::vector<std::int32_t> sheet;                   ///< For each triangle.
  std::vector<std::int32_t> is_new_triangle;         ///< 1 for triangles of strips.
  double seam_length = 0;                            ///< Length of the edges that strips share with other sheets.
  double unshared_length = 0;  ///< Length of the edges that lie on other sheets without sharing an edge.
};

/// Positions where sheets can share vertices.
struct SheetContacts {
  std::vector<std::array<std::uint32_t, 2>> borders;  ///< Outer edges of strips.
  std::vector<std::array<std::uint32_t, 2>> gaps;     ///< Rim edges whose strip was left out.
  double tolerance = 0;  ///< Largest gap between a border and a sheet, as a fraction of the
                         ///< thickness.
};

/// Joins strips to the sheets that they meet: see join_sheets(). Fills gaps between joined strips, and removes curves
/// through them. A join that would change the Betti numbers is left out. Vertices of the axis keep their order, except
/// for those that only removed curves have.
/// @param axis       with radii. Its vertices are the first ones of `apart`.
/// @param is_inside  returns true for points in the solid. Triangles are added only in the solid.
/// @throws Cancelled.
[[nodiscard]] ExtendedSheets share_vertices(const ExtendedSheets& apart, const Complex& axis,
                                            const SheetContacts& contacts, FunctionRef<bool(const Vec3d&)> is_inside,
                                            const Context& context);

}  // namespace blum::detail
