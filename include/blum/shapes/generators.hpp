// Blum: shapes for tests, demonstrations and first steps. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

/// Lengths are in mesh units and at most 1e100, angles in degrees. Unless stated otherwise, a shape is centred at the
/// origin, and bounds a solid. Its mesh is a closed manifold without self-intersections, consistently oriented, and
/// faces away from the solid. ShapeInfo::betti gives its topology. The same options give the same mesh on every
/// platform, except for the last bits of sines and cosines.
///
/// All functions throw InvalidOption if options contradict each other or the ranges given here. They also throw
/// InvalidOption if the mesh would have more than 50 million triangles. Cost: O(triangles), unless stated otherwise.
namespace blum {

// ---- Round shapes (generators_round.cpp) ----

struct SphereOptions {
  double radius = 1;   ///< > 0
  int frequency = 16;  ///< number of parts of each edge of an icosahedron, >= 1; makes 20 * frequency^2 triangles
};
/// Makes a sphere of nearly equal triangles from a subdivided icosahedron. Its vertices lie on the sphere.
[[nodiscard]] TriangleMesh make_sphere(const SphereOptions& options = {});

struct EllipsoidOptions {
  Vec3d radii{1, 0.6, 0.3};  ///< half axes along x, y, z, > 0
  int frequency = 16;        ///< see SphereOptions
};
[[nodiscard]] TriangleMesh make_ellipsoid(const EllipsoidOptions& options = {});

struct UvSphereOptions {
  double radius = 1;    ///< > 0
  int longitudes = 48;  ///< >= 3
  int latitudes = 24;   ///< number of bands from pole to pole, >= 2
};
/// Makes a sphere of longitudes and latitudes. The mesh has needle-shaped triangles at the poles, and rings of vertices
/// on common circles.
[[nodiscard]] TriangleMesh make_uv_sphere(const UvSphereOptions& options = {});

struct CylinderOptions {
  double radius = 0.5;  ///< > 0
  double height = 1;    ///< along z, > 0
  int sides = 48;       ///< >= 3
  int stacks = 1;       ///< number of bands along the height, >= 1
};
[[nodiscard]] TriangleMesh make_cylinder(const CylinderOptions& options = {});

struct TorusOptions {
  double ring_radius = 1;    ///< radius of the tube's centre line, in the xy plane, > 0
  double tube_radius = 0.3;  ///< radius of the tube, > 0, below ring_radius
  int ring_segments = 96;    ///< >= 3
  int tube_segments = 32;    ///< >= 3
};
[[nodiscard]] TriangleMesh make_torus(const TorusOptions& options = {});

struct TorusKnotOptions {
  int p = 2;               ///< number of turns around the axis of the torus, 1 to 20
  int q = 3;               ///< number of turns around the tube of the torus, 1 to 20; must have no common factor with p
  double ring_radius = 1;  ///< ring radius of the torus on which the knot's centre line lies, > 0
  double wind_radius = 0.4;   ///< tube radius of that torus, > 0, below ring_radius
  double tube_radius = 0.15;  ///< radius of the knot's own tube, > 0
  int curve_segments = 400;   ///< >= 16 * max(p, q)
  int tube_segments = 24;     ///< >= 3
};
/// Makes a tube around the (p, q) torus knot. Throws InvalidOption if the tube would touch itself: the distance between
/// strands and the curvature of the centre line are measured.
[[nodiscard]] TriangleMesh make_torus_knot(const TorusKnotOptions& options = {});

struct LinkedToriOptions {
  int count = 2;             ///< number of rings, 1 to 1000
  double ring_radius = 1;    ///< > 0
  double tube_radius = 0.2;  ///< > 0, below ring_radius / 3 so that rings do not touch
  int ring_segments = 96;    ///< >= 8
  int tube_segments = 32;    ///< >= 3
};
/// Makes a chain of tori along x. Each torus passes through the next torus.
[[nodiscard]] TriangleMesh make_linked_tori(const LinkedToriOptions& options = {});

struct RidgedRodOptions {
  double length = 4;            ///< along z, > 0
  double radius = 0.5;          ///< mean radius, > 0
  double ridge_height = 0.1;    ///< half the difference between largest and smallest radius, >= 0, below radius
  int ridges = 12;              ///< number of ridges along the length, >= 0
  int sides = 48;               ///< >= 3
  int segments_per_ridge = 12;  ///< >= 4
};
/// Makes a rod with flat ends, whose radius varies along its length like a cosine.
[[nodiscard]] TriangleMesh make_ridged_rod(const RidgedRodOptions& options = {});

struct SpoonOptions {
  double length = 6;           ///< along x, > 0
  double bowl_width = 1.4;     ///< along y, > 0, at most length / 3
  double bowl_depth = 0.4;     ///< > 0, at most bowl_width
  double handle_width = 0.35;  ///< > 0, at most bowl_width
  double thickness = 0.12;     ///< thickness of bowl and handle, > 0, at most handle_width
  int stations = 160;          ///< number of intervals along the length, from cross-section to cross-section, >= 16
  int sides = 40;              ///< number of points around each cross-section, even, >= 8
};
/// Makes a spoon-like solid: a thin bowl and a bent handle.
[[nodiscard]] TriangleMesh make_spoon(const SpoonOptions& options = {});

struct OrganicOptions {
  double radius = 1;      ///< typical radius, > 0
  int frequency = 59;     ///< see SphereOptions; 59 gives 69,620 triangles
  double detail = 0.006;  ///< amplitude of the finest bumps, as a fraction of `radius`, 0 to 0.05
  int holes = 0;          ///< number of holes, 0 to 12; above 0, the surface is open, and frequency must be >= 8
  std::uint64_t seed = 1;
};
/// Makes an animal-like body (ears, paws, tail, rough skin), star-shaped about the origin. Its size and roughness are
/// those of a scanned model. With holes, the body is an open surface, like a scan. Vertices inside the holes stay in
/// the mesh, although no triangle uses them.
[[nodiscard]] TriangleMesh make_organic(const OrganicOptions& options = {});

// ---- Machined shapes (generators_cad.cpp, generators_blocks.cpp) ----

struct BoxOptions {
  Vec3d size{1, 1, 1};                   ///< sides along x, y, z, > 0
  std::array<int, 3> segments{1, 1, 1};  ///< number of parts along x, y, z, >= 1
};
[[nodiscard]] TriangleMesh make_box(const BoxOptions& options = {});

struct WedgeOptions {
  double angle = 30;  ///< between the two large faces, degrees, 0 < angle < 180
  double length = 1;  ///< length of the two large faces, from the sharp edge, > 0
  double width = 1;   ///< length of the sharp edge, along y, > 0
};
/// Makes a triangular prism. Its sharp edge lies on the y axis, and its large faces open towards +x.
[[nodiscard]] TriangleMesh make_wedge(const WedgeOptions& options = {});

struct VoidCubeOptions {
  double size = 1;           ///< side of the cube, > 0
  double void_radius = 0.3;  ///< > 0, below size / 2
  int segments = 8;          ///< number of parts along each edge of the cube, >= 1
  int frequency = 12;        ///< frequency of the spherical void; see SphereOptions
};
/// Makes a cube with a spherical void in its centre. The surface has two shells.
[[nodiscard]] TriangleMesh make_void_cube(const VoidCubeOptions& options = {});

struct NestedShellsOptions {
  int shells = 3;     ///< number of spheres, 1 to 1000
  double radius = 1;  ///< radius of the outermost sphere, > 0; radii decrease inwards in equal steps
  int frequency = 8;  ///< see SphereOptions
};
/// Makes nested spheres that face outwards and inwards alternately: from outside to inside solid, void, solid, ...
[[nodiscard]] TriangleMesh make_nested_shells(const NestedShellsOptions& options = {});

struct BodiesOptions {
  int count = 27;      ///< number of bodies, >= 1
  double size = 0.5;   ///< side or diameter of each body, > 0, and above 1e-12 of the side of the lattice
  double spacing = 1;  ///< distance between neighbouring centres, > size
  int frequency = 0;   ///< 0: bodies are boxes of 12 triangles; otherwise spheres, see SphereOptions
};
/// Makes `count` separate equal bodies on the smallest cubic lattice that has room for all of them.
[[nodiscard]] TriangleMesh make_bodies(const BodiesOptions& options = {});

struct PlateOptions {
  int holes_x = 3;   ///< number of holes along x, >= 0
  int holes_y = 2;   ///< number of holes along y, >= 0; the genus is holes_x * holes_y
  double pitch = 1;  ///< distance between centres of holes, > 0; the plate has a square of this side for each hole
  double hole_radius = 0.3;  ///< > 0, below pitch / 2
  double thickness = 0.25;   ///< along z, > 0
  int hole_segments = 32;    ///< sides of each hole, >= 4, a multiple of 4
};
/// Makes a plate with a row or grid of round holes through it. If holes_x or holes_y is 0, the plate is a square of
/// side `pitch` without holes.
[[nodiscard]] TriangleMesh make_plate(const PlateOptions& options = {});

struct BracketOptions {
  double length = 3;         ///< length of the foot, along x, > 0
  double height = 3;         ///< height of the wall, along z, > 0
  double width = 3;          ///< along y, > 0
  double thickness = 0.4;    ///< thickness of foot and wall, > 0, below half of length and half of height
  int holes = 2;             ///< number of holes in the foot, and in the wall, 0 to 10,000; the genus is 2 * holes
  double hole_radius = 0.3;  ///< > 0; holes must fit between the ribs and the borders of foot and wall
  bool ribs = true;          ///< true: triangular ribs between foot and wall, at both sides and between holes
  int hole_segments = 32;    ///< sides of each hole, >= 4, a multiple of 4
};
/// Makes an L-shaped bracket with holes and ribs, in the box [0, length] x [0, width] x [0, height]. The edge where the
/// outer faces of foot and wall meet lies on the y axis.
[[nodiscard]] TriangleMesh make_bracket(const BracketOptions& options = {});

struct GearOptions {
  int teeth = 20;             ///< number of teeth, 4 to 2000
  double root_radius = 0.85;  ///< radius of the outline between teeth, > 0
  double tip_radius = 1;      ///< radius of the outline at teeth, > root_radius
  double bore_radius = 0.2;   ///< radius of the bore (central hole), >= 0, below root_radius; 0: no bore
  /// number of round holes between bore and teeth, 0 to 1000. The genus is openings + (bore ? 1 : 0).
  int openings = 5;
  /// radius of openings, > 0. Openings lie halfway between bore_radius and root_radius, and must not touch.
  double opening_radius = 0.13;
  double thickness = 0.3;  ///< along z, > 0
  int hole_segments = 32;  ///< number of sides of each hole, >= 3
};
/// Makes a spur gear or drive wheel: an extruded toothed outline with a bore and lightening holes.
/// Cost: O(n^2) in the number of outline points.
[[nodiscard]] TriangleMesh make_gear(const GearOptions& options = {});

/// Point of a polygon.
using Point2 = std::array<double, 2>;
struct ExtrusionOptions {
  double thickness = 1;  ///< along z, > 0
  int stacks = 1;        ///< number of bands along the thickness, >= 1
};
/// Extrudes a polygon with holes along z, from -thickness / 2 to thickness / 2.
/// @param outline  simple polygon with at least three corners, clockwise or counterclockwise.
/// @param holes    simple polygons inside the outline, clockwise or counterclockwise. They touch neither the outline
///                 nor each other.
/// @throws InvalidOption also if the outline or holes cross or touch; Cancelled.
/// Cost: O(n^2) in the number of points, of which at most 20,000 are allowed.
[[nodiscard]] TriangleMesh make_extrusion(std::span<const Point2> outline, std::span<const std::vector<Point2>> holes,
                                          const ExtrusionOptions& options = {}, const Context& context = {});

struct StarOptions {
  int spikes = 5;             ///< number of spikes, 2 to 10,000
  double outer_radius = 1;    ///< radius at the spikes, > 0
  double inner_radius = 0.4;  ///< radius between spikes, > 0, below outer_radius
  double thickness = 0.3;     ///< along z, > 0
};
/// Makes an extruded star, with sharp convex and reflex edges.
[[nodiscard]] TriangleMesh make_star(const StarOptions& options = {});

struct MengerOptions {
  int level = 2;    ///< number of subdivisions, 0 to 5; the sponge consists of 20^level cubes
  double size = 1;  ///< side of the whole sponge, > 0
};
/// Makes the boundary of the Menger sponge. The boundary is a manifold: no two cubes of the sponge touch only along an
/// edge or in a corner.
[[nodiscard]] TriangleMesh make_menger(const MengerOptions& options = {});

struct FanPartOptions {
  double size = 1;     ///< size of the whole part, > 0
  int resolution = 8;  ///< number of parts along each side of the smallest block, >= 1; 8 gives 12,288 triangles
};
/// Makes a sector of a fan. Its curved and flat faces meet in sharp edges, as in CAD models. Some edges are convex,
/// some concave, and some become smooth along their length.
[[nodiscard]] TriangleMesh make_fan_part(const FanPartOptions& options = {});

// ---- Soups, and meshes from meshes (generators_soup.cpp) ----

struct SoupOptions {
  std::size_t triangles = 100;  ///< number of triangles, >= 1
  double size = 1;              ///< side of the cube in which random centres lie, > 0
  double triangle_size = 0.2;   ///< largest distance of a corner from its triangle's centre, > 0
  /// Fraction of the triangles that are awkward, 0 to 1. Five kinds are equally probable: needles, slivers, copies of
  /// earlier triangles (unchanged or reversed), triangles on one common plane, degenerate triangles (points, segments).
  double awkward = 0;
  std::uint64_t seed = 1;
};
/// Makes loose random triangles, each with its own three vertices. The triangles bound no solid.
[[nodiscard]] TriangleMesh make_soup(const SoupOptions& options = {});

struct SegmentsOptions {
  std::size_t segments = 100;  ///< number of segments, >= 1
  double size = 1;             ///< side of the cube in which random centres lie, > 0
  double segment_size = 0.2;   ///< largest distance of an end from its segment's centre, > 0
  std::uint64_t seed = 1;
};
[[nodiscard]] TriangleMesh make_segments(const SegmentsOptions& options = {});

struct PointsOptions {
  std::size_t points = 1000;  ///< number of points, >= 1
  double size = 1;            ///< side of the cube in which the random points lie, > 0
  std::uint64_t seed = 1;
};
[[nodiscard]] TriangleMesh make_points(const PointsOptions& options = {});

/// Returns a copy of a mesh in which each vertex is moved by a random vector, uniformly distributed in a ball. The copy
/// may intersect itself.
/// @param amplitude  radius of the ball, 0 to 1e100.
[[nodiscard]] TriangleMesh make_noisy(const MeshView& mesh, double amplitude, std::uint64_t seed = 1);

/// Cuts each triangle into four at the midpoints of its edges, and each segment into two, `levels` times. The shape
/// stays the same, up to rounding.
/// @param levels  0 to 12.
[[nodiscard]] TriangleMesh make_subdivided(const MeshView& mesh, int levels = 1);

/// Adds a copy of `other`, moved by `offset`, to `mesh`. `other` may be a view of `mesh`.
/// @throws InvalidMesh if the result has more than 2^31 - 1 vertices.
void append(TriangleMesh& mesh, const MeshView& other, const Vec3d& offset = {});

/// Reverses every triangle. Surfaces that faced outwards then face inwards.
void reverse_triangles(TriangleMesh& mesh);

}  // namespace blum
