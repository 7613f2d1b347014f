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
  /// With the mesh: faces are of one patch where they are joined through edges that bend by at most this.
  double patch_angle = 30;
  /// What carries at most this angle is there for homotopy alone: theta of the axis, degrees. Without it nothing counts
  /// as such, as where angles are not known.
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

/// How a number is spread. Low value and median are those of shares of area or length, not of vertices: 5 % and half of
/// the sheet (or of the line) have at most this. The low value leaves out single vertices, which the minimum does not.
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

/// What a vertex is where lines of an axis begin, end or meet.
enum class JunctionKind : std::uint8_t {
  junction,    ///< where seams and curves meet
  seam_end,    ///< one seam ends here, and nothing else
  curve_end,   ///< a free end of a curve
  curve_foot,  ///< one curve ends on a sheet
  contact,     ///< no seam, no curve: sheets touch only here, or along an edge that is no seam
  point,       ///< a vertex alone: all of the axis of a body
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

/// A vertex that seams and curves end at, or at which the axis is more than the middle of a sheet or a line.
struct AxisJunction {
  std::uint32_t vertex = 0;  ///< of the axis
  JunctionKind kind = JunctionKind::junction;
  Vec3d position;
  double radius = 0;
  std::vector<std::uint32_t> seams;   ///< that begin or end here, rising; one that does both is there twice
  std::vector<std::uint32_t> curves;  ///< likewise
  std::vector<std::uint32_t> sheets;  ///< AxisSheet::sheet of those that it lies on, rising
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

/// A seam or a curve: a longest chain of edges between junctions, or a closed loop without any.
struct AxisLine {
  double length = 0;
  double homotopy_length = 0;  ///< of its edges that are there for homotopy alone
  bool closed = false;         ///< a loop without a junction; one with a junction begins and ends there
  std::optional<std::array<std::uint32_t, 2>> junctions;  ///< where it begins and ends; none for closed ones
  AxisSpread radius;
  std::vector<std::uint32_t> sheets;    ///< AxisSheet::sheet, rising: seams: that meet along it; curves: at its ends
  std::vector<std::uint32_t> vertices;  ///< of the axis, in order; of closed ones the first again at the end
  std::vector<Vec3d> points;            ///< their positions
  std::vector<double> radii;            ///< their radii
  std::vector<double> arc_length;       ///< from the first vertex to each
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

/// A smooth part of the input mesh's surface: faces joined through edges of two faces that bend by at most
/// AxisGraphOptions::patch_angle. Faces without area are of no patch.
struct AxisPatch {
  std::size_t faces = 0;
  double area = 0;
  Vec3d centroid;  ///< of the area
  Vec3d normal;    ///< of unit length, the mean over the area; 0 where it has none, as of a closed surface
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

/// Two parts of the surface that a sheet lies between. A side is one patch, or several where the footprints lie on an
/// edge or a corner where these meet: a reflex edge governs as itself.
struct AxisPatchPair {
  std::vector<std::uint32_t> first, second;  ///< patches, rising
  double share = 0;                          ///< of the sheet's area, 0 to 1
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

/// A sheet. Its border is that of the surface cut open along seams, so that the two sides of a seam which both are this
/// sheet's count twice.
struct AxisSheet {
  std::uint32_t sheet = 0;  ///< its number in medial_columns::sheet
  std::size_t triangles = 0;
  double area = 0;
  double homotopy_area = 0;     ///< of its triangles that are there for homotopy alone: angles of theta or less
  bool for_homotopy = false;    ///< all of them are
  AxisSpread thickness;         ///< twice the radius
  AxisSpread separation_angle;  ///< degrees, of vertices: near 180 between parallel walls
  double wall_area = 0;         ///< of its triangles whose corners all see their footprints at 150 degrees or more
  AxisSpread wall_thickness;    ///< of these: twice the radius; zeros where there are none
  Vec3d centroid;               ///< of the area
  double rim_length = 0;        ///< where it ends freely
  double seam_length = 0;       ///< of the border along seams
  double crease_length = 0;     ///< of the border along edges where it meets one other sheet
  std::size_t boundary_loops = 0;
  std::int64_t euler_characteristic = 0;   ///< of the surface cut open: 1 for a disc, 0 for a ring, 2 for a sphere
  std::vector<std::uint32_t> seams;        ///< that it meets others (or itself) along, rising
  std::vector<AxisPatchPair> patch_pairs;  ///< that it lies between, by falling share; none without the mesh
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

/// A medial axis as parts that meet. Numbers of seams, curves, junctions and patches are places in these lists; sheets
/// have the numbers of the axis.
struct AxisGraph {
  std::vector<AxisSheet> sheets;        ///< that have triangles, by rising number
  std::vector<AxisLine> seams;          ///< edges of three or more triangles
  std::vector<AxisLine> curves;         ///< edges of no triangle
  std::vector<AxisJunction> junctions;  ///< by rising vertex
  std::vector<AxisPatch> patches;       ///< of the mesh, by their first face; none without it
  double area = 0;                      ///< of all triangles
  double homotopy_area = 0;             ///< of those that are there for homotopy alone
  double seam_length = 0, curve_length = 0, rim_length = 0;
  double homotopy_curve_length = 0;  ///< of curves, what is there for homotopy alone
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

/// The sheets, seams, curves and junctions of a medial axis.
///
/// What is a rim (an edge of one triangle), a seam (three or more) and a curve (none) is told by the triangles, as in
/// the column `role`; sheets by their column. Every edge of a seam or a curve is in exactly one line, every vertex of
/// the role junction is one of the junctions, which hold ends of lines besides. Lines run from the junction of the
/// smaller number, are in the order of where they begin, and closed ones come last.
///
/// Triangles and edges carry the angle for which they are there, whatever theta is, and 0 where only homotopy keeps
/// them. So what carries theta or less is there for homotopy alone, as MedialCheck::homotopy_share counts it; or since
/// something else kept it from being taken away.
///
/// @param axis  with radii and sheets: MedialAxis::simplify(), prune_sheets(), a file. Angles may be missing, and are
/// 0.
/// @return      sums are taken in double, in the order of triangles and edges; the same bytes every time.
/// @throws InvalidOption for an angle, where radii or sheets are missing, or saying problem_of_medial() of what there
/// is; Cancelled. Cost: linear but for sorting; about 0.5 s for a million triangles, and 200 bytes for each.
[[nodiscard]] AxisGraph axis_graph(const Complex& axis, const AxisGraphOptions& options = {},
                                   const Context& context = {});

/// The same with the patches of the mesh, and for every sheet those that it lies between: where the footprints of its
/// vertices lie. Vertices whose two footprints are one point, or of which no sites are known, say nothing of it, so
/// that shares may sum to less than 1.
/// @param mesh  that the axis was made of: sites are those of SiteTable(mesh).
/// @throws InvalidOption also for a site that the mesh does not have; InvalidMesh.
[[nodiscard]] AxisGraph axis_graph(const Complex& axis, const MeshView& mesh, const AxisGraphOptions& options = {},
                                   const Context& context = {});

}  // namespace blum
