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

/// Where a vertex or edge of a medial axis lies; columns hold these numbers.
enum class MedialRole : std::uint8_t {
  sheet,     ///< inside a sheet: all around it is surface
  rim,       ///< on the free border of a sheet
  seam,      ///< where three or more triangles meet
  curve,     ///< on no triangle
  junction,  ///< a vertex where seams or curves begin, end or meet, or sheets touch
};

template <>
struct Description<MedialRole> {
  static constexpr std::string_view name = "MedialRole";
  static constexpr std::array values{NamedValue{MedialRole::sheet, "sheet"}, NamedValue{MedialRole::rim, "rim"},
                                     NamedValue{MedialRole::seam, "seam"}, NamedValue{MedialRole::curve, "curve"},
                                     NamedValue{MedialRole::junction, "junction"}};
};

/// A medial axis is a complex with these columns, here by name. Vertices are centres of balls that the solid holds.
/// Edges are curves, rims and seams: the inner edges of sheets are not listed.
/// Names of vertex columns begin with none of vertex_, edge_ and triangle_, by which .npz files tell kinds apart.
namespace medial_columns {

/// Vertices, float64: exact distance to the surface, mesh units.
inline constexpr std::string_view radius = "radius";
/// Vertices, 3 x float64: the closest point of the surface, and that of the other wall; the same point twice where only
/// one wall is near.
inline constexpr std::array<std::string_view, 2> footprints{"footprint_0", "footprint_1"};
/// Vertices, int32: of the input mesh, or voxels of the input image, that the footprints lie on; -1 where not known.
inline constexpr std::array<std::string_view, 2> sites{"site_0", "site_1"};
/// Vertices, float64: between the footprints as the position sees them, degrees. Edges and triangles, float32: degrees;
/// 0 where only homotopy keeps them.
inline constexpr std::string_view separation_angle = "separation_angle";
/// Vertices and edges, int32: MedialRole; of edges rim, seam or curve.
inline constexpr std::string_view role = "role";
/// Triangles, int32, from 0. Sheets are the triangles joined through edges that exactly two triangles share; next to a
/// seam, not through edges where these are 37 degrees from flat, or more. Of an axis of a mesh they are numbered by the
/// faces that they lie between (see medial_axis()), of an image by their first triangle.
inline constexpr std::string_view sheet = "sheet";

/// Axes of all angles have these besides (MedialAxis::nested). Vertices, edges and triangles, float32, degrees: they
/// are there where theta is less; infinite for always.
inline constexpr std::string_view until = "until";
/// Edges, float32, degrees: an edge has its role where from <= theta < until. One that is a seam first, then a rim and
/// at last a curve is listed three times.
inline constexpr std::string_view from = "from";

}  // namespace medial_columns

/// The columns of a medial axis to read from. Lives no longer than the complex, and only while that stays as it is.
struct MedialView {
  /// @throws InvalidOption where a column is missing, of another type, or of another count of rows.
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

/// The columns besides of axes of all angles.
struct MedialLevels {
  /// @throws InvalidOption as MedialView().
  explicit MedialLevels(const Complex& complex);

  std::span<const float> vertex_until, edge_from, edge_until, triangle_until;
};

/// What to tell where a column of medial_columns is needed and missing: its name, and which files hold it.
/// @param kind  "vertices", "edges" or "triangles".
[[nodiscard]] std::string missing_medial_column(std::string_view kind, std::string_view name);

/// Adds what MedialView needs and a complex lacks: radii, footprints and angles of 0, no sites, one sheet; vertices
/// of the role sheet and edges of the role curve.
void add_missing_medial_columns(Complex& complex);

/// An axis with all columns of MedialView, for what needs not look at those that it lacks: the complex itself where it
/// has them, else a copy after add_missing_medial_columns(). Lives no longer than the complex.
class CompleteAxis {
 public:
  explicit CompleteAxis(const Complex& axis);
  [[nodiscard]] const Complex& get() const { return copy_ ? *copy_ : axis_; }
  [[nodiscard]] bool is_copy() const { return copy_.has_value(); }

 private:
  const Complex& axis_;
  std::optional<Complex> copy_;
};

/// What is wrong with a complex as a medial axis, in one sentence; empty where nothing is: it is a complex
/// (problem_of), all columns of MedialView are there; numbers are finite, no radius is negative, sites are -1 or more,
/// roles are those of MedialRole (of edges curve, rim or seam), and sheets are numbered from 0 and no more than there
/// are triangles.
[[nodiscard]] std::string problem_of_medial(const Complex& axis);
/// The same of axes of all angles, which have the columns of MedialLevels, too: numbers, that may be infinite.
[[nodiscard]] std::string problem_of_nested(const Complex& axes);

/// One more than the largest sheet; 0 without triangles. @throws InvalidOption where there is no such column.
[[nodiscard]] std::size_t sheet_count(const Complex& axis);

/// How many of each there are.
struct MedialCounts {
  std::size_t vertices = 0, triangles = 0, sheets = 0;
  std::size_t curve_edges = 0, rim_edges = 0, seam_edges = 0, junctions = 0;
};

template <>
struct Description<MedialCounts> {
  static constexpr std::string_view name = "MedialCounts";
  static constexpr std::string_view doc = "How many of each a medial axis has";
  static constexpr std::tuple members{
      Member{"vertices", &MedialCounts::vertices, "", "points of the axis"},
      Member{"triangles", &MedialCounts::triangles, "", "of its sheets"},
      Member{"sheets", &MedialCounts::sheets, "", "connected parts without seams"},
      Member{"curve_edges", &MedialCounts::curve_edges, "", "edges of no triangle"},
      Member{"rim_edges", &MedialCounts::rim_edges, "", "edges of one triangle"},
      Member{"seam_edges", &MedialCounts::seam_edges, "", "edges where sheets meet"},
      Member{"junctions", &MedialCounts::junctions, "", "vertices where seams or curves meet"},
  };
};
/// @throws InvalidOption as MedialView().
[[nodiscard]] MedialCounts count(const Complex& axis);

}  // namespace blum
