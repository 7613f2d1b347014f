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
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct AxisGraphOptions {
  /// With the mesh: faces form one patch if they are joined through edges that bend by at most this angle, degrees.
  double patch_angle = 30;
  /// Theta of the axis, degrees. Cells with at most this angle exist for homotopy alone. If unset, no cell counts as
  /// such, for example because angles are not known.
  std::optional<double> homotopy_angle = {};
};

template <>
struct Description<AxisGraphOptions> {
  static constexpr std::string_view name = "AxisGraphOptions";
  static constexpr std::string_view doc = "Options of the graph of a medial axis";
  static constexpr std::tuple members{
      Member{"patch_angle", &AxisGraphOptions::patch_angle, "degrees",
             "with the mesh: largest bend of the edges that join faces to a patch", Range::between(0, 180)},
      Member{"homotopy_angle", &AxisGraphOptions::homotopy_angle, "degrees",
             "theta of the axis: cells with at most this angle exist for homotopy alone; unset: none do",
             Range::between(0, 180)},
  };
};

/// Distribution of a number over a part of an axis. By area or length, 5 % of the part has at most the low value, and
/// half has at most the median. Single vertices affect the minimum and the maximum, but not these two.
struct AxisSpread {
  double minimum = 0, low = 0, median = 0, maximum = 0;
};

template <>
struct Description<AxisSpread> {
  static constexpr std::string_view name = "AxisSpread";
  static constexpr std::string_view doc = "Minimum, low value, median and maximum of a number over a part of an axis";
  static constexpr std::tuple members{
      Member{"minimum", &AxisSpread::minimum, "", "minimum over its vertices"},
      Member{"low", &AxisSpread::low, "", "value that 5 % of its area or length do not exceed"},
      Member{"median", &AxisSpread::median, "", "value that half of its area or length do not exceed"},
      Member{"maximum", &AxisSpread::maximum, "", "maximum over its vertices"},
  };
};

/// Kind of a vertex at which lines of an axis begin, end or meet.
enum class JunctionKind : std::uint8_t {
  junction,    ///< Seams or curves meet here.
  seam_end,    ///< One seam ends here, and nothing else.
  curve_end,   ///< Free end of a curve.
  curve_foot,  ///< One curve ends on a sheet.
  contact,     ///< No seam or curve: sheets touch only here, or along an edge that is not a seam.
  point,       ///< Single vertex: the whole axis of a body.
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

/// Vertex at which seams or curves end, or whose surroundings are not just the middle of one sheet, rim, seam or curve.
struct AxisJunction {
  std::uint32_t vertex = 0;  ///< Number in the axis.
  JunctionKind kind = JunctionKind::junction;
  Vec3d position;
  double radius = 0;
  std::vector<std::uint32_t> seams;   ///< Seams that begin or end here, ascending; twice if they do both.
  std::vector<std::uint32_t> curves;  ///< Curves that begin or end here, likewise.
  std::vector<std::uint32_t> sheets;  ///< AxisSheet::sheet of the sheets that contain the vertex, ascending.
};

template <>
struct Description<AxisJunction> {
  static constexpr std::string_view name = "AxisJunction";
  static constexpr std::string_view doc = "Vertex where seams and curves of an axis begin, end or meet";
  static constexpr std::tuple members{
      Member{"vertex", &AxisJunction::vertex, "", "vertex of the axis"},
      Member{"kind", &AxisJunction::kind, "", "kind of the parts that meet there"},
      Member{"position", &AxisJunction::position, "mesh units", "position of the vertex"},
      Member{"radius", &AxisJunction::radius, "mesh units", "distance to the surface"},
      Member{"seams", &AxisJunction::seams, "", "seams that begin or end there; a seam that does both is listed twice"},
      Member{"curves", &AxisJunction::curves, "",
             "curves that begin or end there; a curve that does both is listed twice"},
      Member{"sheets", &AxisJunction::sheets, "", "sheets that contain it"},
  };
};

/// Seam or curve: a longest chain of edges between junctions, or a closed loop without junctions.
struct AxisLine {
  double length = 0;
  double homotopy_length = 0;  ///< Length of its edges that exist for homotopy alone.
  bool closed = false;         ///< True for a loop without a junction. A loop with one begins and ends there.
  std::optional<std::array<std::uint32_t, 2>> junctions;  ///< Its first and last junction; none for closed lines.
  AxisSpread radius;
  std::vector<std::uint32_t> sheets;    ///< AxisSheet::sheet, ascending. Seams: along it. Curves: at its ends.
  std::vector<std::uint32_t> vertices;  ///< Vertices of the axis, in order. Closed lines end with the first one.
  std::vector<Vec3d> points;            ///< Positions of the vertices.
  std::vector<double> radii;            ///< Radii at the vertices.
  std::vector<double> arc_length;       ///< Length from the first vertex to each.
};

template <>
struct Description<AxisLine> {
  static constexpr std::string_view name = "AxisLine";
  static constexpr std::string_view doc = "Seam or curve of an axis, from junction to junction or closed";
  static constexpr std::tuple members{
      Member{"length", &AxisLine::length, "mesh units", "length of its edges"},
      Member{"homotopy_length", &AxisLine::homotopy_length, "mesh units",
             "length of its edges that exist for homotopy alone"},
      Member{"closed", &AxisLine::closed, "", "true if it is a loop without a junction"},
      Member{"junctions", &AxisLine::junctions, "", "junctions at its two ends; none if closed"},
      Member{"radius", &AxisLine::radius, "mesh units", "distance to the surface along it"},
      Member{"sheets", &AxisLine::sheets, "", "seams: sheets that meet along it; curves: sheets at its ends"},
      Member{"vertices", &AxisLine::vertices, "",
             "vertices of the axis, in order; if closed, the first one again at the end"},
      Member{"points", &AxisLine::points, "mesh units", "positions of the vertices"},
      Member{"radii", &AxisLine::radii, "mesh units", "radii of the vertices"},
      Member{"arc_length", &AxisLine::arc_length, "mesh units", "arc length from the first vertex to each vertex"},
  };
};

/// Smooth part of the input mesh's surface: faces joined through edges of two faces that bend by at most
/// AxisGraphOptions::patch_angle. Faces without area belong to no patch.
struct AxisPatch {
  std::size_t faces = 0;
  double area = 0;
  Vec3d centroid;  ///< Centroid of the area.
  Vec3d normal;    ///< Mean over the area, of unit length; 0 if undefined, for example for a closed surface.
};

template <>
struct Description<AxisPatch> {
  static constexpr std::string_view name = "AxisPatch";
  static constexpr std::string_view doc = "Smooth part of the input mesh: faces joined through edges that bend little";
  static constexpr std::tuple members{
      Member{"faces", &AxisPatch::faces, "", "triangles of the mesh"},
      Member{"area", &AxisPatch::area, "square mesh units", "area of the faces"},
      Member{"centroid", &AxisPatch::centroid, "mesh units", "centroid of the area"},
      Member{"normal", &AxisPatch::normal, "", "unit vector, mean normal over the area; 0 if there is none"},
  };
};

/// Two parts of the surface on either side of a sheet. A side is one patch, or several if the footprints lie on an edge
/// or corner between them, for example on a reflex edge.
struct AxisPatchPair {
  std::vector<std::uint32_t> first, second;  ///< Patches, ascending.
  double share = 0;                          ///< Share of the sheet's area, 0 to 1.
};

template <>
struct Description<AxisPatchPair> {
  static constexpr std::string_view name = "AxisPatchPair";
  static constexpr std::string_view doc =
      "Two parts of the surface on both sides of a sheet; several patches stand for the edge or corner between them";
  static constexpr std::tuple members{
      Member{"first", &AxisPatchPair::first, "", "patches with the footprints of one side"},
      Member{"second", &AxisPatchPair::second, "", "patches with the footprints of the other side"},
      Member{"share", &AxisPatchPair::share, "", "share of the sheet's area, 0 to 1"},
  };
};

/// Sheet of an axis. Its border is that of the surface cut open along seams. If both sides of a seam belong to this
/// sheet, the seam counts twice.
struct AxisSheet {
  std::uint32_t sheet = 0;  ///< Its number in `medial_columns::sheet`.
  std::size_t triangles = 0;
  double area = 0;
  double homotopy_area = 0;     ///< Area of its triangles that exist for homotopy alone: angles of at most theta.
  bool for_homotopy = false;    ///< True if all its triangles exist for homotopy alone.
  AxisSpread thickness;         ///< Twice the radius.
  AxisSpread separation_angle;  ///< Degrees, of its vertices. Near 180 between parallel walls.
  double wall_area = 0;         ///< Area of triangles whose vertices have separation angles of 150 degrees or more.
  AxisSpread wall_thickness;    ///< Twice the radius over these triangles; zeros if none exist.
  Vec3d centroid;               ///< Centroid of the area.
  double rim_length = 0;        ///< Length of its free border.
  double seam_length = 0;       ///< Length of its border along seams.
  double crease_length = 0;     ///< Length of its border along edges where it meets one other sheet.
  std::size_t boundary_loops = 0;
  std::int64_t euler_characteristic = 0;   ///< For the surface cut open. A disc has 1, a ring 0, a sphere 2.
  std::vector<std::uint32_t> seams;        ///< Seams along which it meets other sheets or itself, ascending.
  std::vector<AxisPatchPair> patch_pairs;  ///< Patches on its two sides, by descending share; none without the mesh.
};

template <>
struct Description<AxisSheet> {
  static constexpr std::string_view name = "AxisSheet";
  static constexpr std::string_view doc = "Sheet of an axis; its border is that of the surface cut open along seams";
  static constexpr std::tuple members{
      Member{"sheet", &AxisSheet::sheet, "", "number of the sheet in the axis"},
      Member{"triangles", &AxisSheet::triangles, "", "number of triangles"},
      Member{"area", &AxisSheet::area, "square mesh units", "area of the triangles"},
      Member{"homotopy_area", &AxisSheet::homotopy_area, "square mesh units",
             "area of the triangles that exist for homotopy alone"},
      Member{"for_homotopy", &AxisSheet::for_homotopy, "", "true if all triangles exist for homotopy alone"},
      Member{"thickness", &AxisSheet::thickness, "mesh units", "twice the radius"},
      Member{"separation_angle", &AxisSheet::separation_angle, "degrees",
             "separation angle of its vertices: near 180 between parallel walls"},
      Member{"wall_area", &AxisSheet::wall_area, "square mesh units",
             "area of the triangles between walls that face each other: at 150 degrees or more"},
      Member{"wall_thickness", &AxisSheet::wall_thickness, "mesh units",
             "twice the radius of these triangles; zeros if there are none"},
      Member{"centroid", &AxisSheet::centroid, "mesh units", "centroid of the area"},
      Member{"rim_length", &AxisSheet::rim_length, "mesh units", "length of the border where the sheet ends freely"},
      Member{"seam_length", &AxisSheet::seam_length, "mesh units", "length of the border along seams"},
      Member{"crease_length", &AxisSheet::crease_length, "mesh units",
             "length of the border along edges where it meets one other sheet"},
      Member{"boundary_loops", &AxisSheet::boundary_loops, "", "number of closed lines that form its border"},
      Member{"euler_characteristic", &AxisSheet::euler_characteristic, "",
             "Euler characteristic of the surface cut open: 1 for a disc, 0 for a ring, 2 for a sphere"},
      Member{"seams", &AxisSheet::seams, "", "seams along which it meets others or itself"},
      Member{"patch_pairs", &AxisSheet::patch_pairs, "",
             "parts of the surface on both sides, by falling share; none without the mesh"},
  };
};

/// Medial axis as a graph of parts that meet. Numbers of seams, curves, junctions and patches are indices into these
/// lists. Sheets have the numbers of the axis.
struct AxisGraph {
  std::vector<AxisSheet> sheets;        ///< Sheets with triangles, by ascending number.
  std::vector<AxisLine> seams;          ///< Lines along edges of three or more triangles.
  std::vector<AxisLine> curves;         ///< Lines along edges of no triangle.
  std::vector<AxisJunction> junctions;  ///< By ascending vertex.
  std::vector<AxisPatch> patches;       ///< Patches of the mesh, by their first face; none without the mesh.
  double area = 0;                      ///< Area of all triangles.
  double homotopy_area = 0;             ///< Area of the triangles that exist for homotopy alone.
  double seam_length = 0, curve_length = 0, rim_length = 0;
  double homotopy_curve_length = 0;  ///< Length of curves that exist for homotopy alone.
};

template <>
struct Description<AxisGraph> {
  static constexpr std::string_view name = "AxisGraph";
  static constexpr std::string_view doc = "Medial axis as sheets, seams, curves and junctions that meet";
  static constexpr std::tuple members{
      Member{"sheets", &AxisGraph::sheets, "", "sheets by rising number"},
      Member{"seams", &AxisGraph::seams, "", "lines where three or more triangles meet"},
      Member{"curves", &AxisGraph::curves, "", "lines of edges without triangles"},
      Member{"junctions", &AxisGraph::junctions, "", "junctions by rising vertex"},
      Member{"patches", &AxisGraph::patches, "", "smooth parts of the mesh; none without it"},
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
/// The triangles decide the kind of an edge, as in the column `role`. A rim has one triangle, a seam three or more, a
/// curve none. The column `sheet` decides the sheets. Every edge of a seam or a curve belongs to exactly one line. The
/// junctions are all vertices with the role junction, and the ends of lines. Lines begin at the junction with the
/// smaller number and are listed in the order of their beginnings; closed lines come last.
///
/// The angle of a triangle or an edge does not depend on theta; it is 0 if only homotopy keeps the cell. Cells with
/// theta or less exist for homotopy alone, as MedialCheck::homotopy_share counts them. Some of them exist because
/// another cell prevented their removal.
///
/// @param axis  with radii and sheets, for example from MedialAxis::simplify(), prune_sheets() or a file. Missing
///              angles count as 0.
/// @return      the same bytes every time. Sums are computed in double, in the order of triangles and edges.
/// @throws InvalidOption if an angle is out of range, radii or sheets are missing, or problem_of_medial() reports a
/// problem in the columns that exist; Cancelled.
/// Cost: linear except for sorting; about 0.5 s for a million triangles, and 200 bytes per triangle.
[[nodiscard]] AxisGraph axis_graph(const Complex& axis, const AxisGraphOptions& options = {},
                                   const Context& context = {});

/// Also returns the patches of the mesh, and for every sheet the patches that contain the footprints of its vertices.
/// Vertices whose two footprints coincide, or whose sites are not known, are left out. So shares may sum to less than
/// 1.
/// @param mesh  mesh that the axis was made from; sites are those of SiteTable(mesh).
/// @throws InvalidOption also if the mesh does not have a site of the axis; InvalidMesh.
[[nodiscard]] AxisGraph axis_graph(const Complex& axis, const MeshView& mesh, const AxisGraphOptions& options = {},
                                   const Context& context = {});

}  // namespace blum
