// Blum: whether a medial axis is what it claims to be. SPDX-License-Identifier: Apache-2.0
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

/// What a certificate has shown of the topology of an axis, in rising order.
enum class Proven : std::uint8_t {
  nothing,            ///< numbers differ, or were not compared in places
  betti_numbers,      ///< the axis has as many components, tunnels and voids as the solid, in each body
  homology_modulo_2,  ///< its way into the solid is an isomorphism of homology with coefficients in Z/2
  homology,           ///< the same over the integers
  homotopy_type       ///< the axis and the solid are homotopy equivalent
};

template <>
struct Description<Proven> {
  static constexpr std::string_view name = "Proven";
  static constexpr std::array values{
      NamedValue{Proven::nothing, "nothing"}, NamedValue{Proven::betti_numbers, "equal Betti numbers"},
      NamedValue{Proven::homology_modulo_2, "isomorphic homology modulo 2"},
      NamedValue{Proven::homology, "isomorphic homology"}, NamedValue{Proven::homotopy_type, "homotopy equivalent"}};
};

/// Components, tunnels and voids of one body of the solid, and of the parts of the axis that lie in it.
struct BodyCheck {
  BettiNumbers solid{};
  BettiNumbers axis{};
  std::int64_t tunnels_met = 0;  ///< rank modulo 2 of what loops of the axis run around
  std::int64_t voids_met = 0;    ///< rank modulo 2 of what closed surfaces of the axis are around
  Proven proven = Proven::nothing;
};

template <>
struct Description<BodyCheck> {
  static constexpr std::string_view name = "BodyCheck";
  static constexpr std::string_view doc = "Components, tunnels and voids of one body and of the axis in it";
  static constexpr std::tuple members{
      Member{"solid_betti", &BodyCheck::solid, "", "of the body"},
      Member{"axis_betti", &BodyCheck::axis, "", "of the parts of the axis that lie in it"},
      Member{"tunnels_met", &BodyCheck::tunnels_met, "", "rank modulo 2 of what loops of the axis run around"},
      Member{"voids_met", &BodyCheck::voids_met, "", "rank modulo 2 of what closed surfaces of the axis are around"},
      Member{"proven", &BodyCheck::proven, "", "what is shown of its topology"},
  };
};

/// How far the vertices of an axis are from what they claim. Distances are to the shells of the body that a vertex lies
/// in (its outer shell and the voids in it), or of the closest one. Allowed is 1e-6 of the diagonal of that body's box,
/// or twice the rounding of its coordinates where that is more. Against the voxels of a mesh (SolidRule::winding) a
/// vertex is outside where it is further from them than the diagonal of a voxel.
struct GeometryCheck {
  std::size_t vertices = 0;          ///< looked at
  std::size_t not_finite = 0;        ///< of them, those with a coordinate or radius that is no finite number
  std::size_t outside = 0;           ///< of them, those outside of the solid by more than is allowed
  double outside_by = 0;             ///< largest distance of a vertex from the solid, mesh units
  double radius_error = 0;           ///< largest |radius - exact distance to the surface|, mesh units
  double footprint_off_surface = 0;  ///< largest distance of a footprint from the surface, mesh units
  double footprint_error = 0;        ///< largest |distance to a footprint - radius|, mesh units
  double site_error = 0;             ///< largest distance of a footprint from the site that is named for it, mesh units
  double angle_error = 0;            ///< largest |separation angle - angle between the footprints|, degrees
  double tolerance = 0;              ///< what is allowed in the largest body, mesh units
  bool holds = false;                ///< no vertex is outside or not finite, and no error above what is allowed for it
};

template <>
struct Description<GeometryCheck> {
  static constexpr std::string_view name = "GeometryCheck";
  static constexpr std::string_view doc = "How far vertices are from what they claim";
  static constexpr std::tuple members{
      Member{"vertices", &GeometryCheck::vertices, "", "looked at"},
      Member{"not_finite", &GeometryCheck::not_finite, "",
             "of them, those with a coordinate or radius that is no finite number"},
      Member{"outside", &GeometryCheck::outside, "", "of them, those outside of the solid by more than is allowed"},
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
      Member{"tolerance", &GeometryCheck::tolerance, "mesh units", "what is allowed in the largest body"},
      Member{"holds", &GeometryCheck::holds, "", "whether no vertex is outside, and no error above what is allowed"},
  };
};

/// Whether the edges of an axis, those of its triangles too, lie in the solid between their ends: found from distances
/// along each, so that nothing is left out. An edge may cut a corner, by 1/64 of the diagonal of the
/// body at most, if it can be pushed into the solid: its point that is furthest out goes through the closest point of
/// the surface, then those of both parts, until all lies in the solid. That fails for an edge across a gap, however
/// narrow. Against the voxels of an image a corner may be cut by half the diagonal of a voxel where that is more, and
/// 1/64 of it is not out. Against the voxels of a mesh the diagonal of a voxel is allowed, and nothing is pushed.
struct EdgeCheck {
  std::size_t edges = 0;    ///< looked at, each once
  std::size_t pushed = 0;   ///< of them, those that cut a corner of the body that their ends lie in
  double pushed_by = 0;     ///< how far the furthest of these is out, mesh units
  std::size_t outside = 0;  ///< those that leave that body otherwise
  double outside_by = 0;    ///< how far the furthest of these is out, at least, mesh units
  Vec3d where;              ///< and there, mesh units
  std::size_t across = 0;   ///< those that are out by no more than the tolerance, but cross a gap of the solid there
  Vec3d across_at;          ///< the first of these, mesh units
  std::size_t untold = 0;   ///< those of which that cannot be told: nothing more than Betti numbers is proven
  double tolerance = 0;     ///< ten times GeometryCheck::tolerance; the diagonal of a voxel more for SolidRule::winding
  bool holds = false;       ///< none is outside or crosses a gap
};

template <>
struct Description<EdgeCheck> {
  static constexpr std::string_view name = "EdgeCheck";
  static constexpr std::string_view doc = "Whether edges lie in the solid between their ends";
  static constexpr std::tuple members{
      Member{"edges", &EdgeCheck::edges, "", "looked at, each once"},
      Member{"pushed", &EdgeCheck::pushed, "", "of them, those that cut a corner, and can be pushed into the solid"},
      Member{"pushed_by", &EdgeCheck::pushed_by, "mesh units", "how far the furthest of these is out"},
      Member{"outside", &EdgeCheck::outside, "", "those that leave the solid otherwise"},
      Member{"outside_by", &EdgeCheck::outside_by, "mesh units", "how far the furthest of these is out, at least"},
      Member{"where", &EdgeCheck::where, "mesh units", "and there"},
      Member{"across", &EdgeCheck::across, "", "those out by no more than the tolerance that cross a gap there"},
      Member{"across_at", &EdgeCheck::across_at, "mesh units", "the first of these"},
      Member{"untold", &EdgeCheck::untold, "", "those of which that cannot be told: only Betti numbers are proven"},
      Member{"tolerance", &EdgeCheck::tolerance, "mesh units", "what is allowed"},
      Member{"holds", &EdgeCheck::holds, "", "whether none is outside or crosses a gap"},
  };
};

/// Whether the way of an axis into its solid is an isomorphism of homology, and not only the numbers agree: exact
/// linking numbers of the axis's loops with closed paths along the surface that generate the homology of what is
/// outside, and winding numbers of its closed surfaces around points of each void (Alexander duality). A loop that
/// runs round nothing, or twice round one tunnel and never round another, is found out and refused. A triangle across a
/// hole is found out, too, and refused. Looked at where Betti numbers agree and
/// edges lie in the solid; not for tunnels and voids of voxels, of which numbers alone are compared.
struct HomologyCheck {
  std::size_t paths = 0;      ///< closed ones along the surface that linking numbers were taken with
  std::size_t triangles = 0;  ///< of the axis, in bodies with tunnels
  std::size_t across = 0;     ///< of them, those whose border is linked with a path: they span a hole of the solid
  Vec3d where;                ///< the first of these, mesh units
  std::size_t doubtful = 0;   ///< edges of the axis that touch the surface, so that linking cannot be told
  Proven proven = Proven::nothing;  ///< in every body
  bool holds = false;               ///< whether nothing speaks against it, shown or not
  std::string shown;                ///< what was, and why no more: one sentence
};

template <>
struct Description<HomologyCheck> {
  static constexpr std::string_view name = "HomologyCheck";
  static constexpr std::string_view doc = "Whether an axis's way into its solid is an isomorphism of homology";
  static constexpr std::tuple members{
      Member{"paths", &HomologyCheck::paths, "", "closed ones along the surface that loops were linked with"},
      Member{"triangles", &HomologyCheck::triangles, "", "of the axis, in bodies with tunnels"},
      Member{"across", &HomologyCheck::across, "", "of them, those that span a hole of the solid"},
      Member{"where", &HomologyCheck::where, "mesh units", "the first of these"},
      Member{"doubtful", &HomologyCheck::doubtful, "", "edges that touch the surface, so that linking cannot be told"},
      Member{"proven", &HomologyCheck::proven, "", "what is shown in every body"},
      Member{"holds", &HomologyCheck::holds, "", "whether nothing speaks against it, shown or not"},
      Member{"shown", &HomologyCheck::shown, "", "what is shown, and why no more: one sentence"},
  };
};

/// How much of a solid the balls of an axis fill: those around its vertices, and where edges and triangles are longer
/// than 1/200 of the diagonal, between these, with interpolated radii (see sample_axis()). Told, and not judged.
struct BallUnionCheck {
  /// How far the surface of the solid is from the union of the balls at most, over samples of the surface, the corners
  /// of a mesh among them; the diagonal of the solid where there are no balls.
  double solid_to_balls = 0;
  double mean_solid_to_balls = 0;  ///< the same, its mean over the area of the surface
  /// How far the balls reach out of the solid at most: largest radius - exact distance, which is negative outside of
  /// the solid; 0 for exact radii.
  double balls_beyond_solid = 0;
  /// How far points of the surface of the union are from the surface of the solid at most, over 32 points of each ball;
  /// of more than 3,100 balls, over those of 1,500 to 3,100 of them.
  double balls_to_surface = 0;
  /// Each point of the surface is at most this far from a sample, mesh units: the median edge of the axis, or
  /// 1/256 of the diagonal where that is less, or more where that would take over 50,000 samples. Samples of
  /// voxels are one or four points of each face; above 250,000 faces, one for each direction of faces in 4 x 4 x 4
  /// voxels.
  double step = 0;
};

template <>
struct Description<BallUnionCheck> {
  static constexpr std::string_view name = "BallUnionCheck";
  static constexpr std::string_view doc = "How much of the solid the balls of an axis fill: told, not judged";
  static constexpr std::tuple members{
      Member{"solid_to_balls", &BallUnionCheck::solid_to_balls, "mesh units",
             "largest distance of the solid's surface from the union"},
      Member{"mean_solid_to_balls", &BallUnionCheck::mean_solid_to_balls, "mesh units", "the same, its mean"},
      Member{"balls_beyond_solid", &BallUnionCheck::balls_beyond_solid, "mesh units",
             "how far balls reach out of the solid"},
      Member{"balls_to_surface", &BallUnionCheck::balls_to_surface, "mesh units",
             "largest distance of the union's surface from the solid's"},
      Member{"sample_step", &BallUnionCheck::step, "mesh units",
             "each point of the surface is at most this far from a sample"},
  };
};

/// Whether an axis is in the middle of its solid, and whether it is all that is there: asked at bounded numbers of
/// points (8,192 of sheets, 2,048 of curves, 4,096 vertices, 16,384 of the solid), the same in every run.
///
/// At a point of the axis the ball that touches the closest wall there is grown until it touches another one; the point
/// is off the middle by how far it is from the bisector of both. Walls that this ball sees at less than 10 degrees
/// (images: 20) are one. Only what says of itself that two walls see it at more than theta is asked: the rest is there
/// for homotopy alone, and may lie anywhere in the solid. 95 % must be within the allowance: 1.5 voxels, and the
/// deviation. 90 % must be within a quarter of the radius of that ball, half within an eighth of it, and within a third
/// of a voxel, or the deviation; or else within a tenth of the cell's longest side and a quarter of a voxel, by which
/// flat cells cut off what is bent. Voxels are taken to be an eighth of the longest side of the solid at most; 1/32 of
/// the diagonal where nothing is known; those of images are known. A deviation is taken to be 1/64 of the diagonal at
/// most.
///
/// The other way, balls are grown from random points of the solid, and of each body: beside its surface, or in its box
/// where it is made of voxels. Where two walls are seen at well more than theta (30 degrees, or half of the way to
/// 180), further apart than lambda, and than 4 voxels or at 80 degrees or more (voxels: and than 4 voxels), the axis
/// must have a point within 2 voxels and the deviation, and within half of the ball's radius, or 2 voxels where that
/// is more: for 95 % of the balls (voxels of a mesh: 90 %), for 90 % of those of the surfaces of all bodies that are
/// seen at 80 degrees or more, and for half of those of each body, if there are 20. Without a theta, this is not looked
/// at.
///
/// A vertex with one footprint where two walls should be seen (ends of sheets, thin walls) must be near the middle,
/// too, other than beside parts of less than two voxels (a radius below one); a tenth of those vertices, or 16, need
/// not. But none may be off by more than 1.5 times `missing_allowance` where what is beside it surely sees two walls: a
/// triangle or edge at it that says more than theta and than 20 degrees (images: 40), all of whose other corners see as
/// much. Of those deeper than the allowance at most three in five may have one,
/// where sheets are larger than 256 square voxels. Against the voxels of a mesh, what is in the middle is told only.
struct MedialCheck {
  double allowance = 0;              ///< how far from the middle a point may be, mesh units
  std::size_t one_wall = 0;          ///< vertices with one footprint, or two seen at less than 5 degrees
  std::size_t claimed_vertices = 0;  ///< vertices of what should be seen at more than theta
  std::size_t one_wall_off =
      0;  ///< of those that both are (some, where many), not near the middle nor beside a thin part
  std::size_t one_wall_far = 0;     ///< and of these, those that are far off
  Vec3d far_at;                     ///< the first of these, mesh units
  std::size_t deep_vertices = 0;    ///< vertices that should be seen at more than theta, deeper than the allowance
  std::size_t deep_one_wall = 0;    ///< of these, those with one footprint
  double homotopy_share = 0;        ///< of the area of all triangles: what only homotopy keeps, at theta or less
  std::size_t samples = 0;          ///< points of sheets and curves that were looked at
  double medial_share = 1;          ///< of these, what is in the middle, by area; a curve counts as a voxel wide
  double near_share = 1;            ///< the same within a quarter of the way to the walls
  double close_share = 1;           ///< the same within a third of a voxel, or the deviation, or an eighth of that way
  double close_allowance = 0;       ///< that length, mesh units
  double off_by = 0;                ///< how far the worst of these with two walls is from the middle, mesh units
  Vec3d off_at;                     ///< and there, mesh units
  std::size_t sheets_judged = 0;    ///< sheets with samples enough to judge them one by one; 0 of images
  std::size_t sheets_off = 0;       ///< of these, those that are for the most part not in the middle
  Vec3d sheet_off_at;               ///< a point of the first of these, mesh units
  double sought_angle = 0;          ///< degrees from which the axis must have all; 0 where that was not looked at
  double missing_allowance = 0;     ///< how close the axis must come to the balls, mesh units
  std::size_t balls = 0;            ///< from random points of the solid whose walls are seen at more than that
  double missed_share = 0;          ///< of these, those that have no point of the axis near their centres
  double missed_by = 0;             ///< how far the worst of all is from the axis, mesh units
  Vec3d missed_at;                  ///< and there, mesh units
  std::size_t bodies_unseen = 0;    ///< bodies in which too few points beside the surface show such balls
  std::size_t bodies_missed = 0;    ///< of the others, those of whose balls too many have no point of the axis near
  double missed_share_of_body = 0;  ///< the same share as `missed_share`, of the worst body
  double missed_in_body_by = 0;     ///< how far the worst ball of that body is from the axis, mesh units
  Vec3d missed_in_body_at;          ///< and there, mesh units
  bool judges_missing = false;      ///< whether there are balls enough, in the whole solid or a body, to tell
  bool holds = false;               ///< enough is in the middle, and little is missed
};

template <>
struct Description<MedialCheck> {
  static constexpr std::string_view name = "MedialCheck";
  static constexpr std::string_view doc = "Whether an axis is in the middle of its solid, and all that is there";
  static constexpr std::tuple members{
      Member{"allowance", &MedialCheck::allowance, "mesh units", "how far from the middle a point may be"},
      Member{"one_wall", &MedialCheck::one_wall, "", "vertices that see one wall"},
      Member{"claimed_vertices", &MedialCheck::claimed_vertices, "", "vertices of what two walls should see"},
      Member{"one_wall_off", &MedialCheck::one_wall_off, "",
             "of those that both are (some, where many), those not near the middle nor beside a thin part"},
      Member{"one_wall_far", &MedialCheck::one_wall_far, "", "of these, those far off"},
      Member{"far_at", &MedialCheck::far_at, "mesh units", "the first of these"},
      Member{"deep_vertices", &MedialCheck::deep_vertices, "",
             "of what two walls should see, deeper than the allowance"},
      Member{"deep_one_wall", &MedialCheck::deep_one_wall, "", "of these, those that see one wall"},
      Member{"homotopy_share", &MedialCheck::homotopy_share, "", "of the area: what only homotopy keeps"},
      Member{"samples", &MedialCheck::samples, "", "points of sheets and curves that were looked at"},
      Member{"medial_share", &MedialCheck::medial_share, "", "of these, what is in the middle, by area"},
      Member{"near_share", &MedialCheck::near_share, "", "the same within a quarter of the way to the walls"},
      Member{"close_share", &MedialCheck::close_share, "",
             "the same within a third of a voxel, or the deviation, or an eighth of that way"},
      Member{"close_allowance", &MedialCheck::close_allowance, "mesh units", "that length"},
      Member{"off_by", &MedialCheck::off_by, "mesh units", "how far the worst of these is from the middle"},
      Member{"off_at", &MedialCheck::off_at, "mesh units", "and there"},
      Member{"sheets_judged", &MedialCheck::sheets_judged, "", "sheets with samples enough to judge them one by one"},
      Member{"sheets_off", &MedialCheck::sheets_off, "", "of these, those for the most part not in the middle"},
      Member{"sheet_off_at", &MedialCheck::sheet_off_at, "mesh units", "a point of the first of these"},
      Member{"sought_angle", &MedialCheck::sought_angle, "degrees",
             "from where the axis must have all; 0 where that was not looked at"},
      Member{"missing_allowance", &MedialCheck::missing_allowance, "mesh units",
             "how close the axis must come to the balls"},
      Member{"balls", &MedialCheck::balls, "", "from random points of the solid that see more than that"},
      Member{"missed_share", &MedialCheck::missed_share, "", "of these, those that the axis has nothing near"},
      Member{"missed_by", &MedialCheck::missed_by, "mesh units", "how far the worst of all is from the axis"},
      Member{"missed_at", &MedialCheck::missed_at, "mesh units", "and there"},
      Member{"bodies_unseen", &MedialCheck::bodies_unseen, "", "in which too few points beside the surface see more"},
      Member{"bodies_missed", &MedialCheck::bodies_missed, "", "of the others, those in which too much is missed"},
      Member{"missed_share_of_body", &MedialCheck::missed_share_of_body, "", "of the balls of the worst body"},
      Member{"missed_in_body_by", &MedialCheck::missed_in_body_by, "mesh units",
             "how far the worst ball of that body is from the axis"},
      Member{"missed_in_body_at", &MedialCheck::missed_in_body_at, "mesh units", "and there"},
      Member{"judges_missing", &MedialCheck::judges_missing, "", "whether there are balls enough to tell"},
      Member{"holds", &MedialCheck::holds, "", "whether enough is in the middle, and little is missed"},
  };
};

/// Whether the triangles of an axis lie in the solid between their edges: a ball as large as a point is deep covers a
/// part of a triangle; what the balls of the corners leave is cut up until balls cover it, or a point of it is found
/// outside. Triangles are flat and the solid is not, so that they may leave it by what edges that cut a corner may, and
/// the deviation; those that leave it by less are told.
struct TriangleCheck {
  std::size_t triangles = 0;  ///< looked at
  std::size_t leaving = 0;    ///< of them, those that leave the body of their corners by more than the tolerance
  std::size_t outside = 0;    ///< of these, those that do so by more than the allowance
  double outside_by = 0;      ///< how far the furthest is out, mesh units
  Vec3d where;                ///< and there, mesh units
  std::size_t undecided = 0;  ///< those in walls so thin that 512 points of them do not tell
  double tolerance = 0;       ///< that of edges, mesh units
  double allowance = 0;       ///< in the largest body, mesh units
  bool holds = false;         ///< none is outside
};

template <>
struct Description<TriangleCheck> {
  static constexpr std::string_view name = "TriangleCheck";
  static constexpr std::string_view doc = "Whether triangles lie in the solid between their edges";
  static constexpr std::tuple members{
      Member{"triangles", &TriangleCheck::triangles, "", "looked at"},
      Member{"leaving", &TriangleCheck::leaving, "", "of them, those that leave the solid by more than the tolerance"},
      Member{"outside", &TriangleCheck::outside, "", "of these, those that do so by more than the allowance"},
      Member{"outside_by", &TriangleCheck::outside_by, "mesh units", "how far the furthest is out"},
      Member{"where", &TriangleCheck::where, "mesh units", "and there"},
      Member{"undecided", &TriangleCheck::undecided, "", "those in walls so thin that it cannot be told"},
      Member{"tolerance", &TriangleCheck::tolerance, "mesh units", "that of edges"},
      Member{"allowance", &TriangleCheck::allowance, "mesh units", "how far out is allowed"},
      Member{"holds", &TriangleCheck::holds, "", "whether none is outside"},
  };
};

/// Whether an axis lists what it should, and labels it as its triangles ask for: all edges of one triangle as rims,
/// all of three or more as seams, those of none as curves, and no others; vertices by what ends at them (MedialRole).
/// Sheets are numbered from 0, without gaps. Each hangs together over edges of two triangles, and two sheets share such
/// edges only next to seams. Whether sheets go on past a seam there, the file decides. No exception is allowed.
struct LabelCheck {
  std::size_t doubled = 0;       ///< cells that name the vertices of another one
  std::size_t inner_listed = 0;  ///< listed edges of two triangles
  std::size_t unlisted = 0;      ///< edges of one triangle, or of three or more, that are not listed
  std::size_t edge_roles = 0;    ///< edges of a false role
  std::size_t vertex_roles = 0;  ///< vertices of a false role
  std::size_t sheets = 0;        ///< labels of triangles
  std::size_t gaps = 0;          ///< numbers below the largest that no triangle has
  std::size_t torn = 0;          ///< of them, those that do not hang together
  std::size_t parted = 0;        ///< edges of two sheets, away from seams
  bool holds = false;            ///< nothing is wrong
};

template <>
struct Description<LabelCheck> {
  static constexpr std::string_view name = "LabelCheck";
  static constexpr std::string_view doc = "Whether roles and sheets are those that the triangles give";
  static constexpr std::tuple members{
      Member{"doubled", &LabelCheck::doubled, "", "cells that name the vertices of another one"},
      Member{"inner_listed", &LabelCheck::inner_listed, "", "listed edges of two triangles"},
      Member{"unlisted", &LabelCheck::unlisted, "", "rims and seams that are not listed"},
      Member{"edge_roles", &LabelCheck::edge_roles, "", "edges of a false role"},
      Member{"vertex_roles", &LabelCheck::vertex_roles, "", "vertices of a false role"},
      Member{"sheets", &LabelCheck::sheets, "", "labels of triangles"},
      Member{"gaps", &LabelCheck::gaps, "", "numbers below the largest that no triangle has"},
      Member{"torn", &LabelCheck::torn, "", "of them, those that do not hang together"},
      Member{"parted", &LabelCheck::parted, "", "edges of two sheets, away from seams"},
      Member{"holds", &LabelCheck::holds, "", "whether nothing is wrong"},
  };
};

/// Whether the separation angles of triangles and edges are those of their places: told by shares, since a triangle has
/// the largest angle that is seen within half a voxel of it, and that of others which went for it. Against voxels, of
/// images or meshes, what corners and places see is told only.
struct AngleCheck {
  std::size_t triangles = 0;      ///< whose corners all see two walls
  double below_share = 0;         ///< of their area: what says 10 degrees less than each of the three corners sees
  std::size_t samples = 0;        ///< triangles that were looked at
  double above_share = 0;         ///< of these: what says 20 degrees more than is seen within a voxel
  std::size_t curve_samples = 0;  ///< edges of curves that were looked at
  double curves_above_share = 0;  ///< the same of these
  std::size_t borders = 0;        ///< rims and seams
  std::size_t borders_above = 0;  ///< of them, those that say more than all their triangles
  std::size_t borders_below = 0;  ///< those that say 20 degrees less
  std::size_t rims = 0;           ///< looked at; none where theta is not known
  double low_rims_share = 0;  ///< of rims and curves, by length: rims of sheets that nothing sees at more than theta
  bool holds = false;         ///< shares are small
};

template <>
struct Description<AngleCheck> {
  static constexpr std::string_view name = "AngleCheck";
  static constexpr std::string_view doc = "Whether separation angles of triangles and edges are those of their places";
  static constexpr std::tuple members{
      Member{"triangles", &AngleCheck::triangles, "", "whose corners all see two walls"},
      Member{"below_share", &AngleCheck::below_share, "", "of their area: what says less than each corner sees"},
      Member{"samples", &AngleCheck::samples, "", "triangles that were looked at"},
      Member{"above_share", &AngleCheck::above_share, "", "of these: what says more than is seen within a voxel"},
      Member{"curve_samples", &AngleCheck::curve_samples, "", "edges of curves that were looked at"},
      Member{"curves_above_share", &AngleCheck::curves_above_share, "", "the same of these"},
      Member{"borders", &AngleCheck::borders, "", "rims and seams"},
      Member{"borders_above", &AngleCheck::borders_above, "", "of them, those that say more than all their triangles"},
      Member{"borders_below", &AngleCheck::borders_below, "", "those that say 20 degrees less"},
      Member{"rims", &AngleCheck::rims, "", "looked at; none where theta is not known"},
      Member{"low_rims_share", &AngleCheck::low_rims_share, "",
             "of rims and curves, by length: rims of sheets that nothing sees at more than theta"},
      Member{"holds", &AngleCheck::holds, "", "whether shares are small"},
  };
};

/// What to look at besides numbers of components, tunnels and voids: for files that do not hold everything.
struct CertificateOptions {
  /// Where vertices and edges lie. Without it, the Betti numbers of the whole solid and the whole axis are compared,
  /// and crossings of the mesh are not looked for.
  bool positions = true;
  bool radii = true;       ///< with positions
  bool footprints = true;  ///< with radii
  bool angles = true;      ///< of vertices, triangles and edges; with footprints
  bool sites = true;       ///< with footprints: a site that is none() is not looked at
  bool labels = true;      ///< roles of vertices and edges, and sheets; with positions
  bool balls = true;       ///< with radii: to measure what the balls fill
  bool medial = true;      ///< with positions and radii: whether it is in the middle; sheets and curves by their angles
  // What the axis says of itself, for the medial check; what is not known stays unset.
  std::optional<double> theta = {};      ///< degrees
  std::optional<double> lambda = {};     ///< mesh units
  std::optional<double> spacing = {};    ///< side of a voxel, mesh units
  std::optional<double> deviation = {};  ///< DecimatedAxis::deviation, mesh units
};

template <>
struct Description<CertificateOptions> {
  static constexpr std::string_view name = "CertificateOptions";
  static constexpr std::string_view doc =
      "What a certificate looks at besides numbers of components, tunnels and voids";
  static constexpr std::tuple members{
      Member{"positions", &CertificateOptions::positions, "", "where vertices and edges lie"},
      Member{"radii", &CertificateOptions::radii, "", "of vertices"},
      Member{"footprints", &CertificateOptions::footprints, "", "of vertices; with radii"},
      Member{"angles", &CertificateOptions::angles, "", "of vertices, triangles and edges; with footprints"},
      Member{"sites", &CertificateOptions::sites, "", "of vertices; with footprints"},
      Member{"labels", &CertificateOptions::labels, "", "roles and sheets; with positions"},
      Member{"balls", &CertificateOptions::balls, "", "what the balls fill; with radii"},
      Member{"medial", &CertificateOptions::medial, "", "whether it is in the middle of the solid; with radii"},
      Member{"theta", &CertificateOptions::theta, "degrees", "of the axis, as it says"},
      Member{"lambda", &CertificateOptions::lambda, "mesh units", "of the axis, as it says", Range::at_least(0)},
      Member{"spacing", &CertificateOptions::spacing, "mesh units", "side of its voxels, as it says",
             Range::positive()},
      Member{"deviation", &CertificateOptions::deviation, "mesh units",
             "how far vertices that were taken out moved it, as it says", Range::at_least(0)},
  };
};

struct Certificate {
  SolidRule against = SolidRule::polyhedron;
  CertificateOptions checked;
  BettiNumbers solid{};           ///< from its boundary, or its voxels: the sum of its bodies'
  BettiNumbers axis{};            ///< of the complex, by homology()
  std::optional<double> voxel;    ///< shortest side of those that the solid is made of, where it is, mesh units
  std::vector<BodyCheck> bodies;  ///< each must agree; one for the whole without CertificateOptions::positions
  bool topology_holds = false;
  GeometryCheck geometry;
  EdgeCheck edges;
  TriangleCheck triangles;
  LabelCheck labels;  ///< with CertificateOptions::labels
  AngleCheck angles;  ///< with CertificateOptions::angles
  HomologyCheck homology;
  BallUnionCheck balls;
  MedialCheck medial;
  std::vector<std::string> mismatches;  ///< one sentence each; empty where all holds

  [[nodiscard]] bool holds() const { return mismatches.empty(); }
};

template <>
struct Description<Certificate> {
  static constexpr std::string_view name = "Certificate";
  static constexpr std::string_view doc = "Whether an axis has the topology and the geometry of its solid";
  static constexpr std::tuple members{
      Member{"against", &Certificate::against, "", "what the solid is"},
      Member{"checked", &Certificate::checked, "", "what was looked at"},
      Member{"solid_betti", &Certificate::solid, "", "components, tunnels, voids of the solid: the sum of its bodies"},
      Member{"axis_betti", &Certificate::axis, "", "of the axis"},
      Member{"voxel", &Certificate::voxel, "mesh units", "shortest side of those that the solid is made of"},
      Member{"bodies", &Certificate::bodies, "",
             "each must agree; one for the whole where positions were not looked at"},
      Member{"topology_holds", &Certificate::topology_holds, "", "whether they all do"},
      Member{"geometry", &Certificate::geometry, "", "vertices"},
      Member{"edges", &Certificate::edges, "", "edges"},
      Member{"triangles", &Certificate::triangles, "", "triangles between their edges"},
      Member{"labels", &Certificate::labels, "", "roles and sheets"},
      Member{"angles", &Certificate::angles, "", "separation angles of triangles and edges"},
      Member{"homology", &Certificate::homology, "", "what the axis runs around"},
      Member{"balls", &Certificate::balls, "", "what the balls fill"},
      Member{"medial", &Certificate::medial, "", "whether it is in the middle, and all that is there"},
      Member{"mismatches", &Certificate::mismatches, "", "one sentence each; empty where all holds"},
      Fact{"holds", &Certificate::holds, "", "whether nothing differs"},
  };
};

/// What the solid of a mesh is: SolidRule::polyhedron where it is closed, manifold and has a single side, and where its
/// triangles neither cross nor, within one body, touch; also where resolve_crossings() makes such a mesh of it, with
/// the same inside; else SolidRule::winding.
struct MeshSolidRule {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;  ///< one sentence
};
template <>
struct Description<MeshSolidRule> {
  static constexpr std::string_view name = "MeshSolidRule";
  static constexpr std::string_view doc = "What the solid of a mesh is";
  static constexpr std::tuple members{
      Member{"rule", &MeshSolidRule::rule, "", "what its shells bound, or where its winding number is above 1/2"},
      Member{"reason", &MeshSolidRule::reason, "", "one sentence"},
  };
};

/// Found by the verifier's own reading of the mesh and find_self_intersections(); a mesh without its crossings is
/// taken from resolve_crossings(), and read in the same way. @throws InvalidMesh for what validate() refuses,
/// Cancelled.
[[nodiscard]] MeshSolidRule solid_rule(const MeshView& mesh, const Context& context = {});

/// Checks an axis against the closed, manifold mesh whose solid it is said to have. Nothing of the
/// construction is used: Betti numbers come from the homology of the surface and the nesting of its components by
/// counting crossings of lines; distances from a search of its own. Shells may face either way, and touch. Triangles
/// that name a vertex twice are left out. Where the mesh crosses itself, the solid is that of resolve_crossings().
///
/// Betti numbers are compared body by body: a connected part of the axis belongs to the body that its deepest vertex
/// lies in. That its loops and closed surfaces are around the tunnels and voids of that body is shown by linking
/// numbers (HomologyCheck).
/// @throws InvalidMesh where the mesh is not closed and manifold, or crosses itself, which is not resolved, or a shell
/// encloses nothing, or just what another one does; InvalidOption for a complex that is none (see homology()), or lacks
/// a column of MedialView; Cancelled. Cost: on one core about 2 s for 100,000 vertices and as many triangles.
[[nodiscard]] Certificate certify(const Complex& axis, const MeshView& mesh, const CertificateOptions& options = {},
                                  const Context& context = {});

/// The same against voxels whose closed union is the solid: of an image, with distances to their faces; or of a mesh
/// that is no polyhedron (SolidRule::winding), with distances to that mesh, where voxels_inside() makes them. The
/// voxels are taken as given: who makes them as the construction does shares its errors.
/// @param grid  of the voxels' centres.  @param surface  the mesh; nullptr for an image.
/// @throws InvalidGrid (also for a grid that does not cover the mesh), InvalidMesh, InvalidOption (also for a grid of
/// another size than the voxels, and where there are no voxels), Cancelled.
[[nodiscard]] Certificate certify(const Complex& axis, const VoxelSet& voxels, const GridSpec& grid,
                                  const MeshView* surface, const CertificateOptions& options = {},
                                  const Context& context = {});

/// Whether any complex, of a medial axis or not, has the topology of the solid of a mesh: what certify() checks of
/// places, without the columns of MedialView. Betti numbers agree body by body; vertices and edges lie in the solid.
/// @throws as certify().
[[nodiscard]] Certificate certify_topology(const Complex& complex, const MeshView& mesh, const Context& context = {});

/// The same against voxels, as certify() takes them.
[[nodiscard]] Certificate certify_topology(const Complex& complex, const VoxelSet& voxels, const GridSpec& grid,
                                           const MeshView* surface, const Context& context = {});

}  // namespace blum
