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
  static constexpr std::string_view doc = "What the graph of a medial axis is asked for";
  static constexpr std::tuple members{
      Member{"patch_angle", &AxisGraphOptions::patch_angle, "degrees",
             "with the mesh: patches are faces joined through edges that bend by at most this", Range::between(0, 180)},
      Member{"homotopy_angle", &AxisGraphOptions::homotopy_angle, "degrees",
             "theta of the axis: what carries at most this is there for homotopy alone; none: nothing is",
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
  static constexpr std::string_view doc =
      "The least, a low, the middle and the largest value of a number over a part of an axis";
  static constexpr std::tuple members{
      Member{"minimum", &AxisSpread::minimum, "", "at any of its vertices"},
      Member{"low", &AxisSpread::low, "", "5 % of its area or length has at most this"},
      Member{"median", &AxisSpread::median, "", "half of its area or length has at most this"},
      Member{"maximum", &AxisSpread::maximum, "", "at any of its vertices"},
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
  static constexpr std::string_view doc = "A vertex where seams and curves of an axis begin, end or meet";
  static constexpr std::tuple members{
      Member{"vertex", &AxisJunction::vertex, "", "of the axis"},
      Member{"kind", &AxisJunction::kind, "", "what meets there"},
      Member{"position", &AxisJunction::position, "mesh units", "of the vertex"},
      Member{"radius", &AxisJunction::radius, "mesh units", "distance to the surface"},
      Member{"seams", &AxisJunction::seams, "", "that begin or end there; one that does both is there twice"},
      Member{"curves", &AxisJunction::curves, "", "that begin or end there; one that does both is there twice"},
      Member{"sheets", &AxisJunction::sheets, "", "that it lies on"},
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
  static constexpr std::string_view doc = "A seam or a curve of an axis, from junction to junction or closed";
  static constexpr std::tuple members{
      Member{"length", &AxisLine::length, "mesh units", "of its edges"},
      Member{"homotopy_length", &AxisLine::homotopy_length, "mesh units",
             "of its edges that are there for homotopy alone"},
      Member{"closed", &AxisLine::closed, "", "whether it is a loop without a junction"},
      Member{"junctions", &AxisLine::junctions, "", "where it begins and ends; none of closed ones"},
      Member{"radius", &AxisLine::radius, "mesh units", "distance to the surface along it"},
      Member{"sheets", &AxisLine::sheets, "", "of seams: those that meet along it; of curves: those at its ends"},
      Member{"vertices", &AxisLine::vertices, "", "of the axis, in order; of closed ones the first again at the end"},
      Member{"points", &AxisLine::points, "mesh units", "their positions"},
      Member{"radii", &AxisLine::radii, "mesh units", "their radii"},
      Member{"arc_length", &AxisLine::arc_length, "mesh units", "from the first vertex to each"},
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
  static constexpr std::string_view doc =
      "A smooth part of the input mesh: faces joined through edges that bend little";
  static constexpr std::tuple members{
      Member{"faces", &AxisPatch::faces, "", "triangles of the mesh"},
      Member{"area", &AxisPatch::area, "square mesh units", "of the faces"},
      Member{"centroid", &AxisPatch::centroid, "mesh units", "of the area"},
      Member{"normal", &AxisPatch::normal, "", "of unit length, the mean over the area; 0 where there is none"},
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
      "Two parts of the surface that a sheet lies between; several patches stand for the edge or corner between them";
  static constexpr std::tuple members{
      Member{"first", &AxisPatchPair::first, "", "patches that the footprints of one side lie on"},
      Member{"second", &AxisPatchPair::second, "", "patches that those of the other side lie on"},
      Member{"share", &AxisPatchPair::share, "", "of the sheet's area, 0 to 1"},
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
  double wall_area = 0;         ///< Area of its triangles whose corners all have an angle of 150 degrees or more.
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
  static constexpr std::string_view doc = "A sheet of an axis; its border is that of the surface cut open along seams";
  static constexpr std::tuple members{
      Member{"sheet", &AxisSheet::sheet, "", "its number in the axis"},
      Member{"triangles", &AxisSheet::triangles, "", "that it has"},
      Member{"area", &AxisSheet::area, "square mesh units", "of the triangles"},
      Member{"homotopy_area", &AxisSheet::homotopy_area, "square mesh units",
             "of the triangles that are there for homotopy alone"},
      Member{"for_homotopy", &AxisSheet::for_homotopy, "", "whether all of them are"},
      Member{"thickness", &AxisSheet::thickness, "mesh units", "twice the radius"},
      Member{"separation_angle", &AxisSheet::separation_angle, "degrees",
             "at which its vertices see their footprints: near 180 between parallel walls"},
      Member{"wall_area", &AxisSheet::wall_area, "square mesh units",
             "of the triangles between walls that face each other: at 150 degrees or more"},
      Member{"wall_thickness", &AxisSheet::wall_thickness, "mesh units",
             "twice the radius of these; zeros where there are none"},
      Member{"centroid", &AxisSheet::centroid, "mesh units", "of the area"},
      Member{"rim_length", &AxisSheet::rim_length, "mesh units", "of the border where it ends freely"},
      Member{"seam_length", &AxisSheet::seam_length, "mesh units", "of the border along seams"},
      Member{"crease_length", &AxisSheet::crease_length, "mesh units",
             "of the border along edges where it meets one other sheet"},
      Member{"boundary_loops", &AxisSheet::boundary_loops, "", "closed lines that its border consists of"},
      Member{"euler_characteristic", &AxisSheet::euler_characteristic, "",
             "of the surface cut open: 1 for a disc, 0 for a ring, 2 for a sphere"},
      Member{"seams", &AxisSheet::seams, "", "that it meets others or itself along"},
      Member{"patch_pairs", &AxisSheet::patch_pairs, "",
             "parts of the surface that it lies between, by falling share; none without the mesh"},
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
  static constexpr std::string_view doc = "A medial axis as sheets, seams, curves and junctions that meet";
  static constexpr std::tuple members{
      Member{"sheets", &AxisGraph::sheets, "", "by rising number"},
      Member{"seams", &AxisGraph::seams, "", "where three or more triangles meet"},
      Member{"curves", &AxisGraph::curves, "", "edges of no triangle"},
      Member{"junctions", &AxisGraph::junctions, "", "by rising vertex"},
      Member{"patches", &AxisGraph::patches, "", "smooth parts of the mesh; none without it"},
      Member{"area", &AxisGraph::area, "square mesh units", "of all triangles"},
      Member{"homotopy_area", &AxisGraph::homotopy_area, "square mesh units",
             "of those that are there for homotopy alone"},
      Member{"seam_length", &AxisGraph::seam_length, "mesh units", "of all seams"},
      Member{"curve_length", &AxisGraph::curve_length, "mesh units", "of all curves"},
      Member{"rim_length", &AxisGraph::rim_length, "mesh units", "of all rims"},
      Member{"homotopy_curve_length", &AxisGraph::homotopy_curve_length, "mesh units",
             "of curves that are there for homotopy alone"},
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
