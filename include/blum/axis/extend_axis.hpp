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
  /// A rim is extended by at most this many of its radii, > 0. The border of a plate is 1 radius away, a corner of a
  /// plate 1.4.
  double max_length = 4;
  /// A rim stays if its radius is at most this part of the largest radius of its sheet, >= 0. Such a rim already runs
  /// along an edge of the solid.
  double border_radius = 0.05;
  /// Distance of the new border from the surface between its vertices, at most, as a part of the radius, > 0.
  double tolerance = 0.01;
};

template <>
struct Description<ExtendOptions> {
  static constexpr std::string_view name = "ExtendOptions";
  static constexpr std::string_view doc = "Options of extending the sheets of a medial axis to the surface";
  static constexpr std::tuple members{
      Member{"max_length", &ExtendOptions::max_length, "radii",
             "largest extension of a rim, in radii of the rim; in plates the border is 1 away", Range::positive()},
      Member{"border_radius", &ExtendOptions::border_radius, "",
             "rims that stay: those with at most this fraction of the largest radius of their sheet",
             Range::at_least(0)},
      Member{"tolerance", &ExtendOptions::tolerance, "radii",
             "largest distance of the new border from the surface between its vertices", Range::positive()},
  };
};

/// Counts and lengths of rims by outcome. A rim vertex counts once for each group of sheets that are connected around
/// it. `rim_vertices` is the sum of the four members after it.
struct ExtendReport {
  double rim_length = 0;           ///< Length of the rims of the axis, mesh units.
  double open_length = 0;          ///< Length of the rims that got no triangle and are not at the border, mesh units.
  std::size_t rim_vertices = 0;    ///< Rim vertices of the axis.
  std::size_t reached_border = 0;  ///< Rim vertices that were joined to the surface.
  std::size_t reached_sheet = 0;   ///< Rim vertices that were joined to another sheet, which was met first.
  std::size_t at_border = 0;       ///< Rim vertices already at the border (`border_radius`) or on another sheet.
  std::size_t not_reached = 0;     ///< Rim vertices that stay: nothing was met within ExtendOptions::max_length.
  std::size_t left_out = 0;        ///< Rim edges without triangles, because these would fold back or leave the solid.
  std::size_t vertices = 0;        ///< New vertices.
  std::size_t triangles = 0;       ///< New triangles.
  double axis_area = 0;            ///< Area of all triangles of the axis, square mesh units.
  double area = 0;                 ///< Area of all triangles of the extended surface, square mesh units.
};

template <>
struct Description<ExtendReport> {
  static constexpr std::string_view name = "ExtendReport";
  static constexpr std::string_view doc = "Counts and lengths of the rims of an extended medial axis by outcome";
  static constexpr std::tuple members{
      Member{"rim_length", &ExtendReport::rim_length, "mesh units", "length of the rims of the axis"},
      Member{"open_length", &ExtendReport::open_length, "mesh units",
             "length of the rims that got no triangle and are not at the border"},
      Member{"rim_vertices", &ExtendReport::rim_vertices, "", "rim vertices of the axis; sum of the next four"},
      Member{"reached_border", &ExtendReport::reached_border, "", "rim vertices that were joined to the surface"},
      Member{"reached_sheet", &ExtendReport::reached_sheet, "", "rim vertices that were joined to another sheet"},
      Member{"at_border", &ExtendReport::at_border, "",
             "rim vertices that were already at the border or on another sheet"},
      Member{"not_reached", &ExtendReport::not_reached, "", "rim vertices that met nothing within the length"},
      Member{"left_out", &ExtendReport::left_out, "",
             "rim edges without triangles, because these would fold back or leave the solid"},
      Member{"vertices", &ExtendReport::vertices, "", "new vertices"},
      Member{"triangles", &ExtendReport::triangles, "", "new triangles"},
      Member{"axis_area", &ExtendReport::axis_area, "square mesh units", "area of all triangles of the axis"},
      Member{"area", &ExtendReport::area, "square mesh units", "area of all triangles of the extended surface"},
  };
};

/// Names of the columns of extended axes.
namespace extended_columns {

/// Vertices, float64, mesh units: twice the radius of the axis. A new vertex has the value of the rim that it extends.
inline constexpr std::string_view thickness = "thickness";
/// Triangles, int32: the sheet of the axis that they belong to or extend.
inline constexpr std::string_view sheet = "sheet";
/// Vertices and triangles, int32: 1 for new ones, 0 for those of the axis.
inline constexpr std::string_view extended = "extended";

}  // namespace extended_columns

struct ExtendedAxis {
  /// Vertices and triangles of the axis in their order, then the new ones. Edges are the curves of the axis, which have
  /// no triangle. Columns are those of `extended_columns`.
  Complex surface;
  ExtendReport report;
  std::vector<Warning> warnings;  ///< Reports rims that are not extended (WarningCode::not_extended).
};

/// Returns the sheets of a medial axis, extended from their rims to the surface of the solid. The result is the middle
/// surface of a part with thin walls, for meshes of shell elements. Use an axis of 100 to 120 degrees. A smaller angle
/// adds sheets that run into edges; a larger one leaves gaps where walls meet.
///
/// Each rim vertex is joined to the closest point of the surface in the tangent plane of its sheet. The direction to
/// that point is within 65 degrees of straight ahead. Between these points, the new border follows edges and corners of
/// the surface. If a rim meets another sheet or its extension first, it ends there, without shared vertices. Each new
/// triangle has its middle and the middles of its sides in the solid, except sides on the new border. It is turned by
/// less than 80 degrees from the rim's triangle, and faces the same way as the triangles that it extends. The homotopy
/// type is that of the axis, because the new triangles can be pushed back into the rims. New triangles of different
/// rims that meet at less than 15 degrees may overlap; this is not checked.
///
/// @param axis   with radii and sheets, for example from MedialAxis::simplify(), fitted(), decimate() or a file.
/// @param solid  solid of a mesh, whose axis this is.
/// @return       the same bytes for any number of threads.
/// @throws InvalidOption if an option is out of range, radii or sheets are missing, or the solid is that of an image.
/// Also if problem_of_medial() reports a problem in the columns that exist. Cancelled.
/// Cost: Solid::inside() and some ray casts per rim vertex, about 0.1 ms each; some ms in large bodies without thin
/// walls.
[[nodiscard]] ExtendedAxis extend_axis(const Complex& axis, const Solid& solid, const ExtendOptions& options = {},
                                       const Context& context = {});

/// Extends an axis to the surface of Solid::of(mesh).
/// @throws as both.
[[nodiscard]] ExtendedAxis extend_axis(const Complex& axis, const MeshView& mesh, const ExtendOptions& options = {},
                                       const Context& context = {});

}  // namespace blum
