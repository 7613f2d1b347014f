// Blum: certificates of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/complex/homology.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/solid/solid_rule.hpp"

namespace blum {

/// Result that a certificate proves about the topology of an axis, in ascending order.
enum class Proven : std::uint8_t {
  nothing,            ///< Betti numbers of axis and solid differ, or positions were not checked.
  betti_numbers,      ///< In each body, the axis has as many components, tunnels and voids as the solid.
  homology_modulo_2,  ///< Its inclusion into the solid is an isomorphism of homology with coefficients in Z/2.
  homology,           ///< Its inclusion into the solid is an isomorphism of integer homology.
  homotopy_type       ///< The axis and the solid are homotopy equivalent.
};

template <>
struct Description<Proven> {
  static constexpr std::string_view name = "Proven";
  static constexpr std::array values{
      NamedValue{Proven::nothing, "nothing"}, NamedValue{Proven::betti_numbers, "equal Betti numbers"},
      NamedValue{Proven::homology_modulo_2, "isomorphic homology modulo 2"},
      NamedValue{Proven::homology, "isomorphic homology"}, NamedValue{Proven::homotopy_type, "homotopy equivalent"}};
};

/// Components, tunnels and voids of one body of the solid, and of the parts of the axis in it.
struct BodyCheck {
  BettiNumbers solid{};
  BettiNumbers axis{};
  std::int64_t tunnels_met = 0;  ///< Rank modulo 2 of the linking of the axis's loops with the tunnels.
  std::int64_t voids_met = 0;    ///< Rank modulo 2 of the winding of its closed surfaces around the voids.
  Proven proven = Proven::nothing;
};

template <>
struct Description<BodyCheck> {
  static constexpr std::string_view name = "BodyCheck";
  static constexpr std::string_view doc = "Components, tunnels and voids of one body and of the axis in it";
  static constexpr std::tuple members{
      Member{"solid_betti", &BodyCheck::solid, "", "components, tunnels, voids of the body"},
      Member{"axis_betti", &BodyCheck::axis, "", "components, tunnels, voids of the parts of the axis in it"},
      Member{"tunnels_met", &BodyCheck::tunnels_met, "",
             "rank modulo 2 of the linking of loops of the axis with the tunnels"},
      Member{"voids_met", &BodyCheck::voids_met, "",
             "rank modulo 2 of the winding of closed surfaces of the axis around the voids"},
      Member{"proven", &BodyCheck::proven, "", "proven agreement of its topology"},
  };
};

/// Errors of the vertices of an axis. Distances refer to the shells of the body that contains a vertex, or of the
/// closest body. These are its outer shell and its voids. The tolerance is 1e-6 of the diagonal of that body's box, or
/// twice the rounding of its coordinates if that is more. Against the voxels of a mesh (SolidRule::winding), a vertex
/// up to the diagonal of a voxel away from them is not outside.
struct GeometryCheck {
  std::size_t vertices = 0;          ///< Checked vertices.
  std::size_t not_finite = 0;        ///< Vertices with a coordinate, radius, footprint or angle that is not finite.
  std::size_t outside = 0;           ///< Vertices outside the solid by more than the tolerance.
  double outside_by = 0;             ///< Largest distance of a vertex from the solid, mesh units (SolidRule::winding:
                                     ///< less that diagonal).
  double radius_error = 0;           ///< Largest |radius - exact distance to the surface|, mesh units.
  double footprint_off_surface = 0;  ///< Largest distance of a footprint from the surface, mesh units.
  double footprint_error = 0;        ///< Largest |distance to a footprint - radius|, mesh units.
  double site_error = 0;             ///< Largest distance of a footprint from its named site, mesh units.
  double angle_error = 0;            ///< Largest |separation angle - angle between the footprints|, degrees.
  double tolerance = 0;              ///< Tolerance in the largest body, mesh units.
  bool holds = false;                ///< True if all vertices are finite and inside, and no error exceeds its
                                     ///< tolerance.
};

template <>
struct Description<GeometryCheck> {
  static constexpr std::string_view name = "GeometryCheck";
  static constexpr std::string_view doc = "Errors of the vertices";
  static constexpr std::tuple members{
      Member{"vertices", &GeometryCheck::vertices, "", "checked vertices"},
      Member{"not_finite", &GeometryCheck::not_finite, "",
             "vertices with a coordinate, radius, footprint or angle that is not finite"},
      Member{"outside", &GeometryCheck::outside, "", "vertices outside the solid by more than the tolerance"},
      Member{"outside_by", &GeometryCheck::outside_by, "mesh units", "largest distance of a vertex from the solid"},
      Member{"radius_error", &GeometryCheck::radius_error, "mesh units",
             "largest |radius - exact distance to the surface|"},
      Member{"footprint_off_surface", &GeometryCheck::footprint_off_surface, "mesh units",
             "largest distance of a footprint from the surface"},
      Member{"footprint_error", &GeometryCheck::footprint_error, "mesh units",
             "largest |distance to a footprint - radius|"},
      Member{"site_error", &GeometryCheck::site_error, "mesh units", "largest distance of a footprint from its site"},
      Member{"angle_error", &GeometryCheck::angle_error, "degrees",
             "largest |separation angle - angle between the footprints|"},
      Member{"tolerance", &GeometryCheck::tolerance, "mesh units", "tolerance in the largest body"},
      Member{"holds", &GeometryCheck::holds, "", "true if no vertex is outside, and no error exceeds its tolerance"},
  };
};

/// Result of the check that the edges of an axis, and the sides of its triangles, lie in the solid between their ends.
/// Depths along each edge decide, so no point is left out.
///
/// An edge may cut a corner by at most 1/64 of the diagonal of the body, if it can be pushed into the solid. In images
/// the limit is half the diagonal of a voxel if that is more. To push an edge, its point furthest out is moved through
/// the closest point of the surface. Both parts are then treated in the same way, until all lies in the solid, with at
/// most 64 moves. This fails for an edge across a gap, however narrow. Against the voxels of a mesh, the tolerance
/// includes the diagonal of a voxel, and no edge is pushed.
struct EdgeCheck {
  std::size_t edges = 0;      ///< Checked edges, each counted once.
  std::size_t pushed = 0;     ///< Edges that cut a corner of the body of their ends, and can be pushed into it.
  double pushed_by = 0;       ///< Largest distance of these from the solid, mesh units.
  std::size_t outside = 0;    ///< Edges that leave that body otherwise.
  double outside_by = 0;      ///< Largest distance of these from the body, at least, mesh units.
  Vec3d where;                ///< Place of that distance, mesh units.
  std::size_t across = 0;     ///< Edges that leave the body only within the tolerance, but cross a gap there.
  Vec3d across_at;            ///< Place of the first of these, mesh units.
  std::size_t undecided = 0;  ///< Edges for which a crossing is undecided. Then only Betti numbers are proven.
  double tolerance = 0;       ///< Ten times GeometryCheck::tolerance (SolidRule::winding: plus a voxel's diagonal).
  bool holds = false;         ///< True if no edge is outside or crosses a gap.
};

template <>
struct Description<EdgeCheck> {
  static constexpr std::string_view name = "EdgeCheck";
  static constexpr std::string_view doc = "Check that edges lie in the solid between their ends";
  static constexpr std::tuple members{
      Member{"edges", &EdgeCheck::edges, "", "checked edges, each counted once"},
      Member{"pushed", &EdgeCheck::pushed, "", "edges that cut a corner, and can be pushed into the solid"},
      Member{"pushed_by", &EdgeCheck::pushed_by, "mesh units", "largest distance of these from the solid"},
      Member{"outside", &EdgeCheck::outside, "", "edges that leave the solid otherwise"},
      Member{"outside_by", &EdgeCheck::outside_by, "mesh units", "largest distance of these from the solid, at least"},
      Member{"where", &EdgeCheck::where, "mesh units", "place of that distance"},
      Member{"across", &EdgeCheck::across, "",
             "edges that leave the solid only within the tolerance, but cross a gap there"},
      Member{"across_at", &EdgeCheck::across_at, "mesh units", "place of the first of these"},
      Member{"undecided", &EdgeCheck::undecided, "",
             "edges for which that is undecided; then only Betti numbers are proven"},
      Member{"tolerance", &EdgeCheck::tolerance, "mesh units", "tolerance"},
      Member{"holds", &EdgeCheck::holds, "", "true if no edge is outside or crosses a gap"},
  };
};

/// Result of the check that the inclusion of an axis into its solid is an isomorphism of homology, and not only that
/// numbers agree. It uses Alexander duality. Closed paths along the surface generate the homology of the complement.
/// Their linking numbers with loops of the axis are exact, as are the winding numbers of its closed surfaces around
/// points of each void.
///
/// The check refuses a loop that runs around nothing, or twice around one tunnel and never around another. It also
/// refuses a triangle across a hole. It runs only if all Betti numbers agree, all vertices are finite, and edges lie in
/// the solid. For tunnels and voids of voxels, only the numbers are compared.
struct HomologyCheck {
  std::size_t paths = 0;            ///< Closed paths along the surface with which linking numbers were computed.
  std::size_t triangles = 0;        ///< Triangles of the axis in bodies with tunnels.
  std::size_t across = 0;           ///< Triangles whose border is linked with a path: they span a hole of the solid.
  Vec3d where;                      ///< Place of the first of these, mesh units.
  std::size_t doubtful = 0;         ///< Edges of the axis that touch the surface, so that linking cannot be decided.
  Proven proven = Proven::nothing;  ///< Result that holds in every body.
  bool holds = false;               ///< True if the check ran and refused nothing, proven or not.
  std::string shown;                ///< One sentence: the proven result, and why it is not more.
};

template <>
struct Description<HomologyCheck> {
  static constexpr std::string_view name = "HomologyCheck";
  static constexpr std::string_view doc =
      "Check that the inclusion of the axis into its solid is an isomorphism of homology";
  static constexpr std::tuple members{
      Member{"paths", &HomologyCheck::paths, "", "closed paths along the surface with which loops were linked"},
      Member{"triangles", &HomologyCheck::triangles, "", "triangles of the axis in bodies with tunnels"},
      Member{"across", &HomologyCheck::across, "", "triangles that span a hole of the solid"},
      Member{"where", &HomologyCheck::where, "mesh units", "place of the first of these"},
      Member{"doubtful", &HomologyCheck::doubtful, "", "edges that touch the surface, so that linking is undecided"},
      Member{"proven", &HomologyCheck::proven, "", "result that holds in every body"},
      Member{"holds", &HomologyCheck::holds, "", "true if nothing contradicts it, proven or not"},
      Member{"shown", &HomologyCheck::shown, "", "proven result, and the reason why it is not more, in one sentence"},
  };
};

/// Distances between a solid and the balls of its axis, reported and not judged. The balls are those around the
/// vertices, and between these, with interpolated radii, along longer edges and over larger triangles (see
/// sample_axis()). The step is 1/200 of the diagonal, or the root of a 50,000th of the axis's area if that is more.
struct BallUnionCheck {
  /// Largest distance of the surface of the solid from the union of the balls, over samples of the surface. The corners
  /// of a mesh are among these. The diagonal of the solid if no balls exist.
  double solid_to_balls = 0;
  double mean_solid_to_balls = 0;  ///< Mean of that distance over the area of the surface.
  /// Largest distance by which the balls reach out of the solid, that is, radius - exact distance. The distance is
  /// negative outside the solid. 0 for exact radii.
  double balls_beyond_solid = 0;
  /// Largest distance of the surface of the union from that of the solid, over 32 points of each ball. From 3,125 balls
  /// on, only every second or further ball counts, in all 1,563 to 3,125 of them.
  double balls_to_surface = 0;
  /// Each point of the surface is at most this far from a sample, mesh units. The step is the median edge of the axis,
  /// or 1/256 of the diagonal if that is less. It is larger if over 50,000 samples of a mesh would be needed. Each face
  /// of a voxel has one or four samples. Above 250,000 faces, each direction of faces in 4 x 4 x 4 voxels has one
  /// sample.
  double step = 0;
};

template <>
struct Description<BallUnionCheck> {
  static constexpr std::string_view name = "BallUnionCheck";
  static constexpr std::string_view doc =
      "Distances between the solid and the balls of an axis, reported and not judged";
  static constexpr std::tuple members{
      Member{"solid_to_balls", &BallUnionCheck::solid_to_balls, "mesh units",
             "largest distance of the solid's surface from the union of the balls"},
      Member{"mean_solid_to_balls", &BallUnionCheck::mean_solid_to_balls, "mesh units", "mean of that distance"},
      Member{"balls_beyond_solid", &BallUnionCheck::balls_beyond_solid, "mesh units",
             "largest distance by which balls reach out of the solid"},
      Member{"balls_to_surface", &BallUnionCheck::balls_to_surface, "mesh units",
             "largest distance of the union's surface from the solid's"},
      Member{"sample_step", &BallUnionCheck::step, "mesh units",
             "largest distance of a point of the surface from a sample"},
  };
};

/// Result of the check that an axis lies in the middle of its solid, and that no part of it is missing.
///
/// Sample points are the same in every run. There are at most 8,192 of sheets, 2,048 of curves, 4,096 vertices and
/// 16,384 of the solid. Small sheets get up to 4,096 points more, and all bodies together up to 32,768.
///
/// Lengths are measured in voxels, whose side the axis reports. It counts as an eighth of the longest side of the solid
/// at most. If it is unknown, it is 1/32 of the diagonal. If the solid consists of voxels, it is at least half and at
/// most the whole of their diagonal. A deviation counts as 1/64 of the diagonal of the solid at most.
///
/// Middle: at a point of the axis, the ball that touches the closest wall is grown until it touches another one. The
/// point is off the middle by its distance from the bisector of both walls. Walls that the ball's centre sees at less
/// than 10 degrees (images: 20) are one. Only cells that claim more than theta are judged. If the solid consists of
/// voxels, theta counts as at least 40 degrees for an image and 20 degrees for a mesh. The other cells exist for
/// homotopy alone, and may lie anywhere in the solid.
///
/// At least 95 % of the points must be within the allowance, which is 1.5 voxels plus the deviation. At least 90 % must
/// also be within a quarter of the radius of their ball. Half must be within an eighth of it, and within a third of a
/// voxel. The deviation plus a twelfth of a voxel replaces this third if it is more. A larger radius at a corner of the
/// cell replaces that of the ball. Flat cells cut off bends, so a tenth of the cell's longest side replaces these
/// shares of the radius if it is more. It counts as a quarter of a voxel at most. If the solid consists of voxels, the
/// shares of the radius do not apply.
///
/// Unless the solid consists of voxels, sheets are also judged one by one. These are the sheets with 12 of the points,
/// and the largest 341 others of at least 4 square voxels, with 12 points each. At most half of the points of each may
/// be outside the allowance.
///
/// Single footprints: ends of sheets and thin walls have vertices with one footprint in judged cells. Such a vertex
/// must be within the allowance and a quarter of the radius, too. Vertices of judged cells with a radius below one
/// voxel are exempt. A tenth of the vertices of judged cells, or 16, may be further off.
///
/// A stricter limit holds if a cell at the vertex surely sees two walls. Such a cell claims more than theta and 20
/// degrees (images: 40), and all its other corners see as much. No such vertex may be off by more than 1.5 times the
/// distance allowed to missed balls of its radius. If judged sheets are larger than 256 square voxels, at most three in
/// five vertices deeper than the allowance may have one footprint.
///
/// Missing parts: balls are grown from random points of the solid. They are also grown in each body, from points beside
/// its surface, or in its box if it consists of voxels. Without a theta, this is not checked.
///
/// A ball counts if it sees two walls at 30 degrees more than theta, or half of the way to 180 if that is less. The
/// walls must be at least lambda apart. Walls closer than 4 voxels plus lambda count only at 80 degrees or more, and
/// not if the solid consists of voxels. The distance of the ball's centre from the axis must be at most
/// `missing_allowance`, 2 voxels plus the deviation. Unless the solid consists of voxels, it must also be at most half
/// of the ball's radius, or 2 voxels if that is more.
///
/// This must hold for 95 % of the balls (voxels of a mesh: 90 %). In each body with 20 or more balls of 80 degrees or
/// more, it must hold for half of these. If it fails for more than 10 % of these in all bodies together, it must hold
/// for 90 % in each. Three balls may be missed in any case.
///
/// Against the voxels of a mesh, the shares in the middle and the vertices that are far off are reported and not
/// judged.
struct MedialCheck {
  double allowance = 0;              ///< Largest accepted distance from the middle, mesh units.
  std::size_t one_wall = 0;          ///< Vertices with one footprint, or two seen at less than 5 degrees.
  std::size_t claimed_vertices = 0;  ///< Vertices of judged cells.
  std::size_t one_wall_off =
      0;  ///< Vertices with one footprint, neither near the middle nor at a thin part; sampled if many.
  std::size_t one_wall_far = 0;     ///< Those of these that are far off.
  Vec3d far_at;                     ///< Position of the first of these, mesh units.
  std::size_t deep_vertices = 0;    ///< Vertices of judged cells that are deeper than the allowance.
  std::size_t deep_one_wall = 0;    ///< Those of these with one footprint.
  double homotopy_share = 0;        ///< Share of the area of all triangles that is not judged.
  std::size_t samples = 0;          ///< Examined points of sheets and curves.
  double medial_share = 1;          ///< Share of these that is in the middle, by area. A curve counts as a voxel wide.
  double near_share = 1;            ///< Share within the allowance and a quarter of the radius of the ball.
  double close_share = 1;           ///< Share within `close_allowance` and an eighth of that radius.
  double close_allowance = 0;       ///< A third of a voxel, or the deviation plus a twelfth of a voxel, mesh units.
  double off_by = 0;                ///< Largest distance of these from the middle, where two walls exist, mesh units.
  Vec3d off_at;                     ///< Place of that distance, mesh units.
  std::size_t sheets_judged = 0;    ///< Sheets that were judged one by one; 0 if the solid consists of voxels.
  std::size_t sheets_off = 0;       ///< Those of these that are for the most part not in the middle.
  Vec3d sheet_off_at;               ///< Point of the first of these, mesh units.
  double sought_angle = 0;          ///< Degrees from which nothing may be missing; 0 if that was not checked.
  double missing_allowance = 0;     ///< Largest accepted distance of a ball's centre from the axis, mesh units.
  std::size_t balls = 0;            ///< Balls from random points of the solid that count.
  double missed_share = 0;          ///< Share of these without a point of the axis near their centres.
  double missed_by = 0;             ///< Largest distance of these from the axis, mesh units.
  Vec3d missed_at;                  ///< Place of that distance, mesh units.
  std::size_t bodies_unseen = 0;    ///< Bodies with fewer than 20 such balls from points beside the surface.
  std::size_t bodies_missed = 0;    ///< Other bodies in which too many balls have no point of the axis nearby.
  double missed_share_of_body = 0;  ///< As `missed_share`, for the worst body.
  double missed_in_body_by = 0;     ///< Largest distance of a ball of that body from the axis, mesh units.
  Vec3d missed_in_body_at;          ///< Place of that distance, mesh units.
  bool judges_missing = false;      ///< True if the whole solid or a body has enough balls to judge.
  bool holds = false;               ///< True if enough is in the middle, and little is missed.
};

template <>
struct Description<MedialCheck> {
  static constexpr std::string_view name = "MedialCheck";
  static constexpr std::string_view doc =
      "Check that an axis lies in the middle of its solid, and that no part is missing";
  static constexpr std::tuple members{
      Member{"allowance", &MedialCheck::allowance, "mesh units",
             "largest accepted distance of a point from the middle"},
      Member{"one_wall", &MedialCheck::one_wall, "", "vertices that see only one wall"},
      Member{"claimed_vertices", &MedialCheck::claimed_vertices, "",
             "vertices of cells that should lie between two walls"},
      Member{"one_wall_off", &MedialCheck::one_wall_off, "",
             "vertices (sampled if many) that should see two walls, see one, and lie neither near the middle nor "
             "beside a thin part"},
      Member{"one_wall_far", &MedialCheck::one_wall_far, "", "those of these that are far off"},
      Member{"far_at", &MedialCheck::far_at, "mesh units", "position of the first of these"},
      Member{"deep_vertices", &MedialCheck::deep_vertices, "",
             "vertices of cells that should lie between two walls, deeper than the allowance"},
      Member{"deep_one_wall", &MedialCheck::deep_one_wall, "", "those of these that see only one wall"},
      Member{"homotopy_share", &MedialCheck::homotopy_share, "", "share of the area that exists for homotopy alone"},
      Member{"samples", &MedialCheck::samples, "", "examined points of sheets and curves"},
      Member{"medial_share", &MedialCheck::medial_share, "", "share of these in the middle, by area"},
      Member{"near_share", &MedialCheck::near_share, "", "share also within a quarter of the distance to the walls"},
      Member{"close_share", &MedialCheck::close_share, "",
             "share within close_allowance or an eighth of the distance to the walls"},
      Member{"close_allowance", &MedialCheck::close_allowance, "mesh units",
             "a third of a voxel, or the deviation plus a twelfth of a voxel"},
      Member{"off_by", &MedialCheck::off_by, "mesh units", "largest distance of these from the middle"},
      Member{"off_at", &MedialCheck::off_at, "mesh units", "place of that distance"},
      Member{"sheets_judged", &MedialCheck::sheets_judged, "", "sheets with enough samples to be judged one by one"},
      Member{"sheets_off", &MedialCheck::sheets_off, "", "sheets that are mostly off the middle"},
      Member{"sheet_off_at", &MedialCheck::sheet_off_at, "mesh units", "point of the first of these"},
      Member{"sought_angle", &MedialCheck::sought_angle, "degrees",
             "angle from which nothing may be missing; 0 if that was not checked"},
      Member{"missing_allowance", &MedialCheck::missing_allowance, "mesh units",
             "largest accepted distance of a ball centre from the axis"},
      Member{"balls", &MedialCheck::balls, "", "balls from random points of the solid that see at least that angle"},
      Member{"missed_share", &MedialCheck::missed_share, "", "share of these without a point of the axis nearby"},
      Member{"missed_by", &MedialCheck::missed_by, "mesh units", "largest distance of these from the axis"},
      Member{"missed_at", &MedialCheck::missed_at, "mesh units", "place of that distance"},
      Member{"bodies_unseen", &MedialCheck::bodies_unseen, "",
             "bodies with too few such balls from points near the surface"},
      Member{"bodies_missed", &MedialCheck::bodies_missed, "", "other bodies in which too many balls are missed"},
      Member{"missed_share_of_body", &MedialCheck::missed_share_of_body, "", "share of missed balls in the worst body"},
      Member{"missed_in_body_by", &MedialCheck::missed_in_body_by, "mesh units",
             "largest distance of a ball of that body from the axis"},
      Member{"missed_in_body_at", &MedialCheck::missed_in_body_at, "mesh units", "place of that distance"},
      Member{"judges_missing", &MedialCheck::judges_missing, "", "true if there are enough balls to judge"},
      Member{"holds", &MedialCheck::holds, "", "true if enough is in the middle, and little is missed"},
  };
};

/// Result of the check that the triangles of an axis lie in the solid between their edges. Around a point of depth r, a
/// ball of radius r lies in the body. The part of a triangle that the balls of its corners do not cover is cut up. This
/// ends when balls cover it or one of its points is found outside.
///
/// Triangles are flat and the solid is not. So they may leave it by the tolerance, plus the limit for edges that cut a
/// corner, plus the deviation. Those that leave it by less are reported.
struct TriangleCheck {
  std::size_t triangles = 0;  ///< Checked triangles.
  std::size_t leaving = 0;    ///< Triangles that leave the body of their corners by more than the tolerance.
  std::size_t outside = 0;    ///< Those of these that leave it by more than the allowance.
  double outside_by = 0;      ///< Largest distance from the body, mesh units.
  Vec3d where;                ///< Place of that distance, mesh units.
  std::size_t undecided = 0;  ///< Triangles in very thin walls that 512 points (64 if hopeless) do not decide.
  double tolerance = 0;       ///< Tolerance of edges, mesh units.
  double allowance = 0;       ///< Allowance in the largest body, mesh units.
  bool holds = false;         ///< True if no triangle is outside.
};

template <>
struct Description<TriangleCheck> {
  static constexpr std::string_view name = "TriangleCheck";
  static constexpr std::string_view doc = "Check that triangles lie in the solid between their edges";
  static constexpr std::tuple members{
      Member{"triangles", &TriangleCheck::triangles, "", "checked triangles"},
      Member{"leaving", &TriangleCheck::leaving, "", "triangles that leave the solid by more than the tolerance"},
      Member{"outside", &TriangleCheck::outside, "", "those of these that leave it by more than the allowance"},
      Member{"outside_by", &TriangleCheck::outside_by, "mesh units", "largest distance from the solid"},
      Member{"where", &TriangleCheck::where, "mesh units", "place of that distance"},
      Member{"undecided", &TriangleCheck::undecided, "", "triangles in walls so thin that the result is undecided"},
      Member{"tolerance", &TriangleCheck::tolerance, "mesh units", "tolerance of edges"},
      Member{"allowance", &TriangleCheck::allowance, "mesh units", "accepted distance from the solid"},
      Member{"holds", &TriangleCheck::holds, "", "true if no triangle is outside"},
  };
};

/// Result of the check that an axis lists and labels its cells as its triangles require. Edges of one triangle must be
/// listed as rims, those of three or more as seams, those of none as curves, and no others. Roles of vertices follow
/// from these and from sheets (MedialRole).
///
/// Sheets must be numbered from 0, without gaps. Each must be connected through edges that exactly two triangles share.
/// Two sheets may share such an edge only next to a seam. The file decides whether a sheet continues past a seam there.
/// No exception is allowed.
struct LabelCheck {
  std::size_t doubled = 0;       ///< Cells with the same vertices as another cell.
  std::size_t inner_listed = 0;  ///< Listed edges of two triangles.
  std::size_t unlisted = 0;      ///< Edges of one triangle, or of three or more, that are not listed.
  std::size_t edge_roles = 0;    ///< Edges with a wrong role.
  std::size_t vertex_roles = 0;  ///< Vertices with a wrong role.
  std::size_t sheets = 0;        ///< Labels of triangles.
  std::size_t gaps = 0;          ///< Numbers below the largest that no triangle has.
  std::size_t torn = 0;          ///< Sheets that are not connected.
  std::size_t parted = 0;        ///< Edges between two sheets, away from seams.
  bool holds = false;            ///< True if nothing is wrong.
};

template <>
struct Description<LabelCheck> {
  static constexpr std::string_view name = "LabelCheck";
  static constexpr std::string_view doc = "Check that roles and sheets fit the triangles";
  static constexpr std::tuple members{
      Member{"doubled", &LabelCheck::doubled, "", "cells with the same vertices as another one"},
      Member{"inner_listed", &LabelCheck::inner_listed, "", "listed edges of two triangles"},
      Member{"unlisted", &LabelCheck::unlisted, "", "rims and seams that are not listed"},
      Member{"edge_roles", &LabelCheck::edge_roles, "", "edges with a wrong role"},
      Member{"vertex_roles", &LabelCheck::vertex_roles, "", "vertices with a wrong role"},
      Member{"sheets", &LabelCheck::sheets, "", "labels of triangles"},
      Member{"gaps", &LabelCheck::gaps, "", "numbers below the largest that no triangle has"},
      Member{"torn", &LabelCheck::torn, "", "sheets that are not connected"},
      Member{"parted", &LabelCheck::parted, "", "edges between two sheets, away from seams"},
      Member{"holds", &LabelCheck::holds, "", "true if nothing is wrong"},
  };
};

/// Result of the check that the separation angles of triangles and edges fit their positions. A triangle has the
/// largest angle within half a voxel of it, and of triangles removed for it. So only shares are judged, from 64 cells
/// on. Against voxels, of images or meshes, the shares that depend on corners and positions are reported and not
/// judged.
struct AngleCheck {
  std::size_t triangles = 0;      ///< Triangles whose corners all have 10 degrees or more.
  double below_share = 0;         ///< Share of their area over 10 degrees below each corner. At most 0.8 is accepted.
  std::size_t samples = 0;        ///< Examined triangles.
  double above_share = 0;         ///< Share over 20 degrees above all seen within a voxel. At most 0.2 is accepted.
  std::size_t curve_samples = 0;  ///< Examined edges of curves.
  double curves_above_share = 0;  ///< Share of these with such an angle. At most 0.6 is accepted.
  std::size_t borders = 0;        ///< Rims and seams.
  std::size_t borders_above = 0;  ///< Those with an angle above those of all their triangles. None is accepted.
  std::size_t borders_below = 0;  ///< Those with an angle over 20 degrees below. At most half are accepted.
  std::size_t rims = 0;           ///< Examined rims; none if theta is not known.
  double low_rims_share = 0;  ///< Share of the length of rims and curves in rims of sheets of at most theta: at most
                              ///< 0.25.
  bool holds = false;         ///< True if all shares are small enough.
};

template <>
struct Description<AngleCheck> {
  static constexpr std::string_view name = "AngleCheck";
  static constexpr std::string_view doc = "Check that separation angles of triangles and edges fit their positions";
  static constexpr std::tuple members{
      Member{"triangles", &AngleCheck::triangles, "", "triangles whose corners all see two walls"},
      Member{"below_share", &AngleCheck::below_share, "",
             "share of their area with an angle below those of all corners"},
      Member{"samples", &AngleCheck::samples, "", "examined triangles"},
      Member{"above_share", &AngleCheck::above_share, "",
             "share of these with an angle above all found within a voxel"},
      Member{"curve_samples", &AngleCheck::curve_samples, "", "examined edges of curves"},
      Member{"curves_above_share", &AngleCheck::curves_above_share, "", "share of these with such an angle"},
      Member{"borders", &AngleCheck::borders, "", "rims and seams"},
      Member{"borders_above", &AngleCheck::borders_above, "", "those with an angle above those of all their triangles"},
      Member{"borders_below", &AngleCheck::borders_below, "", "those with an angle 20 degrees below"},
      Member{"rims", &AngleCheck::rims, "", "examined rims; none if theta is unknown"},
      Member{"low_rims_share", &AngleCheck::low_rims_share, "",
             "share of the length of rims and curves in rims of sheets without an angle above theta"},
      Member{"holds", &AngleCheck::holds, "", "true if all shares are small enough"},
  };
};

/// Parts that a certificate checks besides numbers of components, tunnels and voids, for files without some data.
struct CertificateOptions {
  /// Positions of vertices and edges. Without them, the Betti numbers of the whole solid and the whole axis are
  /// compared.
  bool positions = true;
  bool radii = true;       ///< Needs positions.
  bool footprints = true;  ///< Needs radii.
  bool angles = true;      ///< Angles of vertices, triangles and edges. Needs footprints.
  bool sites = true;       ///< Needs footprints. Sites that are none() are not checked.
  bool labels = true;      ///< Roles of vertices and edges, and sheets. Needs positions.
  bool balls = true;       ///< Distances between solid and balls. Needs radii.
  bool medial = true;      ///< Middle and missing parts. Needs radii, and angles for sheets and curves.
  // Parameters that the axis reports, for the medial check; unset if not known.
  std::optional<double> theta = {};      ///< Degrees.
  std::optional<double> lambda = {};     ///< Mesh units.
  std::optional<double> spacing = {};    ///< Side of a voxel, mesh units.
  std::optional<double> deviation = {};  ///< DecimatedAxis::deviation, mesh units.
};

template <>
struct Description<CertificateOptions> {
  static constexpr std::string_view name = "CertificateOptions";
  static constexpr std::string_view doc =
      "Parts that a certificate checks besides numbers of components, tunnels and voids";
  static constexpr std::tuple members{
      Member{"positions", &CertificateOptions::positions, "", "positions of vertices and edges"},
      Member{"radii", &CertificateOptions::radii, "", "radii of vertices"},
      Member{"footprints", &CertificateOptions::footprints, "", "footprints of vertices; needs radii"},
      Member{"angles", &CertificateOptions::angles, "", "angles of vertices, triangles and edges; needs footprints"},
      Member{"sites", &CertificateOptions::sites, "", "sites of vertices; needs footprints"},
      Member{"labels", &CertificateOptions::labels, "", "roles and sheets; needs positions"},
      Member{"balls", &CertificateOptions::balls, "", "distances between solid and balls; needs radii"},
      Member{"medial", &CertificateOptions::medial, "", "middle of the solid and missing parts; needs radii"},
      Member{"theta", &CertificateOptions::theta, "degrees", "angle that the axis reports"},
      Member{"lambda", &CertificateOptions::lambda, "mesh units", "lambda that the axis reports", Range::at_least(0)},
      Member{"spacing", &CertificateOptions::spacing, "mesh units", "side of a voxel that the axis reports",
             Range::positive()},
      Member{"deviation", &CertificateOptions::deviation, "mesh units",
             "deviation by removed vertices that the axis reports", Range::at_least(0)},
  };
};

struct Certificate {
  SolidRule against = SolidRule::polyhedron;
  CertificateOptions checked;
  BettiNumbers solid{};           ///< Sum over the bodies, from the boundary of the solid or its voxels.
  BettiNumbers axis{};            ///< Betti numbers of the complex, by homology().
  std::optional<double> voxel;    ///< Shortest side of a voxel, mesh units, if the solid consists of voxels.
  std::vector<BodyCheck> bodies;  ///< Each must agree. One for the whole solid without CertificateOptions::positions.
  bool topology_holds = false;
  GeometryCheck geometry;
  EdgeCheck edges;
  TriangleCheck triangles;
  LabelCheck labels;  ///< Computed with CertificateOptions::labels.
  AngleCheck angles;  ///< Computed with CertificateOptions::angles.
  HomologyCheck homology;
  BallUnionCheck balls;
  MedialCheck medial;
  std::vector<std::string> mismatches;  ///< One sentence per mismatch; empty if all holds.

  [[nodiscard]] bool holds() const { return mismatches.empty(); }
};

template <>
struct Description<Certificate> {
  static constexpr std::string_view name = "Certificate";
  static constexpr std::string_view doc =
      "Result of checking the topology and the geometry of an axis against its solid";
  static constexpr std::tuple members{
      Member{"against", &Certificate::against, "", "rule for the solid"},
      Member{"checked", &Certificate::checked, "", "checked parts"},
      Member{"solid_betti", &Certificate::solid, "", "components, tunnels, voids of the solid: the sum of its bodies"},
      Member{"axis_betti", &Certificate::axis, "", "components, tunnels, voids of the axis"},
      Member{"voxel", &Certificate::voxel, "mesh units", "shortest side of a voxel if the solid is made of voxels"},
      Member{"bodies", &Certificate::bodies, "",
             "bodies, which must all agree; one for the whole if positions were not checked"},
      Member{"topology_holds", &Certificate::topology_holds, "", "true if all bodies agree"},
      Member{"geometry", &Certificate::geometry, "", "check of the vertices"},
      Member{"edges", &Certificate::edges, "", "check of the edges"},
      Member{"triangles", &Certificate::triangles, "", "check of the triangles between their edges"},
      Member{"labels", &Certificate::labels, "", "check of roles and sheets"},
      Member{"angles", &Certificate::angles, "", "check of the separation angles of triangles and edges"},
      Member{"homology", &Certificate::homology, "", "check of tunnels and voids"},
      Member{"balls", &Certificate::balls, "", "distances between solid and balls"},
      Member{"medial", &Certificate::medial, "", "check of the middle and of missing parts"},
      Member{"mismatches", &Certificate::mismatches, "", "one sentence for each mismatch; empty if all holds"},
      Fact{"holds", &Certificate::holds, "", "true if there is no mismatch"},
  };
};

/// Rule for the solid of a mesh. SolidRule::polyhedron requires that the mesh is closed, manifold and orientable. Its
/// triangles must not cross or, within one body, touch. A mesh that resolve_crossings() turns into such a mesh, with
/// the same inside, counts, too. The rule of all other meshes is SolidRule::winding.
struct MeshSolidRule {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;  ///< One sentence.
};
template <>
struct Description<MeshSolidRule> {
  static constexpr std::string_view name = "MeshSolidRule";
  static constexpr std::string_view doc = "Rule for the solid of a mesh";
  static constexpr std::tuple members{
      Member{"rule", &MeshSolidRule::rule, "", "volume bounded by the shells, or winding number above 1/2"},
      Member{"reason", &MeshSolidRule::reason, "", "reason in one sentence"},
  };
};

/// Returns the rule for the solid of a mesh. The verifier reads the mesh itself and calls find_self_intersections(). If
/// the mesh crosses itself, the result of resolve_crossings() is read in the same way.
/// @throws InvalidMesh if validate() rejects the mesh; Cancelled.
[[nodiscard]] MeshSolidRule solid_rule(const MeshView& mesh, const Context& context = {});

/// Checks an axis against the solid that a closed, manifold mesh bounds.
///
/// The check uses no field, no voxels and no record of the construction. Betti numbers come from the homology of the
/// surface and the nesting of its components, by counting crossings of lines. Distances come from separate searches.
/// Shared with the construction are the search for crossings of triangles, their resolution, signs of determinants and
/// the numbering of sites. Shells may face either way, and touch. Triangles that name a vertex twice are left out. If
/// the mesh crosses itself, the solid is that of resolve_crossings().
///
/// Betti numbers are compared body by body. A connected part of the axis belongs to the body that contains its deepest
/// vertex. Linking numbers prove that its loops and closed surfaces go around the tunnels and voids of that body
/// (HomologyCheck).
/// @throws InvalidMesh if the mesh is not closed and manifold, or crosses itself and this is not resolved. Also if a
/// shell encloses nothing, or exactly what another one does. InvalidOption if the complex is invalid (see homology())
/// or lacks a column of MedialView; Cancelled.
/// Cost: on one core about 2 s for 100,000 vertices and as many triangles.
[[nodiscard]] Certificate certify(const Complex& axis, const MeshView& mesh, const CertificateOptions& options = {},
                                  const Context& context = {});

/// Checks an axis against the closed union of voxels. The voxels are those of an image, and distances refer to their
/// faces. Or they represent a mesh that is not a polyhedron (SolidRule::winding), and distances refer to that mesh.
/// voxels_inside() computes such voxels. They are used as given, so an error that they share with the construction is
/// not detected.
/// @param grid  of the voxels' centres.
/// @param surface  the mesh; nullptr for an image.
/// @throws InvalidGrid, also if the grid does not cover the mesh. InvalidMesh. InvalidOption, also if the sizes of the
/// grid and the voxels differ, or no voxel exists. Cancelled.
[[nodiscard]] Certificate certify(const Complex& axis, const VoxelSet& voxels, const GridSpec& grid,
                                  const MeshView* surface, const CertificateOptions& options = {},
                                  const Context& context = {});

/// Checks whether any complex, a medial axis or not, has the topology of the solid of a mesh. Performs the checks of
/// certify() that need only positions, without the columns of MedialView. Betti numbers must agree body by body, and
/// vertices, edges and triangles must lie in the solid.
/// @throws as certify().
[[nodiscard]] Certificate certify_topology(const Complex& complex, const MeshView& mesh, const Context& context = {});

/// Checks the topology of any complex against voxels, which are as in certify().
[[nodiscard]] Certificate certify_topology(const Complex& complex, const VoxelSet& voxels, const GridSpec& grid,
                                           const MeshView* surface, const Context& context = {});

}  // namespace blum
