// Blum: medial axes extended to the surface, as meshes for shell elements. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

struct ExtendOptions {
  /// A rim is extended by at most this many of its radii, > 0. In plates the border is 1 radius away, in corners of
  /// plates 1.4.
  double max_length = 4;
  /// Rims stay whose radius is at most this part of the largest one of their sheet, >= 0: they run along an edge of the
  /// solid already.
  double border_radius = 0.05;
  /// How far the new border may be off the surface between its vertices, as a part of the radius, > 0.
  double tolerance = 0.01;
};

template <>
struct Description<ExtendOptions> {
  static constexpr std::string_view name = "ExtendOptions";
  static constexpr std::string_view doc = "How the sheets of a medial axis are extended to the surface";
  static constexpr std::tuple members{
      Member{"max_length", &ExtendOptions::max_length, "radii",
             "rims are extended by at most this many of their radii; in plates the border is 1 away",
             Range::positive()},
      Member{"border_radius", &ExtendOptions::border_radius, "",
             "rims stay whose radius is at most this part of the largest one of their sheet", Range::at_least(0)},
      Member{"tolerance", &ExtendOptions::tolerance, "radii",
             "how far the new border may be off the surface between its vertices", Range::positive()},
  };
};

/// What became of the rims. A rim vertex counts once for each group of sheets that hang together around it;
/// rim_vertices is the sum of the four that follow.
struct ExtendReport {
  double rim_length = 0;           ///< of the axis, mesh units
  double open_length = 0;          ///< of the rims that got no triangle and are not at the border, mesh units
  std::size_t rim_vertices = 0;    ///< of the axis
  std::size_t reached_border = 0;  ///< that were joined to the surface
  std::size_t reached_sheet = 0;   ///< that were joined to another sheet, which was met first
  std::size_t at_border = 0;       ///< that were at the border (ExtendOptions::border_radius) or on a sheet already
  std::size_t not_reached = 0;     ///< that stay: nothing was met within ExtendOptions::max_length
  std::size_t left_out = 0;        ///< rim edges without triangles, as these would fold back or leave the solid
  std::size_t vertices = 0;        ///< new ones
  std::size_t triangles = 0;       ///< new ones
  double axis_area = 0;            ///< of all triangles of the axis, square mesh units
  double area = 0;                 ///< of all triangles of the extended surface, square mesh units
};

template <>
struct Description<ExtendReport> {
  static constexpr std::string_view name = "ExtendReport";
  static constexpr std::string_view doc = "What became of the rims of a medial axis that was extended";
  static constexpr std::tuple members{
      Member{"rim_length", &ExtendReport::rim_length, "mesh units", "of the axis"},
      Member{"open_length", &ExtendReport::open_length, "mesh units",
             "of the rims that got no triangle and are not at the border"},
      Member{"rim_vertices", &ExtendReport::rim_vertices, "", "of the axis; the sum of the next four"},
      Member{"reached_border", &ExtendReport::reached_border, "", "rim vertices that were joined to the surface"},
      Member{"reached_sheet", &ExtendReport::reached_sheet, "", "rim vertices that were joined to another sheet"},
      Member{"at_border", &ExtendReport::at_border, "",
             "rim vertices that were at the border or on another sheet already"},
      Member{"not_reached", &ExtendReport::not_reached, "", "rim vertices that met nothing within the length"},
      Member{"left_out", &ExtendReport::left_out, "",
             "rim edges without triangles, as these would fold back or leave the solid"},
      Member{"vertices", &ExtendReport::vertices, "", "new ones"},
      Member{"triangles", &ExtendReport::triangles, "", "new ones"},
      Member{"axis_area", &ExtendReport::axis_area, "square mesh units", "of all triangles of the axis"},
      Member{"area", &ExtendReport::area, "square mesh units", "of all triangles of the extended surface"},
  };
};

/// The columns of extended axes.
namespace extended_columns {

/// Vertices, float64: twice the radius of the axis, mesh units; of new vertices, that of the rim that they extend.
inline constexpr std::string_view thickness = "thickness";
/// Triangles, int32: the sheet of the axis that they are of, or extend.
inline constexpr std::string_view sheet = "sheet";
/// Vertices and triangles, int32: 1 for new ones, 0 for those of the axis.
inline constexpr std::string_view extended = "extended";

}  // namespace extended_columns

struct ExtendedAxis {
  /// The vertices and triangles of the axis in their order, and the new ones behind them. Edges are the curves of the
  /// axis: those of no triangle. Columns are those of extended_columns.
  Complex surface;
  ExtendReport report;
  std::vector<Warning> warnings;  ///< that rims are not extended (WarningCode::not_extended)
};

/// The sheets of a medial axis, continued from their rims to the surface of the solid: the middle surface of a part
/// with thin walls, for meshes of shell elements. Take an axis of 100 to 120 degrees: less has sheets into edges, more
/// has gaps where walls meet.
///
/// Each rim vertex is joined to the closest point of the surface that the tangent plane of its sheet has within 65
/// degrees of straight ahead; between these points the new border follows edges and corners of the surface. What meets
/// another sheet first, or what continues it, ends there, without sharing vertices with it. Each new triangle lies in
/// the solid at its middle and at the middles of its sides but those of the new border, and is turned by less than 80
/// degrees from the rim's triangle. Triangles face the same way as those that they extend. The homotopy type is that of
/// the axis: the new triangles can be pushed back into the rims. Whether new triangles of different rims overlap is not
/// looked at where they meet at less than 15 degrees.
///
/// @param axis   with radii and sheets: MedialAxis::simplify(), fitted(), decimate(), a file.
/// @param solid  that it is the axis of: of a mesh.
/// @return       the same bytes for any number of threads.
/// @throws InvalidOption for options out of range, where radii or sheets are missing, for the solid of an image, or
/// saying problem_of_medial() of what there is; Cancelled.
/// Cost: that of Solid::inside() and of some ray casts for each rim vertex: about 0.1 ms for each, some ms in large
/// bodies that are no thin walls.
[[nodiscard]] ExtendedAxis extend_axis(const Complex& axis, const Solid& solid, const ExtendOptions& options = {},
                                       const Context& context = {});

/// The same of Solid::of(mesh) in one call. @throws as both.
[[nodiscard]] ExtendedAxis extend_axis(const Complex& axis, const MeshView& mesh, const ExtendOptions& options = {},
                                       const Context& context = {});

}  // namespace blum
