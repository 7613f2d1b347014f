// Blum: the columns of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>

#include "blum/complex/complex.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Location of a vertex or an edge on a medial axis. The column `role` contains these values as numbers.
enum class MedialRole : std::uint8_t {
  sheet,     ///< Inside a sheet, with triangles all around.
  rim,       ///< On the free border of a sheet.
  seam,      ///< At three or more triangles.
  curve,     ///< On a curve, without triangles.
  junction,  ///< Vertex where seams or curves begin, end or meet, or where sheets touch.
};

template <>
struct Description<MedialRole> {
  static constexpr std::string_view name = "MedialRole";
  static constexpr std::array values{NamedValue{MedialRole::sheet, "sheet"}, NamedValue{MedialRole::rim, "rim"},
                                     NamedValue{MedialRole::seam, "seam"}, NamedValue{MedialRole::curve, "curve"},
                                     NamedValue{MedialRole::junction, "junction"}};
};

/// Names of the columns that a complex must have to represent a medial axis. Vertices are centres of balls inside the
/// solid. Edges are curves, rims and seams; inner edges of sheets are not listed. No name of a vertex column starts
/// with vertex_, edge_ or triangle_, because .npz files use these prefixes to distinguish kinds of columns.
namespace medial_columns {

/// Vertices, float64: exact distance to the surface, mesh units.
inline constexpr std::string_view radius = "radius";
/// Vertices, 3 x float64: the closest point of the surface, and the closest point of the other wall. If only one wall
/// is near, both columns contain the same point.
inline constexpr std::array<std::string_view, 2> footprints{"footprint_0", "footprint_1"};
/// Vertices, int32: the sites of the input mesh, or voxels of the input image, that contain the footprints; -1 if
/// unknown.
inline constexpr std::array<std::string_view, 2> sites{"site_0", "site_1"};
/// Vertices, float64, degrees: the angle between the two footprints, seen from the vertex. Edges and triangles,
/// float32, degrees: the separation angle of the edge or triangle; 0 if it exists only to preserve the homotopy type.
inline constexpr std::string_view separation_angle = "separation_angle";
/// Vertices and edges, int32: MedialRole. Edges have the roles rim, seam or curve.
inline constexpr std::string_view role = "role";
/// Triangles, int32: number of the sheet, from 0. The triangles of a sheet are connected through edges of exactly two
/// triangles. Next to a seam, an edge that bends by 37 degrees or more does not connect its triangles. In the axis of a
/// mesh, the number of a sheet depends on the faces on its two sides (see medial_axis()). In the axis of an image,
/// sheets are numbered in the order of their first triangles.
inline constexpr std::string_view sheet = "sheet";
/// Additional columns of axes from Voronoi diagrams with patches (add_patch_columns()). Triangles, int32: the patches
/// on the two sides, the smaller number first. The two numbers are equal if both sides belong to the same patch.
inline constexpr std::array<std::string_view, 2> patches{"patch_a", "patch_b"};
/// Additional column of the same axes. Triangles, int32: number of the sheet of two patches, from 0; -1 inside a patch.
inline constexpr std::string_view patch_sheet = "patch_sheet";

/// Additional column of axes of all angles (MedialAxis::nested). Vertices, edges and triangles, float32, degrees: a
/// vertex, edge or triangle exists if theta is less than this angle. Infinite if it exists at every theta.
inline constexpr std::string_view until = "until";
/// Edges, float32, degrees: smallest theta at which the edge has its role. An edge has its role if from <= theta <
/// until. If the role of an edge changes with theta, the edge is listed once for each role. For example, an edge that
/// is a seam, then a rim, then a curve is listed three times.
inline constexpr std::string_view from = "from";

}  // namespace medial_columns

/// Read-only view of the columns of a medial axis. The view is valid while the complex exists and does not change.
struct MedialView {
  /// Finds the columns.
  /// @throws InvalidOption if a column is missing, or has a wrong type or number of rows.
  explicit MedialView(const Complex& complex);

  std::span<const Vec3d> positions;
  std::span<const double> radius, separation_angle;
  std::span<const std::array<std::uint32_t, 2>> edges;
  std::span<const float> edge_angle;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const float> triangle_angle;
  std::span<const std::int32_t> sheet;

  [[nodiscard]] Vec3d footprint(std::size_t vertex, std::size_t which) const {
    const std::span<const double> at = footprints_[which].subspan(3 * vertex, 3);
    return {at[0], at[1], at[2]};
  }
  [[nodiscard]] SiteId site(std::size_t vertex, std::size_t which) const {
    return SiteId(static_cast<std::uint32_t>(sites_[which][vertex]));
  }
  [[nodiscard]] MedialRole role(std::size_t vertex) const { return static_cast<MedialRole>(roles_[vertex]); }
  [[nodiscard]] MedialRole edge_role(std::size_t edge) const { return static_cast<MedialRole>(edge_roles_[edge]); }
  [[nodiscard]] ComplexView cells() const { return {positions.size(), edges, triangles}; }

 private:
  std::array<std::span<const double>, 2> footprints_;
  std::array<std::span<const std::int32_t>, 2> sites_;
  std::span<const std::int32_t> roles_, edge_roles_;
};

/// Read-only view of the additional columns of axes of all angles.
struct MedialLevels {
  /// Finds the columns.
  /// @throws InvalidOption as MedialView().
  explicit MedialLevels(const Complex& complex);

  std::span<const float> vertex_until, edge_from, edge_until, triangle_until;
};

/// Returns the message for a missing column of medial_columns. The message contains the name of the column, and the
/// file formats that store this column.
/// @param kind  "vertices", "edges" or "triangles".
[[nodiscard]] std::string missing_medial_column(std::string_view kind, std::string_view name);

/// Adds the columns of MedialView that a complex lacks. The added radii, footprints and angles are 0, and the added
/// sites are unknown. If the column of sheets was missing, all triangles belong to one sheet. If roles were missing,
/// vertices have the role sheet, and edges the role curve.
void add_missing_medial_columns(Complex& complex);

/// Axis with all columns of MedialView. Functions use this class if they accept axes with missing columns, and do not
/// need these columns. If no column is missing, get() returns the complex itself. Otherwise, get() returns a copy to
/// which add_missing_medial_columns() has added the columns. The object is valid while the complex exists.
class CompleteAxis {
 public:
  explicit CompleteAxis(const Complex& axis);
  [[nodiscard]] const Complex& get() const { return copy_ ? *copy_ : axis_; }
  [[nodiscard]] bool is_copy() const { return copy_.has_value(); }

 private:
  const Complex& axis_;
  std::optional<Complex> copy_;
};

/// Returns the first reason why a complex is not a medial axis in one sentence, or an empty string if it is one.
///
/// The complex must have no problem of problem_of(), at most 2^31 - 1 vertices, and all columns of MedialView. All
/// numbers must be finite, radii 0 or more, and sites -1 or more. Roles must be values of MedialRole, for edges curve,
/// rim or seam. Sheet numbers must be 0 or more, and less than the number of triangles.
[[nodiscard]] std::string problem_of_medial(const Complex& axis);
/// Returns one sentence about the first problem of axes of all angles, or an empty string if they are valid. The
/// complex must meet the conditions of problem_of_medial(), and have the columns of MedialLevels. The numbers in these
/// columns may be infinite, but not NaN.
[[nodiscard]] std::string problem_of_nested(const Complex& axes);

/// Returns one more than the largest sheet number; 0 if there are no triangles.
/// @throws InvalidOption if the column `sheet` is missing.
[[nodiscard]] std::size_t sheet_count(const Complex& axis);

/// Numbers of vertices, triangles, sheets, edges and junctions of a medial axis.
struct MedialCounts {
  std::size_t vertices = 0, triangles = 0, sheets = 0;
  std::size_t curve_edges = 0, rim_edges = 0, seam_edges = 0, junctions = 0;
};

template <>
struct Description<MedialCounts> {
  static constexpr std::string_view name = "MedialCounts";
  static constexpr std::string_view doc = "Numbers of the parts of a medial axis";
  static constexpr std::tuple members{
      Member{"vertices", &MedialCounts::vertices, "", "points of the axis"},
      Member{"triangles", &MedialCounts::triangles, "", "triangles of its sheets"},
      Member{"sheets", &MedialCounts::sheets, "", "parts of the surface that are connected without crossing a seam"},
      Member{"curve_edges", &MedialCounts::curve_edges, "", "edges without triangles"},
      Member{"rim_edges", &MedialCounts::rim_edges, "", "edges of exactly one triangle"},
      Member{"seam_edges", &MedialCounts::seam_edges, "", "edges of three or more triangles"},
      Member{"junctions", &MedialCounts::junctions, "", "vertices where seams or curves meet"},
  };
};
/// Counts the vertices, triangles, sheets, edges and junctions of a medial axis.
/// @throws InvalidOption as MedialView().
[[nodiscard]] MedialCounts count(const Complex& axis);

}  // namespace blum
