// Blum: sheets, seams, curves and junctions of medial axes as a graph. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/surface_shape.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct AxisGraphOptions {
  /// Degrees. Faces of the mesh form one patch if they are connected through edges that bend by at most this angle.
  /// Used only if a mesh is given.
  double patch_angle = 30;
  /// Threshold of the separation angle (theta) at which the axis was made, degrees. Triangles and edges with at most
  /// this separation angle are treated as existing for homotopy alone: only to preserve the homotopy type. Leave the
  /// threshold unset if angles are unknown. If the threshold is unset, no triangle or edge is treated as existing for
  /// homotopy alone.
  std::optional<double> homotopy_angle = {};
  /// If true, each sheet of the graph lies between one pair of patches. Sheets are numbered as in the column
  /// `patch_sheet` of label_patch_sheets(). Triangles with the same patch on both sides are left out.
  bool of_patches = false;
  /// Mesh units. If set, each patch of the mesh is a part of a plane, sphere, cylinder or cone. The vertices of a patch
  /// are at most this far from its shape. Edges inside a patch bend by at most `patch_angle`. Used only if a mesh is
  /// given.
  std::optional<double> patch_fit = {};
};

template <>
struct Description<AxisGraphOptions> {
  static constexpr std::string_view name = "AxisGraphOptions";
  static constexpr std::string_view doc = "Options of the graph of a medial axis";
  static constexpr std::tuple members{
      Member{"patch_angle", &AxisGraphOptions::patch_angle, "degrees",
             "if the mesh is given: largest bend at an edge between two faces of one patch", Range::between(0, 180)},
      Member{"homotopy_angle", &AxisGraphOptions::homotopy_angle, "degrees",
             "threshold theta of the axis: triangles and edges with at most this angle are treated as existing for "
             "homotopy alone",
             Range::between(0, 180)},
      Member{"of_patches", &AxisGraphOptions::of_patches, "",
             "true for sheets of pairs of patches, numbered as in the column patch_sheet of an axis with patches"},
      Member{"patch_fit", &AxisGraphOptions::patch_fit, "mesh units",
             "if the mesh is given: largest distance of vertices from the plane, sphere, cylinder or cone of their "
             "patch; default: no shapes are fitted",
             Range::positive()},
  };
};

/// Distribution of a number over a sheet, seam or curve of an axis. The number is at most `low` on 5 % of the area or
/// length, and at most `median` on half of it. A single vertex can determine the minimum or the maximum, but hardly
/// affects `low` and `median`.
struct AxisSpread {
  double minimum = 0, low = 0, median = 0, maximum = 0;
};

template <>
struct Description<AxisSpread> {
  static constexpr std::string_view name = "AxisSpread";
  static constexpr std::string_view doc = "Minimum, low value, median and maximum of a number over a part of an axis";
  static constexpr std::tuple members{
      Member{"minimum", &AxisSpread::minimum, "", "minimum over the vertices of the part"},
      Member{"low", &AxisSpread::low, "", "value that is not exceeded on 5 % of the area or length of the part"},
      Member{"median", &AxisSpread::median, "", "value that is not exceeded on half of the area or length of the part"},
      Member{"maximum", &AxisSpread::maximum, "", "maximum over the vertices of the part"},
  };
};

/// Kind of an AxisJunction, by the seams, curves and sheets at its vertex.
enum class JunctionKind : std::uint8_t {
  junction,    ///< Seams or curves meet at the vertex, or no other kind of this list applies.
  seam_end,    ///< One seam ends at the vertex, and no other seam or curve meets the vertex.
  curve_end,   ///< Free end of a curve.
  curve_foot,  ///< One curve ends at the vertex, on a sheet.
  contact,     ///< Sheets touch at the vertex, or along an edge that is not a seam. No seam or curve meets the vertex.
  point,       ///< Vertex without edges and triangles: the whole axis of a body.
};

template <>
struct Description<JunctionKind> {
  static constexpr std::string_view name = "JunctionKind";
  static constexpr std::array values{
      NamedValue{JunctionKind::junction, "junction"},   NamedValue{JunctionKind::seam_end, "seam_end"},
      NamedValue{JunctionKind::curve_end, "curve_end"}, NamedValue{JunctionKind::curve_foot, "curve_foot"},
      NamedValue{JunctionKind::contact, "contact"},     NamedValue{JunctionKind::point, "point"},
  };
};

/// Vertex that does not lie in the interior of exactly one sheet, rim, seam or curve. Every seam or curve that is not
/// closed begins and ends at a junction.
struct AxisJunction {
  std::uint32_t vertex = 0;  ///< Index of the vertex in the axis.
  JunctionKind kind = JunctionKind::junction;
  Vec3d position;
  double radius = 0;
  /// Seams that begin or end at the vertex, ascending; a seam that begins and ends there is listed twice.
  std::vector<std::uint32_t> seams;
  std::vector<std::uint32_t> curves;  ///< Curves that begin or end at the vertex, listed like `seams`.
  std::vector<std::uint32_t> sheets;  ///< Numbers (AxisSheet::sheet) of the sheets that contain the vertex, ascending.
};

template <>
struct Description<AxisJunction> {
  static constexpr std::string_view name = "AxisJunction";
  static constexpr std::string_view doc = "Vertex where seams and curves of an axis begin, end or meet";
  static constexpr std::tuple members{
      Member{"vertex", &AxisJunction::vertex, "", "vertex of the axis"},
      Member{"kind", &AxisJunction::kind, "", "kind, by the seams, curves and sheets at the vertex"},
      Member{"position", &AxisJunction::position, "mesh units", "position of the vertex"},
      Member{"radius", &AxisJunction::radius, "mesh units", "distance to the surface"},
      Member{"seams", &AxisJunction::seams, "",
             "seams that begin or end at the vertex; a seam that begins and ends there is listed twice"},
      Member{"curves", &AxisJunction::curves, "",
             "curves that begin or end at the vertex; a curve that begins and ends there is listed twice"},
      Member{"sheets", &AxisJunction::sheets, "", "sheets that contain the vertex"},
  };
};

/// Seam or curve: a chain of edges from one junction to the next, or a closed loop without junctions.
struct AxisLine {
  double length = 0;
  double homotopy_length = 0;  ///< Length of the line's edges that exist for homotopy alone.
  bool closed = false;  ///< True for a loop without junctions; false for a loop that begins and ends at a junction.
  /// Indices of the first and the last junction of the line; unset if the line is closed.
  std::optional<std::array<std::uint32_t, 2>> junctions;
  AxisSpread radius;
  std::vector<std::uint32_t> sheets;  ///< Numbers of the sheets along a seam, or at the ends of a curve, ascending.
  /// Vertices of the axis, in order. A closed line repeats its first vertex at the end.
  std::vector<std::uint32_t> vertices;
  std::vector<Vec3d> points;       ///< Positions of the vertices.
  std::vector<double> radii;       ///< Radii at the vertices.
  std::vector<double> arc_length;  ///< Length of the line from its first vertex to each vertex.
};

template <>
struct Description<AxisLine> {
  static constexpr std::string_view name = "AxisLine";
  static constexpr std::string_view doc = "Seam or curve of an axis, from junction to junction or closed";
  static constexpr std::tuple members{
      Member{"length", &AxisLine::length, "mesh units", "length of its edges"},
      Member{"homotopy_length", &AxisLine::homotopy_length, "mesh units",
             "length of its edges that exist for homotopy alone"},
      Member{"closed", &AxisLine::closed, "", "true if the line is a loop without a junction"},
      Member{"junctions", &AxisLine::junctions, "",
             "junctions at the two ends of the line; none if the line is closed"},
      Member{"radius", &AxisLine::radius, "mesh units", "distances from the points of the line to the surface"},
      Member{"sheets", &AxisLine::sheets, "",
             "seams: sheets that meet along the seam; curves: sheets at the ends of the curve"},
      Member{"vertices", &AxisLine::vertices, "",
             "vertices of the axis, in order; a closed line repeats its first vertex at the end"},
      Member{"points", &AxisLine::points, "mesh units", "positions of the vertices"},
      Member{"radii", &AxisLine::radii, "mesh units", "radii of the vertices"},
      Member{"arc_length", &AxisLine::arc_length, "mesh units", "arc length from the first vertex to each vertex"},
  };
};

/// Smooth part of the surface of the input mesh. The faces of a patch are connected through edges that have exactly two
/// faces and bend by at most AxisGraphOptions::patch_angle. Faces without area belong to no patch.
struct AxisPatch {
  std::size_t faces = 0;
  double area = 0;
  Vec3d centroid;  ///< Centroid of the area.
  Vec3d normal;    ///< Mean normal over the area, scaled to unit length; 0 if undefined, as for a closed surface.
  std::optional<SurfaceShape> shape = {};  ///< The fitted shape, if `patch_fit` is set.
};

template <>
struct Description<AxisPatch> {
  static constexpr std::string_view name = "AxisPatch";
  static constexpr std::string_view doc = "Smooth part of the input mesh: connected faces whose edges bend little";
  static constexpr std::tuple members{
      Member{"faces", &AxisPatch::faces, "", "triangles of the mesh"},
      Member{"area", &AxisPatch::area, "square mesh units", "area of the faces"},
      Member{"centroid", &AxisPatch::centroid, "mesh units", "centroid of the area"},
      Member{"normal", &AxisPatch::normal, "",
             "unit vector in the direction of the mean normal over the area; 0 if undefined, as for a closed surface"},
      Member{"shape", &AxisPatch::shape, "",
             "plane, sphere, cylinder or cone that fits the faces, if patch_fit is set"},
  };
};

/// Patches on the two sides of a part of a sheet. The patches contain the footprints of the part's vertices. A side has
/// several patches if its footprints lie on an edge or corner between patches, for example on a reflex edge.
struct AxisPatchPair {
  std::vector<std::uint32_t> first, second;  ///< Patches on the first and on the second side, ascending.
  double share = 0;  ///< Share of the sheet's area that lies between the patches of this pair, 0 to 1.
};

template <>
struct Description<AxisPatchPair> {
  static constexpr std::string_view name = "AxisPatchPair";
  static constexpr std::string_view doc =
      "Patches on the two sides of a part of a sheet; a side on an edge or corner has all patches that meet there";
  static constexpr std::tuple members{
      Member{"first", &AxisPatchPair::first, "", "patches with the footprints of one side"},
      Member{"second", &AxisPatchPair::second, "", "patches with the footprints of the other side"},
      Member{"share", &AxisPatchPair::share, "",
             "share of the sheet's area that lies between the patches of this pair, 0 to 1"},
  };
};

/// Sheet of an axis. The border of a sheet is measured after the sheet is cut open along seams. If the sheet lies on
/// both sides of a seam, the border contains the seam twice.
struct AxisSheet {
  std::uint32_t sheet = 0;  ///< Number of the sheet in the column `medial_columns::sheet`.
  std::size_t triangles = 0;
  double area = 0;
  double homotopy_area = 0;   ///< Area of its triangles with angles of at most theta: they exist for homotopy alone.
  bool for_homotopy = false;  ///< True if all its triangles exist for homotopy alone.
  AxisSpread thickness;       ///< Twice the radius of its vertices.
  /// Separation angle of its vertices, degrees. The angle is near 180 between parallel walls.
  AxisSpread separation_angle;
  /// Area of the triangles whose vertices all have separation angles of 150 degrees or more.
  double wall_area = 0;
  AxisSpread wall_thickness;  ///< Twice the radius over the triangles of `wall_area`; zeros if there are none.
  Vec3d centroid;             ///< Centroid of the area.
  double rim_length = 0;      ///< Length of its free border, the rim.
  double seam_length = 0;     ///< Length of its border along seams.
  double crease_length = 0;   ///< Length of its border along edges of two triangles that belong to different sheets.
  std::size_t boundary_loops = 0;
  /// Euler characteristic of the sheet after it is cut along seams: 1 for a disc, 0 for a ring, 2 for a sphere.
  std::int64_t euler_characteristic = 0;
  std::vector<std::uint32_t> seams;  ///< Seams along which the sheet meets other sheets or itself, ascending.
  /// Patches on the two sides of the sheet, by descending share; empty without a mesh.
  std::vector<AxisPatchPair> patch_pairs;
  /// Patches on the two sides: the columns `patch_a` and `patch_b`. Unset if AxisGraphOptions::of_patches is false.
  std::optional<std::array<std::uint32_t, 2>> sides;
};

template <>
struct Description<AxisSheet> {
  static constexpr std::string_view name = "AxisSheet";
  static constexpr std::string_view doc = "Sheet of an axis; for its border, the sheet is cut open along seams";
  static constexpr std::tuple members{
      Member{"sheet", &AxisSheet::sheet, "", "number of the sheet in the axis"},
      Member{"triangles", &AxisSheet::triangles, "", "number of triangles"},
      Member{"area", &AxisSheet::area, "square mesh units", "area of the triangles"},
      Member{"homotopy_area", &AxisSheet::homotopy_area, "square mesh units",
             "area of the triangles that exist for homotopy alone"},
      Member{"for_homotopy", &AxisSheet::for_homotopy, "", "true if all triangles exist for homotopy alone"},
      Member{"thickness", &AxisSheet::thickness, "mesh units", "twice the radius"},
      Member{"separation_angle", &AxisSheet::separation_angle, "degrees",
             "separation angle of the vertices: near 180 between parallel walls"},
      Member{"wall_area", &AxisSheet::wall_area, "square mesh units",
             "area of the triangles with separation angles of 150 degrees or more at all corners, which lie between "
             "walls that face each other"},
      Member{"wall_thickness", &AxisSheet::wall_thickness, "mesh units",
             "twice the radius over the triangles of wall_area; zeros if there are none"},
      Member{"centroid", &AxisSheet::centroid, "mesh units", "centroid of the area"},
      Member{"rim_length", &AxisSheet::rim_length, "mesh units", "length of the border where the sheet ends freely"},
      Member{"seam_length", &AxisSheet::seam_length, "mesh units", "length of the border along seams"},
      Member{"crease_length", &AxisSheet::crease_length, "mesh units",
             "length of the border along edges where the sheet meets exactly one other sheet"},
      Member{"boundary_loops", &AxisSheet::boundary_loops, "",
             "number of closed lines that form the border of the sheet"},
      Member{"euler_characteristic", &AxisSheet::euler_characteristic, "",
             "Euler characteristic of the sheet cut open along seams: 1 for a disc, 0 for a ring, 2 for a sphere"},
      Member{"seams", &AxisSheet::seams, "", "seams along which the sheet meets other sheets or itself"},
      Member{"patch_pairs", &AxisSheet::patch_pairs, "",
             "patches on both sides of the sheet, by descending share; none without the mesh"},
      Member{"sides", &AxisSheet::sides, "",
             "in a graph of patches: the columns patch_a and patch_b of its triangles; otherwise none"},
  };
};

/// Medial axis as a graph of sheets, seams, curves and junctions. The number of a seam, curve, junction or patch is its
/// index in the lists of the graph. The number of a sheet is AxisSheet::sheet, as in the axis.
struct AxisGraph {
  std::vector<AxisSheet> sheets;        ///< Sheets with triangles, by ascending number.
  std::vector<AxisLine> seams;          ///< Lines along edges that belong to three or more triangles.
  std::vector<AxisLine> curves;         ///< Lines along edges without triangles.
  std::vector<AxisJunction> junctions;  ///< Junctions by ascending vertex.
  /// Patches of the mesh, in the order of their first faces; empty without a mesh.
  std::vector<AxisPatch> patches;
  double area = 0;           ///< Area of all triangles.
  double homotopy_area = 0;  ///< Area of the triangles that exist for homotopy alone.
  double seam_length = 0, curve_length = 0, rim_length = 0;
  double homotopy_curve_length = 0;  ///< Length of the curve edges that exist for homotopy alone.
};

template <>
struct Description<AxisGraph> {
  static constexpr std::string_view name = "AxisGraph";
  static constexpr std::string_view doc = "Medial axis as sheets, seams, curves and junctions that meet";
  static constexpr std::tuple members{
      Member{"sheets", &AxisGraph::sheets, "", "sheets, by ascending number"},
      Member{"seams", &AxisGraph::seams, "", "lines where three or more triangles meet"},
      Member{"curves", &AxisGraph::curves, "", "lines of edges that belong to no triangle"},
      Member{"junctions", &AxisGraph::junctions, "", "junctions, by ascending vertex"},
      Member{"patches", &AxisGraph::patches, "", "smooth parts of the mesh; none if no mesh is given"},
      Member{"area", &AxisGraph::area, "square mesh units", "area of all triangles"},
      Member{"homotopy_area", &AxisGraph::homotopy_area, "square mesh units",
             "area of the triangles that exist for homotopy alone"},
      Member{"seam_length", &AxisGraph::seam_length, "mesh units", "length of all seams"},
      Member{"curve_length", &AxisGraph::curve_length, "mesh units", "length of all curves"},
      Member{"rim_length", &AxisGraph::rim_length, "mesh units", "length of all rims"},
      Member{"homotopy_curve_length", &AxisGraph::homotopy_curve_length, "mesh units",
             "length of curves that exist for homotopy alone"},
  };
};

/// Returns the sheets, seams, curves and junctions of a medial axis.
///
/// The number of triangles at an edge decides its kind, as in the column `role`. An edge of a rim has one triangle, an
/// edge of a seam three or more, an edge of a curve none. The column `sheet` decides which triangles form a sheet.
/// Every edge of a seam or a curve belongs to exactly one line. The junctions are all vertices with the role junction,
/// and all ends of lines. A line begins at the junction with the smaller number. Lines are listed in the order of the
/// junctions at which they begin; closed lines come last.
///
/// The separation angle of a triangle or an edge does not depend on theta. The angle is 0 if the triangle or edge
/// exists only to preserve the homotopy type. Triangles and edges with an angle of at most theta
/// (AxisGraphOptions::homotopy_angle) are treated as existing for homotopy alone. MedialCheck::homotopy_share treats
/// triangles in the same way. Some triangles and edges with a small angle were kept only because another triangle or
/// edge prevented their removal.
///
/// In a graph of patches (AxisGraphOptions::of_patches), the column `patch_sheet` decides which triangles form a sheet.
/// Triangles without a sheet in `patch_sheet` are left out, so fewer triangles may meet at an edge.
///
/// @param axis  axis with radii and sheets, for example from MedialAxis::simplify(), prune_sheets() or a file. Missing
/// angles are treated as 0.
/// @return      the same bytes for equal arguments. Sums are computed in double, in the order of triangles and edges.
/// @throws InvalidOption if an angle of the options is out of range, or if radii or sheets are missing. The function
/// also throws InvalidOption if problem_of_medial() reports a problem in the columns that the axis has.
/// @throws Cancelled.
/// Cost: linear except for sorting; about 0.5 s for a million triangles, and 200 bytes per triangle.
[[nodiscard]] AxisGraph axis_graph(const Complex& axis, const AxisGraphOptions& options = {},
                                   const Context& context = {});

/// Returns the graph of a medial axis, including the patches of the mesh. For every sheet, the graph lists the patches
/// that contain the footprints of the sheet's vertices. Vertices are left out if their two footprints coincide, or
/// their sites are not known. So the shares of a sheet (AxisPatchPair::share) may sum to less than 1.
/// @param mesh  mesh from which the axis was made. The sites of the axis are numbered as in SiteTable(mesh).
/// @throws InvalidOption in the cases of axis_graph() without a mesh, and if the axis has a site that the mesh lacks;
/// InvalidMesh.
[[nodiscard]] AxisGraph axis_graph(const Complex& axis, const MeshView& mesh, const AxisGraphOptions& options = {},
                                   const Context& context = {});

}  // namespace blum
