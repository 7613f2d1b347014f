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
  /// Largest length by which a rim is extended, in radii of the rim's balls, > 0. In a plate, the border is 1 radius
  /// away from the rim of the axis, and a corner is 1.4 radii away.
  double max_length = 4;
  /// Rims are extended only where the radius is above this fraction, >= 0, of the largest radius of the sheet. A rim
  /// with a smaller radius already runs along an edge of the solid.
  double border_radius = 0.05;
  /// Largest distance of the new border from the surface, between the vertices of the border, as a fraction of the
  /// radius, > 0.
  double tolerance = 0.01;
  /// True if extensions share vertices and edges with the sheets and extensions that they meet. If true, triangles of
  /// the axis are divided where an extension meets them, and curves through gaps that an extension closes are left out.
  bool join = true;
};

template <>
struct Description<ExtendOptions> {
  static constexpr std::string_view name = "ExtendOptions";
  static constexpr std::string_view doc = "Options of extending the sheets of a medial axis to the surface";
  static constexpr std::tuple members{
      Member{"max_length", &ExtendOptions::max_length, "radii",
             "largest extension of a rim, relative to the rim's radius: 1 reaches the border of a plate",
             Range::positive()},
      Member{"border_radius", &ExtendOptions::border_radius, "",
             "rims are not extended if their radius is at most this fraction of the largest radius of their sheet",
             Range::at_least(0)},
      Member{"tolerance", &ExtendOptions::tolerance, "radii",
             "largest distance of the new border from the surface, between the vertices of the border",
             Range::positive()},
      Member{"join", &ExtendOptions::join, "",
             "true if extensions share vertices with the sheets and extensions that they meet"},
  };
};

/// Counts and lengths of rims, by how they were extended. A rim vertex is counted once for each group of triangles
/// around it that are connected through edges. `rim_vertices` is the sum of `reached_border`, `reached_sheet`,
/// `at_border` and `not_reached`.
struct ExtendReport {
  double rim_length = 0;  ///< Length of the rims of the axis, mesh units.
  /// Length of the rims that have no new triangle and are not at the border, mesh units.
  double open_length = 0;
  std::size_t rim_vertices = 0;    ///< Rim vertices of the axis.
  std::size_t reached_border = 0;  ///< Rim vertices that were joined to the surface.
  /// Rim vertices that were joined to another sheet, because this sheet is closer than the surface.
  std::size_t reached_sheet = 0;
  std::size_t at_border = 0;    ///< Rim vertices already at the border (`border_radius`) or on another sheet.
  std::size_t not_reached = 0;  ///< Rim vertices without a surface or sheet within ExtendOptions::max_length.
  /// Rim edges without new triangles, because new triangles would fold back or leave the solid.
  std::size_t left_out = 0;
  double seam_length = 0;  ///< Length of the edges that extensions share with other sheets, mesh units.
  /// Length of the edges of extensions whose ends lie on another sheet, but which share no edge with that sheet, mesh
  /// units.
  double unshared_length = 0;
  std::size_t vertices = 0;   ///< New vertices.
  std::size_t triangles = 0;  ///< New triangles, including parts of divided triangles.
  double axis_area = 0;       ///< Area of all triangles of the axis, square mesh units.
  double area = 0;            ///< Area of all triangles of the extended surface, square mesh units.
};

template <>
struct Description<ExtendReport> {
  static constexpr std::string_view name = "ExtendReport";
  static constexpr std::string_view doc = "Counts and lengths of the rims of an extended medial axis by outcome";
  static constexpr std::tuple members{
      Member{"rim_length", &ExtendReport::rim_length, "mesh units", "length of the rims of the axis"},
      Member{"open_length", &ExtendReport::open_length, "mesh units",
             "length of the rims that have no new triangle and are not at the border"},
      Member{"rim_vertices", &ExtendReport::rim_vertices, "",
             "rim vertices of the axis: the sum of reached_border, reached_sheet, at_border and not_reached"},
      Member{"reached_border", &ExtendReport::reached_border, "", "rim vertices that were joined to the surface"},
      Member{"reached_sheet", &ExtendReport::reached_sheet, "", "rim vertices that were joined to another sheet"},
      Member{"at_border", &ExtendReport::at_border, "",
             "rim vertices that were already at the border or on another sheet"},
      Member{"not_reached", &ExtendReport::not_reached, "",
             "rim vertices without a surface or sheet within max_length"},
      Member{"left_out", &ExtendReport::left_out, "",
             "rim edges without new triangles, because the triangles would fold back or leave the solid"},
      Member{"seam_length", &ExtendReport::seam_length, "mesh units",
             "length of the edges that extensions share with other sheets"},
      Member{"unshared_length", &ExtendReport::unshared_length, "mesh units",
             "length of the edges of extensions that lie on other sheets, but share no edge with these sheets"},
      Member{"vertices", &ExtendReport::vertices, "", "new vertices"},
      Member{"triangles", &ExtendReport::triangles, "", "new triangles, including parts of divided triangles"},
      Member{"axis_area", &ExtendReport::axis_area, "square mesh units", "area of all triangles of the axis"},
      Member{"area", &ExtendReport::area, "square mesh units", "area of all triangles of the extended surface"},
  };
};

/// Names of the columns of extended axes.
namespace extended_columns {

/// Vertices, float64, mesh units: twice the radius of the axis. A new vertex has the value of the rim that it extends.
inline constexpr std::string_view thickness = "thickness";
/// Triangles, int32: the number of the sheet of the axis that the triangle belongs to or extends.
inline constexpr std::string_view sheet = "sheet";
/// Vertices and triangles, int32: 1 for new vertices and triangles, 0 for those of the axis.
inline constexpr std::string_view extended = "extended";

}  // namespace extended_columns

struct ExtendedAxis {
  /// The vertices of the axis in their order, then the new vertices. Without ExtendOptions::join, the triangles of the
  /// axis come first as well. The edges are the curves of the axis, which belong to no triangle. With `join`, curves
  /// through gaps that extensions close are left out, with their vertices. The columns are those of `extended_columns`.
  Complex surface;
  ExtendReport report;
  /// WarningCode::not_extended if some rims are not extended, or meet other sheets without shared vertices.
  std::vector<Warning> warnings;
};

/// Returns the sheets of a medial axis, extended from their rims to the surface of the solid. For a solid with thin
/// walls, the result is the middle surface, for example for meshes of shell elements. Use an axis with a theta of 100
/// to 120 degrees. A smaller theta adds sheets that run into edges of the solid; a larger theta leaves gaps where walls
/// meet.
///
/// Each rim vertex is joined to the closest point of the surface in the tangent plane of its sheet. The direction to
/// the closest point differs by at most 65 degrees from the direction straight out of the rim. Between the closest
/// points of neighbouring rim vertices, the new border follows edges and corners of the surface. If another sheet, or
/// the extension of another sheet, lies between the rim and the surface, the new triangles end at this sheet or
/// extension. The middle of each new triangle lies in the solid, and so do the middles of its sides, except for sides
/// on the new border. A new triangle is turned by less than 80 degrees relative to the axis's triangle at the rim edge.
/// The new triangle faces the same way as the axis's triangle. The homotopy type is that of the axis, because the new
/// triangles can be pushed back into the rims. Extensions of different rims may overlap if they meet at less than 15
/// degrees; overlaps are not checked.
///
/// With ExtendOptions::join, new triangles share vertices and edges with the sheet or extension that they meet. To
/// share them, triangles are divided, border vertices move by at most ExtendOptions::tolerance, and gaps of few edges
/// are filled. Extensions are joined only where the Betti numbers stay those of the axis. Extensions that are not
/// joined keep separate vertices. The length of their edges on other sheets is ExtendReport::unshared_length.
///
/// @param axis   axis with radii and sheets, for example from MedialAxis::simplify(), fitted(), decimate() or a file.
/// @param solid  solid of a mesh; the axis must be an axis of this solid.
/// @return       the same bytes for any number of threads.
/// @throws InvalidOption if an option is out of range, radii or sheets are missing, or the solid is that of an image.
/// The function also throws InvalidOption if problem_of_medial() reports a problem in the columns that the axis has.
/// @throws Cancelled.
/// Cost: about 0.1 ms per rim vertex, for Solid::inside() and a few ray casts. In large bodies without thin walls, the
/// cost is a few ms per rim vertex.
[[nodiscard]] ExtendedAxis extend_axis(const Complex& axis, const Solid& solid, const ExtendOptions& options = {},
                                       const Context& context = {});

/// Extends an axis to the surface of Solid::of(mesh).
/// @throws as extend_axis() with a Solid, and as Solid::of().
[[nodiscard]] ExtendedAxis extend_axis(const Complex& axis, const MeshView& mesh, const ExtendOptions& options = {},
                                       const Context& context = {});

}  // namespace blum
