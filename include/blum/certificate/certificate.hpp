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

/// Result that a certificate proves about the topology of an axis. Each result includes the results before it.
enum class Proven : std::uint8_t {
  nothing,            ///< The Betti numbers of axis and solid differ, or positions were not checked.
  betti_numbers,      ///< In each body, the axis has as many components, tunnels and voids as the solid.
  homology_modulo_2,  ///< The inclusion of axis into solid is an isomorphism of homology over Z/2.
  homology,           ///< The inclusion of axis into solid is an isomorphism of homology over the integers.
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

/// Components, tunnels and voids of one body of the solid, and of the parts of the axis in that body.
struct BodyCheck {
  BettiNumbers solid{};
  BettiNumbers axis{};
  /// Number of tunnels that the axis's loops run around (rank modulo 2 of linking numbers).
  std::int64_t tunnels_met = 0;
  /// Number of voids that the axis's surfaces enclose (rank modulo 2 of winding numbers).
  std::int64_t voids_met = 0;
  Proven proven = Proven::nothing;
};

template <>
struct Description<BodyCheck> {
  static constexpr std::string_view name = "BodyCheck";
  static constexpr std::string_view doc = "Components, tunnels and voids of one body and of the axis in it";
  static constexpr std::tuple members{
      Member{"solid_betti", &BodyCheck::solid, "", "components, tunnels, voids of the body"},
      Member{"axis_betti", &BodyCheck::axis, "", "components, tunnels, voids of the parts of the axis in the body"},
      Member{"tunnels_met", &BodyCheck::tunnels_met, "",
             "number of tunnels that loops of the axis run around (rank modulo 2 of linking numbers)"},
      Member{"voids_met", &BodyCheck::voids_met, "",
             "number of voids that closed surfaces of the axis enclose (rank modulo 2 of winding numbers)"},
      Member{"proven", &BodyCheck::proven, "", "strongest proven agreement of the body and the axis in it"},
  };
};

/// Errors of the vertices of an axis. Distances are measured to the surface of the body that contains the vertex. If no
/// body contains the vertex, distances are measured to the surface of the closest body. The surface of a body consists
/// of its outer shell and the shells of its voids. The tolerance is the larger of two lengths: 1e-6 of the diagonal of
/// the body's box, and twice the rounding error of the body's coordinates. For the voxels of a mesh
/// (SolidRule::winding), a vertex is outside only if its distance from the voxels is more than a voxel's diagonal.
struct GeometryCheck {
  std::size_t vertices = 0;    ///< Number of checked vertices.
  std::size_t not_finite = 0;  ///< Vertices with a coordinate, radius, footprint or angle that is not finite.
  std::size_t outside = 0;     ///< Vertices outside the solid by more than the tolerance.
  /// Largest distance of a vertex from the solid, mesh units. For SolidRule::winding, the diagonal of a voxel is
  /// subtracted.
  double outside_by = 0;
  double radius_error = 0;           ///< Largest |radius - exact distance to the surface|, mesh units.
  double footprint_off_surface = 0;  ///< Largest distance of a footprint from the surface, mesh units.
  double footprint_error = 0;        ///< Largest |distance of vertex and footprint - radius|, mesh units.
  /// Largest distance of a footprint from its site (`site_0`, `site_1`), mesh units.
  double site_error = 0;
  double angle_error = 0;  ///< Largest |separation angle - angle between the footprints|, degrees.
  double tolerance = 0;    ///< Tolerance in the largest body, mesh units.
  bool holds = false;      ///< True if all vertices are finite, none is outside, and no error exceeds its
                           ///< tolerance.
};

template <>
struct Description<GeometryCheck> {
  static constexpr std::string_view name = "GeometryCheck";
  static constexpr std::string_view doc = "Check of the vertices of an axis, with the largest errors";
  static constexpr std::tuple members{
      Member{"vertices", &GeometryCheck::vertices, "", "number of checked vertices"},
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
      Member{"tolerance", &GeometryCheck::tolerance, "mesh units", "tolerance for distances in the largest body"},
      Member{"holds", &GeometryCheck::holds, "",
             "true if no vertex is outside the solid, and no error exceeds its tolerance"},
  };
};

/// Result of the check that the edges of an axis, and the sides of its triangles, lie in the solid between their ends.
/// If a point of the solid is at distance r from the surface, the ball of radius r around it lies in the solid. The
/// check covers each edge with such balls, so every point of the edge is checked.
///
/// An edge may cut a corner of its body if the edge can be pushed into the solid. A pushed edge may leave the body by
/// at most 1/64 of the diagonal of the body's box. For images, this limit is half the diagonal of a voxel if that is
/// larger. To push an edge, the check moves the edge's outermost point into the solid, through the closest point of the
/// surface. The two halves of the edge are then treated in the same way, until the whole edge lies in the solid. At
/// most 64 points are moved. Pushing fails for an edge across a gap, however narrow the gap is. If the solid consists
/// of the voxels of a mesh, the tolerance includes the diagonal of a voxel, and no edge is pushed.
struct EdgeCheck {
  std::size_t edges = 0;    ///< Checked edges, each counted once.
  std::size_t pushed = 0;   ///< Edges that cut a corner of their body, but can be pushed into it.
  double pushed_by = 0;     ///< Largest distance of a pushed edge from the solid, mesh units.
  std::size_t outside = 0;  ///< Edges that leave their body and cannot be pushed into it.
  /// Lower bound of the largest distance of the edges in `outside` from the body, mesh units.
  double outside_by = 0;
  Vec3d where;                ///< Point at the distance `outside_by`, mesh units.
  std::size_t across = 0;     ///< Edges that cross a gap of the body, but leave the body by at most the tolerance.
  Vec3d across_at;            ///< Position of the first crossing of a gap, mesh units.
  std::size_t undecided = 0;  ///< Edges that possibly cross a gap. If any exist, only Betti numbers are proven.
  double tolerance = 0;       ///< Ten times GeometryCheck::tolerance. SolidRule::winding adds a voxel's diagonal.
  bool holds = false;         ///< True if no edge is outside or crosses a gap.
};

template <>
struct Description<EdgeCheck> {
  static constexpr std::string_view name = "EdgeCheck";
  static constexpr std::string_view doc = "Check that edges lie in the solid between their ends";
  static constexpr std::tuple members{
      Member{"edges", &EdgeCheck::edges, "", "number of checked edges; each edge counts once"},
      Member{"pushed", &EdgeCheck::pushed, "", "edges that cut a corner, and can be pushed into the solid"},
      Member{"pushed_by", &EdgeCheck::pushed_by, "mesh units", "largest distance of a pushed edge from the solid"},
      Member{"outside", &EdgeCheck::outside, "", "edges that leave the solid and cannot be pushed into it"},
      Member{"outside_by", &EdgeCheck::outside_by, "mesh units",
             "lower bound of the largest distance from the solid, over the edges that cannot be pushed"},
      Member{"where", &EdgeCheck::where, "mesh units", "point at the distance outside_by"},
      Member{"across", &EdgeCheck::across, "",
             "edges that cross a gap of the solid, although they leave the solid only within the tolerance"},
      Member{"across_at", &EdgeCheck::across_at, "mesh units", "position of the first crossing of a gap"},
      Member{"undecided", &EdgeCheck::undecided, "",
             "edges that may cross a gap; if any exist, only Betti numbers are proven"},
      Member{"tolerance", &EdgeCheck::tolerance, "mesh units", "tolerance for the distance from the solid"},
      Member{"holds", &EdgeCheck::holds, "", "true if no edge is outside or crosses a gap"},
  };
};

/// Result of the check that the inclusion of an axis into its solid is an isomorphism of homology. Isomorphic homology
/// is a stronger result than equal Betti numbers. The check uses Alexander duality. Closed paths along the surface
/// generate the homology of the complement of the solid. The check computes the exact linking numbers of these paths
/// with loops of the axis. The check also computes the exact winding numbers of closed surfaces of the axis around
/// points in each void.
///
/// An axis fails the check if a loop runs around no tunnel. An axis also fails if two loops run around the same tunnel
/// while another tunnel has no loop around it. An axis also fails if a triangle spans a hole of the solid. The check
/// runs only if all Betti numbers agree, all vertices are finite, and all edges lie in the solid. If the solid consists
/// of voxels, only the numbers of tunnels and voids are compared.
struct HomologyCheck {
  std::size_t paths = 0;      ///< Closed paths along the surface with which linking numbers were computed.
  std::size_t triangles = 0;  ///< Triangles of the axis in bodies with tunnels.
  /// Triangles that span a hole of the solid, because the triangle's border is linked with one of the `paths`.
  std::size_t across = 0;
  Vec3d where;                      ///< Centroid of the first triangle across a hole, mesh units.
  std::size_t doubtful = 0;         ///< Edges that touch the surface, so that their linking numbers are undecided.
  Proven proven = Proven::nothing;  ///< Result that holds in every body.
  bool holds = false;  ///< True if the check ran and found no mismatch, even if it proved only a weak result.
  std::string shown;   ///< One sentence: the proven result, and why no stronger result is proven.
};

template <>
struct Description<HomologyCheck> {
  static constexpr std::string_view name = "HomologyCheck";
  static constexpr std::string_view doc =
      "Check that the inclusion of the axis into its solid is an isomorphism of homology";
  static constexpr std::tuple members{
      Member{"paths", &HomologyCheck::paths, "",
             "closed paths along the surface whose linking numbers with loops of the axis were computed"},
      Member{"triangles", &HomologyCheck::triangles, "", "triangles of the axis in bodies with tunnels"},
      Member{"across", &HomologyCheck::across, "", "triangles that span a hole of the solid"},
      Member{"where", &HomologyCheck::where, "mesh units", "centroid of the first triangle that spans a hole"},
      Member{"doubtful", &HomologyCheck::doubtful, "",
             "edges that touch the surface, so that their linking numbers are undecided"},
      Member{"proven", &HomologyCheck::proven, "", "strongest result that is proven in every body"},
      Member{"holds", &HomologyCheck::holds, "",
             "true if the check ran and nothing contradicts equal homology, even if little is proven"},
      Member{"shown", &HomologyCheck::shown, "",
             "the proven result, and the reason why nothing stronger is proven, in one sentence"},
  };
};

/// Distances between a solid and the balls of its axis. The certificate reports these distances, but sets no limit for
/// them. There is a ball around each vertex of the axis. Long edges and large triangles have further balls with
/// interpolated radii (see sample_axis()). The spacing of these further balls is 1/200 of the solid's diagonal. If the
/// square root of 1/50,000 of the axis's area is larger, this root is the spacing.
struct BallUnionCheck {
  /// Largest distance of a sample of the solid's surface from the union of the balls. The vertices of a mesh are among
  /// the samples. If the axis has no balls, the value is the diagonal of the solid.
  double solid_to_balls = 0;
  double mean_solid_to_balls = 0;  ///< Mean of the distance in `solid_to_balls` over the surface's area.
  /// Largest distance by which a ball around a vertex reaches out of the solid. For one ball, this distance is the
  /// radius minus the vertex's exact distance from the surface. The distance from the surface is negative if the vertex
  /// is outside the solid. If all radii are exact, `balls_beyond_solid` is 0.
  double balls_beyond_solid = 0;
  /// Largest distance of the surface of the union of the balls from the surface of the solid. The distance is measured
  /// at 32 points of each ball. If there are 3,125 balls or more, only every n-th ball is measured. The number n is
  /// chosen so that 1,563 to 3,125 balls are measured.
  double balls_to_surface = 0;
  /// Largest distance of a point of the surface from the closest sample, mesh units. For a mesh, the step is the
  /// smaller of two lengths: the median length of the axis's edges, and 1/256 of the solid's diagonal. The step is
  /// larger if this length would need more than 50,000 samples and more samples than the mesh has triangles. For
  /// voxels, each face between the solid and the background has one or four samples. If there are more than 250,000
  /// faces, each block of 4 x 4 x 4 voxels has one sample for each direction of faces.
  double step = 0;
};

template <>
struct Description<BallUnionCheck> {
  static constexpr std::string_view name = "BallUnionCheck";
  static constexpr std::string_view doc = "Distances between the solid and the balls of an axis; they have no limit";
  static constexpr std::tuple members{
      Member{"solid_to_balls", &BallUnionCheck::solid_to_balls, "mesh units",
             "largest distance of the solid's surface from the union of the balls"},
      Member{"mean_solid_to_balls", &BallUnionCheck::mean_solid_to_balls, "mesh units",
             "mean distance of the solid's surface from the union of the balls"},
      Member{"balls_beyond_solid", &BallUnionCheck::balls_beyond_solid, "mesh units",
             "largest distance by which balls reach out of the solid"},
      Member{"balls_to_surface", &BallUnionCheck::balls_to_surface, "mesh units",
             "largest distance of the union's surface from the solid's surface"},
      Member{"sample_step", &BallUnionCheck::step, "mesh units",
             "largest distance of a point of the surface from the closest sample"},
  };
};

/// Result of the check that an axis lies in the middle of its solid, and that no part of the axis is missing.
///
/// Judged cells are the triangles, and the edges of curves, whose separation angle in the axis is above theta. If the
/// solid consists of voxels, a theta below 40 degrees (image) or 20 degrees (mesh) is raised to this value. All other
/// cells exist only to preserve the homotopy type, and may lie anywhere in the solid.
///
/// The check uses sample points, which are the same in every run. There are at most 8,192 points of sheets, 2,048
/// points of curves, 4,096 vertices and 16,384 points of the solid. All small sheets together have up to 4,096 further
/// points. All bodies together have up to 32,768 further points.
///
/// The rules below measure lengths in voxels: one unit is the side of a voxel, as the axis reports it. If this side is
/// above an eighth of the solid's longest side, the unit is that eighth. If the axis reports no voxel side, the unit is
/// 1/32 of the diagonal of the solid. If the solid consists of voxels, the unit is at least half and at most the whole
/// diagonal of a voxel. The deviation that the axis reports (DecimatedAxis::deviation) is lowered to 1/64 of the
/// diagonal of the solid if it is larger.
///
/// The first rule judges how far the axis is from the middle between two walls (parts of the surface). At a point of
/// the axis, the ball that touches the closest wall is grown until it touches another wall. The distance of the point
/// from the middle is its distance from the bisector of the two walls. Touching points belong to one wall if the angle
/// between them, seen from the ball's centre, is below 10 degrees (images: 20).
///
/// Three limits apply to the distances of the points from the middle. For at least 95 % of the points, the distance
/// must be at most the allowance: 1.5 voxels plus the deviation. For at least 90 % of the points, the distance must
/// also be at most a quarter of the radius of the point's ball. For half of the points, the distance must be at most an
/// eighth of this radius, and at most `close_allowance`. The length `close_allowance` is a third of a voxel, or the
/// deviation plus a twelfth of a voxel if that is more.
///
/// Two rules raise the limits that depend on the radius. If a corner of the point's cell has a larger radius than the
/// ball, the radius of the corner is used. Flat cells cut off bends of the axis. So the radius limits are at least a
/// tenth of the cell's longest side, or a quarter of a voxel if that is less. If the solid consists of voxels, the
/// limits that depend on the radius do not apply.
///
/// Unless the solid consists of voxels, sheets are also judged one by one. At most half of the points of a sheet may be
/// further from the middle than the allowance. All sheets with at least 12 sample points are judged. Sheets with fewer
/// sample points are judged only if their area is at least 4 square voxels. The 341 largest sheets with few sample
/// points get 12 further points each; smaller sheets are not judged.
///
/// The second rule judges vertices with one footprint. Vertices of judged cells should have two footprints, but some
/// have only one, at ends of sheets and in thin walls. A vertex with one footprint must lie within the allowance from
/// the middle, and within a quarter of its ball's radius from the middle. A vertex is exempt if one of its judged cells
/// has a corner with a radius below one voxel. At most a tenth of the vertices of judged cells, or 16 vertices if that
/// is more, may exceed this limit.
///
/// A stricter limit applies to a vertex if one of its cells surely lies between two walls. The angles of this cell and
/// of its other corners are above theta and above 20 degrees (images: 40). Let d be the distance that is allowed
/// between the axis and the centre of a ball with the vertex's radius (see below). The distance of the vertex from the
/// middle must be at most 1.5 d. A third limit applies if the total area of the judged sheets is above 256 square
/// voxels. At most 60 % of the vertices with a radius above the allowance may then have only one footprint.
///
/// The third rule finds missing parts of the axis. Balls are grown from random points of the solid. In each body,
/// further balls are grown from points next to the body's surface. If the solid consists of voxels, the further balls
/// are grown from points in the body's box instead. If theta is unknown, missing parts are not checked.
///
/// A ball counts if it touches two walls at points at least lambda apart, and the angle between them, seen from its
/// centre, is large. The angle must be at least theta plus 30 degrees, or halfway from theta to 180 degrees if that is
/// less. In this rule, a theta below 10 degrees (images: 20) is raised to this value. If the distance between the two
/// points is below 4 voxels plus lambda, the angle must also be at least 80 degrees. In solids of voxels, balls whose
/// points are closer than this never count.
///
/// The distance of a ball's centre from the axis must be at most `missing_allowance`, which is 2 voxels plus the
/// deviation. Unless the solid consists of voxels, the distance must also be at most half of the ball's radius, or 2
/// voxels if that is more.
///
/// The limit must hold for 95 % of the balls from random points of the solid (voxels of a mesh: 90 %). The further
/// balls of single bodies count only if their angle is 80 degrees or more. In each body with 20 or more further balls
/// that count, the limit must hold for half of them. If more than 10 % of the further balls exceed the limit, it must
/// hold for 90 % of them in each body. Three balls may always exceed the limit.
///
/// If borders were fitted, parts thinner than a voxel are also judged by their own radius. A ball counts if its radius
/// is at most two thirds of a voxel, and its angle at least 150 degrees and `sought_angle`. No ball beside it may be
/// larger by more than 5 %. For all these balls except one, the axis must come within three radii of the centre. So the
/// rule finds missing ends of wires. These balls are also grown from vertices of the surface.
///
/// In polyhedra, the rule also finds single missing sheets. Here, walls are flat or smooth parts of the surface. A pair
/// of walls is judged if more than 8 balls touch both walls. More than 6 of these balls must have centres 2 voxels
/// apart. The separation angle of these balls is at least theta plus 10 degrees, or halfway from theta to 180 degrees
/// if that is less. The radius of these balls is above `missing_allowance`. Half of the balls must be next to a cell of
/// the axis between the two walls (docs/theory/certificate.md).
///
/// For the voxels of a mesh, the shares of points near the middle, and the stricter limit for vertices, are reported
/// but not judged.
struct MedialCheck {
  double allowance = 0;              ///< Largest accepted distance from the middle, mesh units.
  std::size_t one_wall = 0;          ///< Vertices with one footprint, or with two at an angle below 5 degrees.
  std::size_t claimed_vertices = 0;  ///< Vertices of judged cells.
  /// Vertices of judged cells with one footprint that exceed the limit for the distance from the middle, and are not
  /// exempt. If many vertices have one footprint, only a sample of them is examined.
  std::size_t one_wall_off = 0;
  std::size_t one_wall_far = 0;   ///< Vertices among `one_wall_off` that violate the stricter limit.
  Vec3d far_at;                   ///< Position of the first vertex of `one_wall_far`, mesh units.
  std::size_t deep_vertices = 0;  ///< Vertices of judged cells with a radius above the allowance.
  std::size_t deep_one_wall = 0;  ///< Vertices among `deep_vertices` with one footprint.
  /// Area of the triangles that are not judged, as a share of the area of all triangles.
  double homotopy_share = 0;
  std::size_t samples = 0;  ///< Examined points of sheets and curves.
  double medial_share = 1;  ///< Share of samples within the allowance, by area, with curves as strips one voxel wide.
  double near_share = 1;    ///< Share of samples within the allowance and a quarter of the ball's radius.
  double close_share = 1;   ///< Share of samples within `close_allowance` and an eighth of the ball's radius.
  double close_allowance = 0;     ///< A third of a voxel, or deviation plus a twelfth of a voxel if more, mesh units.
  double off_by = 0;              ///< Largest distance of a sample from the middle of two walls, mesh units.
  Vec3d off_at;                   ///< Position of the sample with the distance `off_by`, mesh units.
  std::size_t sheets_judged = 0;  ///< Sheets that were judged one by one; 0 if the solid consists of voxels.
  std::size_t sheets_off = 0;     ///< Judged sheets with more than half of their points outside the allowance.
  Vec3d sheet_off_at;       ///< Position of a point outside the allowance in the first of `sheets_off`, mesh units.
  double sought_angle = 0;  ///< Smallest angle of balls that count, degrees; 0 if missing parts were not checked.
  double missing_allowance = 0;     ///< Largest accepted distance of a ball's centre from the axis, mesh units.
  std::size_t balls = 0;            ///< Balls from random points of the solid that count.
  double missed_share = 0;          ///< Share of `balls` without a point of the axis near their centres.
  double missed_by = 0;             ///< Largest distance of the centre of one of `balls` from the axis, mesh units.
  Vec3d missed_at;                  ///< Centre of the ball at that distance, mesh units.
  std::size_t bodies_unseen = 0;    ///< Bodies that are not judged, because fewer than 20 balls count.
  std::size_t bodies_missed = 0;    ///< Judged bodies in which too many balls have no point of the axis nearby.
  double missed_share_of_body = 0;  ///< As `missed_share`, for the balls of the body with the largest share.
  /// Largest distance of a ball's centre from the axis in the body of `missed_share_of_body`, mesh units.
  double missed_in_body_by = 0;
  Vec3d missed_in_body_at;      ///< Centre of the ball at that distance, mesh units.
  std::size_t thin_balls = 0;   ///< Balls in the middle of parts thinner than a voxel; 0 if thin parts were not judged.
  std::size_t thin_missed = 0;  ///< Balls among `thin_balls` that are more than three of their radii from the axis.
  double thin_missed_by = 0;    ///< Largest distance of the centre of one of `thin_balls` from the axis, mesh units.
  Vec3d thin_missed_at;         ///< Centre of the ball at that distance, mesh units.
  std::size_t pairs_missed = 0;  ///< Pairs of walls between which a sheet is missing.
  Vec3d pair_missed_at;          ///< Centre of a missed ball of the first of `pairs_missed`, mesh units.
  bool judges_missing = false;   ///< True if at least 20 balls count, in the whole solid or in one body.
  bool holds = false;            ///< True if no judged limit is exceeded.
};

template <>
struct Description<MedialCheck> {
  static constexpr std::string_view name = "MedialCheck";
  static constexpr std::string_view doc =
      "Check that an axis lies midway between the walls of its solid, and that no part of the axis is missing";
  static constexpr std::tuple members{
      Member{"allowance", &MedialCheck::allowance, "mesh units",
             "largest accepted distance of a point of the axis from the middle of its two walls"},
      Member{"one_wall", &MedialCheck::one_wall, "",
             "vertices with one footprint, or with two at an angle below 5 degrees"},
      Member{"claimed_vertices", &MedialCheck::claimed_vertices, "",
             "vertices of judged cells: triangles and edges of curves with an angle above theta"},
      Member{"one_wall_off", &MedialCheck::one_wall_off, "",
             "vertices of judged cells with one footprint that are too far from the middle, and not next to a thin "
             "part (a sample if many)"},
      Member{"one_wall_far", &MedialCheck::one_wall_far, "",
             "vertices among one_wall_off that also violate a stricter limit"},
      Member{"far_at", &MedialCheck::far_at, "mesh units", "position of the first vertex of one_wall_far"},
      Member{"deep_vertices", &MedialCheck::deep_vertices, "",
             "vertices of judged cells with a radius above the allowance"},
      Member{"deep_one_wall", &MedialCheck::deep_one_wall, "", "vertices among deep_vertices with one footprint"},
      Member{"homotopy_share", &MedialCheck::homotopy_share, "",
             "share of the area of triangles that exist for homotopy alone, and are not judged"},
      Member{"samples", &MedialCheck::samples, "", "examined points of judged sheets and curves"},
      Member{"medial_share", &MedialCheck::medial_share, "",
             "share of the samples at most the allowance from the middle, by area"},
      Member{"near_share", &MedialCheck::near_share, "",
             "share of the samples that are also at most a quarter of the distance to the walls from the middle"},
      Member{
          "close_share", &MedialCheck::close_share, "",
          "share of the samples at most close_allowance, and an eighth of the distance to the walls, from the middle"},
      Member{"close_allowance", &MedialCheck::close_allowance, "mesh units",
             "a third of a voxel, or the deviation plus a twelfth of a voxel if that is more"},
      Member{"off_by", &MedialCheck::off_by, "mesh units", "largest distance of a sample from the middle"},
      Member{"off_at", &MedialCheck::off_at, "mesh units", "position of the sample at the distance off_by"},
      Member{"sheets_judged", &MedialCheck::sheets_judged, "", "sheets with enough samples to be judged one by one"},
      Member{"sheets_off", &MedialCheck::sheets_off, "",
             "judged sheets with more than half of their points outside the allowance"},
      Member{"sheet_off_at", &MedialCheck::sheet_off_at, "mesh units",
             "point outside the allowance in the first such sheet"},
      Member{"sought_angle", &MedialCheck::sought_angle, "degrees",
             "smallest angle of the medial balls that count; 0 if missing parts were not checked"},
      Member{"missing_allowance", &MedialCheck::missing_allowance, "mesh units",
             "largest accepted distance of a ball centre from the axis"},
      Member{"balls", &MedialCheck::balls, "",
             "medial balls from random points of the solid, with an angle of at least sought_angle"},
      Member{"missed_share", &MedialCheck::missed_share, "",
             "share of the counted balls without a point of the axis near their centre"},
      Member{"missed_by", &MedialCheck::missed_by, "mesh units",
             "largest distance of the centre of a counted ball from the axis"},
      Member{"missed_at", &MedialCheck::missed_at, "mesh units", "centre of the ball at the distance missed_by"},
      Member{"bodies_unseen", &MedialCheck::bodies_unseen, "",
             "bodies that are not judged, because too few balls from points near their surface count"},
      Member{"bodies_missed", &MedialCheck::bodies_missed, "",
             "judged bodies in which too many balls have no point of the axis near their centre"},
      Member{"missed_share_of_body", &MedialCheck::missed_share_of_body, "",
             "missed_share of the balls of one body, for the body where it is largest"},
      Member{"missed_in_body_by", &MedialCheck::missed_in_body_by, "mesh units",
             "largest distance of the centre of one of that body's balls from the axis"},
      Member{"missed_in_body_at", &MedialCheck::missed_in_body_at, "mesh units",
             "centre of the ball at the distance missed_in_body_by"},
      Member{"thin_balls", &MedialCheck::thin_balls, "", "balls in the middle of parts thinner than a voxel"},
      Member{"thin_missed", &MedialCheck::thin_missed, "",
             "balls among thin_balls that are more than three of their radii from the axis"},
      Member{"thin_missed_by", &MedialCheck::thin_missed_by, "mesh units",
             "largest distance of the centre of one of thin_balls from the axis"},
      Member{"thin_missed_at", &MedialCheck::thin_missed_at, "mesh units",
             "centre of the ball at the distance thin_missed_by"},
      Member{"pairs_missed", &MedialCheck::pairs_missed, "", "pairs of walls between which a sheet is missing"},
      Member{"pair_missed_at", &MedialCheck::pair_missed_at, "mesh units",
             "centre of a ball between the first such pair, where the axis is missing"},
      Member{"judges_missing", &MedialCheck::judges_missing, "", "true if enough balls count to judge missing parts"},
      Member{"holds", &MedialCheck::holds, "", "true if no limit is exceeded"},
  };
};

/// Result of the check that the triangles of an axis lie in the solid between their edges. If a point of the body is at
/// distance r from the surface, the ball of radius r around it lies in the body. If the balls around the corners of a
/// triangle do not cover it, the triangle is halved repeatedly. Halving ends when balls cover all parts of the
/// triangle, or a point of the triangle is found outside.
///
/// Triangles are flat, but the surface of the solid may be curved. So a triangle may leave the body by at most the
/// allowance. The allowance is the sum of the tolerance, the limit for edges that cut a corner (EdgeCheck), and the
/// deviation that the axis reports. All triangles that leave the body by more than the tolerance are counted in
/// `leaving`, also if the allowance permits it.
struct TriangleCheck {
  std::size_t triangles = 0;  ///< Checked triangles.
  std::size_t leaving = 0;    ///< Triangles that leave the body of their corners by more than the tolerance.
  std::size_t outside = 0;    ///< Triangles that leave the body by more than the allowance.
  double outside_by = 0;      ///< Largest distance of a point of triangles in `outside` from the body, mesh units.
  Vec3d where;                ///< Point at the distance `outside_by`, mesh units.
  /// Triangles in very thin walls for which 512 examined points give no decision. After 64 points, the examination ends
  /// if an estimate shows that 512 points would not suffice.
  std::size_t undecided = 0;
  double tolerance = 0;  ///< EdgeCheck::tolerance, mesh units.
  double allowance = 0;  ///< Allowance in the largest body, mesh units.
  bool holds = false;    ///< True if no triangle is outside.
};

template <>
struct Description<TriangleCheck> {
  static constexpr std::string_view name = "TriangleCheck";
  static constexpr std::string_view doc = "Check that triangles lie in the solid between their edges";
  static constexpr std::tuple members{
      Member{"triangles", &TriangleCheck::triangles, "", "number of checked triangles"},
      Member{"leaving", &TriangleCheck::leaving, "", "triangles that leave the solid by more than the tolerance"},
      Member{"outside", &TriangleCheck::outside, "", "triangles that leave the solid by more than the allowance"},
      Member{"outside_by", &TriangleCheck::outside_by, "mesh units",
             "largest distance from the solid, over the points of triangles that exceed the allowance"},
      Member{"where", &TriangleCheck::where, "mesh units", "point at the distance outside_by"},
      Member{"undecided", &TriangleCheck::undecided, "", "triangles in walls that are too thin for a decision"},
      Member{"tolerance", &TriangleCheck::tolerance, "mesh units", "tolerance of the check of edges"},
      Member{"allowance", &TriangleCheck::allowance, "mesh units",
             "largest accepted distance of a triangle from the solid"},
      Member{"holds", &TriangleCheck::holds, "", "true if no triangle is outside"},
  };
};

/// Result of the check that an axis lists and labels its cells as its triangles require. An edge of one triangle must
/// be listed as a rim, and an edge of three or more triangles as a seam. An edge without triangles must be listed as a
/// curve, and an edge of two triangles must not be listed. The role of a vertex must fit its edges and sheets
/// (MedialRole).
///
/// Sheets must be numbered from 0, without gaps. Each sheet must be connected through edges of exactly two triangles.
/// Two sheets may share an edge of exactly two triangles only if one end of the edge lies on a seam. At an edge with an
/// end on a seam, the axis may label the two triangles as one sheet or as two. No violation is accepted.
struct LabelCheck {
  std::size_t doubled = 0;       ///< Edges and triangles with the same vertices as another edge or triangle.
  std::size_t inner_listed = 0;  ///< Listed edges that belong to two triangles.
  std::size_t unlisted = 0;      ///< Edges of one triangle, or of three or more triangles, that are not listed.
  std::size_t edge_roles = 0;    ///< Edges with a wrong role.
  std::size_t vertex_roles = 0;  ///< Vertices with a wrong role.
  std::size_t sheets = 0;        ///< Number of sheets, by the labels of triangles.
  std::size_t gaps = 0;          ///< Unused sheet numbers below the largest sheet number.
  std::size_t torn = 0;          ///< Sheets that are not connected.
  std::size_t parted = 0;        ///< Edges between two sheets, if neither end of the edge lies on a seam.
  bool holds = false;            ///< True if nothing is wrong.
};

template <>
struct Description<LabelCheck> {
  static constexpr std::string_view name = "LabelCheck";
  static constexpr std::string_view doc = "Check that roles and sheets fit the triangles";
  static constexpr std::tuple members{
      Member{"doubled", &LabelCheck::doubled, "",
             "edges with the same vertices as another edge, and likewise triangles"},
      Member{"inner_listed", &LabelCheck::inner_listed, "", "listed edges that belong to exactly two triangles"},
      Member{"unlisted", &LabelCheck::unlisted, "", "edges of rims and seams that are not listed"},
      Member{"edge_roles", &LabelCheck::edge_roles, "", "edges with a wrong role"},
      Member{"vertex_roles", &LabelCheck::vertex_roles, "", "vertices with a wrong role"},
      Member{"sheets", &LabelCheck::sheets, "", "number of sheets, by the labels of triangles"},
      Member{"gaps", &LabelCheck::gaps, "", "unused sheet numbers below the largest sheet number"},
      Member{"torn", &LabelCheck::torn, "", "sheets that are not connected"},
      Member{"parted", &LabelCheck::parted, "", "edges between two sheets, if neither end of the edge lies on a seam"},
      Member{"holds", &LabelCheck::holds, "", "true if nothing is wrong"},
  };
};

/// Result of the check that the separation angles of triangles and edges fit their positions. The angle of a triangle
/// is the largest separation angle within half a voxel of the triangle. After decimation, it may also be the angle of a
/// removed triangle next to the remaining triangle. So the check does not judge single triangles. Limits on shares
/// apply only if at least 64 triangles or edges were examined. If the solid consists of voxels, of an image or a mesh,
/// `below_share`, `above_share` and `curves_above_share` are reported, but not judged.
struct AngleCheck {
  std::size_t triangles = 0;  ///< Triangles whose corners all have an angle of 10 degrees or more.
  /// Share of the area of `triangles` that belongs to triangles with an angle more than 10 degrees below the angles of
  /// all their corners. The largest accepted share is 0.8.
  double below_share = 0;
  std::size_t samples = 0;  ///< Sampled triangles.
  /// Share of the sampled triangles whose angle is more than 20 degrees above all angles found within one voxel of
  /// them. The largest accepted share is 0.2.
  double above_share = 0;
  std::size_t curve_samples = 0;  ///< Sampled edges of curves.
  /// Share of the sampled edges of curves whose angle is more than 20 degrees above all angles found within one voxel
  /// of them. The largest accepted share is 0.6.
  double curves_above_share = 0;
  std::size_t borders = 0;  ///< Edges of rims and seams.
  /// Edges of rims and seams with an angle above the angles of all their triangles. The largest accepted number is 0.
  std::size_t borders_above = 0;
  /// Edges of rims and seams with an angle more than 20 degrees below the largest angle of their triangles. At most
  /// half of `borders` are accepted.
  std::size_t borders_below = 0;
  std::size_t rims = 0;  ///< Examined edges of rims; 0 if theta is unknown.
  /// Length of the rims of sheets without an angle above theta, as a share of the length of all rims and curves. The
  /// largest accepted share is 0.25.
  double low_rims_share = 0;
  bool holds = false;  ///< True if no judged limit is exceeded.
};

template <>
struct Description<AngleCheck> {
  static constexpr std::string_view name = "AngleCheck";
  static constexpr std::string_view doc = "Check that separation angles of triangles and edges fit their positions";
  static constexpr std::tuple members{
      Member{"triangles", &AngleCheck::triangles, "",
             "triangles whose corners all have an angle of 10 degrees or more"},
      Member{"below_share", &AngleCheck::below_share, "",
             "share of the area of the counted triangles that belongs to triangles with a smaller angle than each of "
             "their corners"},
      Member{"samples", &AngleCheck::samples, "", "sampled triangles"},
      Member{"above_share", &AngleCheck::above_share, "",
             "share of the sampled triangles with a larger angle than any angle found within a voxel"},
      Member{"curve_samples", &AngleCheck::curve_samples, "", "sampled edges of curves"},
      Member{"curves_above_share", &AngleCheck::curves_above_share, "",
             "share of the sampled edges of curves with a larger angle than any angle found within a voxel"},
      Member{"borders", &AngleCheck::borders, "", "edges of rims and seams"},
      Member{"borders_above", &AngleCheck::borders_above, "",
             "edges of rims and seams with a larger angle than each of their triangles"},
      Member{"borders_below", &AngleCheck::borders_below, "",
             "edges of rims and seams with an angle more than 20 degrees below the largest angle of their triangles"},
      Member{"rims", &AngleCheck::rims, "", "examined edges of rims; 0 if theta is unknown"},
      Member{
          "low_rims_share", &AngleCheck::low_rims_share, "",
          "length of the rims of sheets without an angle above theta, as a share of the length of all rims and curves"},
      Member{"holds", &AngleCheck::holds, "", "true if no limit is exceeded"},
  };
};

/// Result of the check of sheets against the walls of a polyhedron (docs/theory/certificate.md). A part of a sheet is
/// large if it has at least 4 square voxels and 8 triangles. Two triangles belong to one part if the edge between them
/// bends by less than 45 degrees, or does not touch a seam. All large parts of a sheet must lie between the same pair
/// of walls. At most 5 % of `vertices`, or 3 vertices if that is more, may be `wrong`. In files with columns of
/// patches, each pair of sites, and each sheet of patches, must have one pair of patches.
struct SheetCheck {
  std::size_t sheets = 0;     ///< Sheets with two large parts that are connected only through edges next to seams.
  std::size_t two_pairs = 0;  ///< Sheets among `sheets` between two pairs of walls; the largest accepted number is 0.
  Vec3d two_pairs_at;         ///< Point in the first of `two_pairs`, mesh units.
  std::size_t vertices = 0;   ///< Vertices inside the part of a sheet for which the file states one pair of sites.
  std::size_t wrong = 0;      ///< Vertices among `vertices` with a footprint on neither of the two sites.
  Vec3d wrong_at;             ///< Position of the first of `wrong`, mesh units.
  bool holds = false;         ///< True if no limit is exceeded.
};

template <>
struct Description<SheetCheck> {
  static constexpr std::string_view name = "SheetCheck";
  static constexpr std::string_view doc = "Check that sheets lie between single pairs of walls";
  static constexpr std::tuple members{
      Member{"sheets", &SheetCheck::sheets, "", "sheets with two large parts that only edges next to seams join"},
      Member{"two_pairs", &SheetCheck::two_pairs, "", "such sheets that lie between two pairs of walls"},
      Member{"two_pairs_at", &SheetCheck::two_pairs_at, "mesh units", "point in the first sheet of two pairs of walls"},
      Member{"vertices", &SheetCheck::vertices, "",
             "vertices inside a part of a sheet for which the file states one pair of sites"},
      Member{"wrong", &SheetCheck::wrong, "", "such vertices with a footprint on neither of these sites"},
      Member{"wrong_at", &SheetCheck::wrong_at, "mesh units", "position of the first such vertex"},
      Member{"holds", &SheetCheck::holds, "", "true if no limit is exceeded"},
  };
};

/// Parts that a certificate checks besides the numbers of components, tunnels and voids. Switch a part off if the file
/// of the axis lacks its data. If a part is off, the parts that need it are not checked either.
struct CertificateOptions {
  /// Positions of vertices and edges. If positions are off, only the Betti numbers of the whole solid and the whole
  /// axis are compared.
  bool positions = true;
  bool radii = true;       ///< Needs positions.
  bool footprints = true;  ///< Needs radii.
  bool angles = true;      ///< Angles of vertices, triangles and edges. Needs footprints.
  bool sites = true;       ///< Needs footprints. Sites that are none() are not checked.
  bool labels = true;      ///< Roles of vertices and edges, and sheets. Needs positions.
  bool balls = true;       ///< BallUnionCheck. Needs radii.
  bool medial = true;      ///< MedialCheck. Needs radii; sheets and curves are judged only with `angles`.
  // Parameters that the axis reports; unset if unknown. The checks of angles, triangles and the middle use them.
  std::optional<double> theta = {};      ///< Smallest separation angle of the axis, degrees.
  std::optional<double> lambda = {};     ///< Mesh units.
  std::optional<double> spacing = {};    ///< Side of a voxel, mesh units.
  std::optional<double> deviation = {};  ///< DecimatedAxis::deviation, mesh units.
  /// True if borders were fitted to the surface (MedialAxis::fitted(), lean()). If true, MedialCheck judges parts
  /// thinner than a voxel by their radius. If false, the axis may stop two voxels short of its exact border.
  bool fitted = false;
};

template <>
struct Description<CertificateOptions> {
  static constexpr std::string_view name = "CertificateOptions";
  static constexpr std::string_view doc =
      "Parts that a certificate checks, besides the numbers of components, tunnels and voids";
  static constexpr std::tuple members{
      Member{"positions", &CertificateOptions::positions, "", "positions of vertices and edges"},
      Member{"radii", &CertificateOptions::radii, "", "radii of vertices"},
      Member{"footprints", &CertificateOptions::footprints, "", "footprints of vertices; needs radii"},
      Member{"angles", &CertificateOptions::angles, "", "angles of vertices, triangles and edges; needs footprints"},
      Member{"sites", &CertificateOptions::sites, "", "sites of vertices; needs footprints"},
      Member{"labels", &CertificateOptions::labels, "", "roles and sheets; needs positions"},
      Member{"balls", &CertificateOptions::balls, "", "distances between solid and balls; needs radii"},
      Member{"medial", &CertificateOptions::medial, "",
             "distances of the axis from the middle between walls, and missing parts; needs radii"},
      Member{"theta", &CertificateOptions::theta, "degrees", "theta that the axis reports"},
      Member{"lambda", &CertificateOptions::lambda, "mesh units", "lambda that the axis reports", Range::at_least(0)},
      Member{"spacing", &CertificateOptions::spacing, "mesh units", "side of a voxel that the axis reports",
             Range::positive()},
      Member{"deviation", &CertificateOptions::deviation, "mesh units",
             "largest change by removed vertices that the axis reports", Range::at_least(0)},
      Member{"fitted", &CertificateOptions::fitted, "", "true if the axis reports that its borders were fitted"},
  };
};

struct Certificate {
  SolidRule against = SolidRule::polyhedron;
  CertificateOptions checked;
  BettiNumbers solid{};         ///< Sum over all bodies, computed from the solid's boundary or voxels.
  BettiNumbers axis{};          ///< Betti numbers of the complex, by homology().
  std::optional<double> voxel;  ///< Shortest side of a voxel, mesh units; unset unless the solid consists of voxels.
  /// One check for each body. Without CertificateOptions::positions, one check for the whole solid.
  std::vector<BodyCheck> bodies;
  bool topology_holds = false;
  GeometryCheck geometry;
  EdgeCheck edges;
  TriangleCheck triangles;
  LabelCheck labels;  ///< Computed if CertificateOptions::labels is true.
  SheetCheck sheets;  ///< Computed for polyhedra.
  AngleCheck angles;  ///< Computed if CertificateOptions::angles is true.
  HomologyCheck homology;
  BallUnionCheck balls;
  MedialCheck medial;
  std::vector<std::string> mismatches;  ///< One sentence per mismatch; empty if all checks hold.

  [[nodiscard]] bool holds() const { return mismatches.empty(); }
};

template <>
struct Description<Certificate> {
  static constexpr std::string_view name = "Certificate";
  static constexpr std::string_view doc =
      "Result of checking the topology and the geometry of an axis against its solid";
  static constexpr std::tuple members{
      Member{"against", &Certificate::against, "", "rule that defines the solid"},
      Member{"checked", &Certificate::checked, "", "checked parts"},
      Member{"solid_betti", &Certificate::solid, "", "components, tunnels, voids of the solid: the sum of its bodies"},
      Member{"axis_betti", &Certificate::axis, "", "components, tunnels, voids of the axis"},
      Member{"voxel", &Certificate::voxel, "mesh units", "shortest side of a voxel if the solid is made of voxels"},
      Member{
          "bodies", &Certificate::bodies, "",
          "one check for each body, and all must agree; one check for the whole solid if positions were not checked"},
      Member{"topology_holds", &Certificate::topology_holds, "",
             "true if components, tunnels and voids agree in all bodies"},
      Member{"geometry", &Certificate::geometry, "", "check of the vertices"},
      Member{"edges", &Certificate::edges, "", "check of the edges"},
      Member{"triangles", &Certificate::triangles, "", "check of the triangles between their edges"},
      Member{"labels", &Certificate::labels, "", "check of roles and sheets"},
      Member{"sheets", &Certificate::sheets, "", "check of sheets against the walls of the solid"},
      Member{"angles", &Certificate::angles, "", "check of the separation angles of triangles and edges"},
      Member{"homology", &Certificate::homology, "", "check of tunnels and voids"},
      Member{"balls", &Certificate::balls, "", "distances between solid and balls"},
      Member{"medial", &Certificate::medial, "", "check of the middle between walls, and of missing parts"},
      Member{"mismatches", &Certificate::mismatches, "", "one sentence for each mismatch; empty if all holds"},
      Fact{"holds", &Certificate::holds, "", "true if there is no mismatch"},
  };
};

/// Rule that defines the solid of a mesh. The rule is SolidRule::polyhedron if the mesh is closed, manifold and
/// orientable, and its triangles do not cross. Triangles of one body must not touch each other either, except at shared
/// edges and vertices. The rule is also SolidRule::polyhedron if resolve_crossings() turns the mesh into such a mesh,
/// and this mesh bounds the same solid. The rule of all other meshes is SolidRule::winding.
struct MeshSolidRule {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;  ///< Reason for the rule, one sentence.
};
template <>
struct Description<MeshSolidRule> {
  static constexpr std::string_view name = "MeshSolidRule";
  static constexpr std::string_view doc = "Rule that defines the solid of a mesh";
  static constexpr std::tuple members{
      Member{"rule", &MeshSolidRule::rule, "", "volume bounded by the shells, or winding number above 1/2"},
      Member{"reason", &MeshSolidRule::reason, "", "reason for this rule, in one sentence"},
  };
};

/// Returns the rule that defines the solid of a mesh. The verifier analyses the mesh with its own code and
/// find_self_intersections(). If the mesh crosses itself, the verifier analyses the result of resolve_crossings() in
/// the same way.
/// @throws InvalidMesh if validate() rejects the mesh; Cancelled.
[[nodiscard]] MeshSolidRule solid_rule(const MeshView& mesh, const Context& context = {});

/// Checks an axis against the solid that a closed, manifold mesh bounds.
///
/// The check uses no field, no voxels and no record of the construction. The Betti numbers of the solid follow from the
/// homology of its shells and their nesting. The nesting of the shells is found by counting how often lines cross them.
/// The verifier has its own code for distances. Verifier and construction share four parts: the search for crossings of
/// triangles, the resolution of crossings, signs of determinants and the numbering of sites. Shells may face either
/// way, and may touch each other. Triangles with the same vertex twice are ignored. If the mesh crosses itself, the
/// result of resolve_crossings() bounds the solid.
///
/// Betti numbers are compared body by body. A connected part of the axis belongs to the body that contains its deepest
/// vertex. Linking and winding numbers prove that loops and closed surfaces of the axis go around the tunnels and voids
/// of their body (HomologyCheck).
/// @throws InvalidMesh if the mesh is not closed and manifold, or if it has crossings that resolve_crossings() cannot
/// resolve. InvalidMesh is also thrown if a shell encloses no volume, or exactly the same volume as another shell.
/// InvalidOption if the complex is invalid (see homology()) or lacks a column of MedialView; Cancelled.
/// Cost: about 2 s on one core for an axis with 100,000 vertices and a mesh with 100,000 triangles.
[[nodiscard]] Certificate certify(const Complex& axis, const MeshView& mesh, const CertificateOptions& options = {},
                                  const Context& context = {});

/// Checks an axis against the closed union of voxels. If `surface` is nullptr, the voxels are those of an image, and
/// distances are measured to their faces. If `surface` is a mesh, the voxels represent this mesh, which is not a
/// polyhedron (SolidRule::winding). Distances are then measured to the mesh. The function voxels_inside() computes the
/// voxels of a mesh. The function uses the voxels as given. If the voxels that the axis was made from are wrong, and
/// the same voxels are passed here, the function does not detect the error.
/// @param grid  grid whose nodes are the centres of the voxels.
/// @param surface  mesh that the voxels represent; nullptr for an image.
/// @throws InvalidGrid, also if the grid does not cover the mesh. InvalidMesh. InvalidOption, also if the sizes of the
/// grid and the voxels differ, or no voxel exists. Cancelled.
[[nodiscard]] Certificate certify(const Complex& axis, const VoxelSet& voxels, const GridSpec& grid,
                                  const MeshView* surface, const CertificateOptions& options = {},
                                  const Context& context = {});

/// Checks whether a complex has the topology of the solid of a mesh. The complex need not be a medial axis, and needs
/// no columns. The function performs those checks of certify() that need only positions. Betti numbers must agree body
/// by body, and vertices, edges and triangles must lie in the solid.
/// @throws as certify().
[[nodiscard]] Certificate certify_topology(const Complex& complex, const MeshView& mesh, const Context& context = {});

/// Checks the topology of a complex against voxels. `voxels`, `grid` and `surface` are as in certify() for voxels.
[[nodiscard]] Certificate certify_topology(const Complex& complex, const VoxelSet& voxels, const GridSpec& grid,
                                           const MeshView* surface, const Context& context = {});

}  // namespace blum
