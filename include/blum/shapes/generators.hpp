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
/// faces away from the solid. Its topology is that of its entry in shape_catalog(). The same options give the same mesh
/// everywhere, up to the last bits of the platform's sine and cosine.
///
/// All functions throw InvalidOption if options contradict each other or the ranges given here, or for more than 50
/// million triangles. Cost: O(triangles), unless stated otherwise.
namespace blum {

// ---- Round shapes (generators_round.cpp) ----

struct SphereOptions {
  double radius = 1;   ///< > 0
  int frequency = 16;  ///< parts of each edge of an icosahedron, >= 1; 20 * frequency^2 triangles
};
/// Makes a sphere of nearly equal triangles from a subdivided icosahedron. Its vertices lie on the sphere.
[[nodiscard]] TriangleMesh make_sphere(const SphereOptions& options = {});

struct EllipsoidOptions {
  Vec3d radii{1, 0.6, 0.3};  ///< half axes, > 0
  int frequency = 16;        ///< as for a sphere
};
[[nodiscard]] TriangleMesh make_ellipsoid(const EllipsoidOptions& options = {});

struct UvSphereOptions {
  double radius = 1;    ///< > 0
  int longitudes = 48;  ///< >= 3
  int latitudes = 24;   ///< bands from pole to pole, >= 2
};
/// Makes a sphere of longitudes and latitudes. It has needles at the poles, and rings of cocircular vertices.
[[nodiscard]] TriangleMesh make_uv_sphere(const UvSphereOptions& options = {});

struct CylinderOptions {
  double radius = 0.5;  ///< > 0
  double height = 1;    ///< along z, > 0
  int sides = 48;       ///< >= 3
  int stacks = 1;       ///< bands along the height, >= 1
};
[[nodiscard]] TriangleMesh make_cylinder(const CylinderOptions& options = {});

struct TorusOptions {
  double ring_radius = 1;    ///< of the centre line, in the xy plane
  double tube_radius = 0.3;  ///< > 0, below ring_radius
  int ring_segments = 96;    ///< >= 3
  int tube_segments = 32;    ///< >= 3
};
[[nodiscard]] TriangleMesh make_torus(const TorusOptions& options = {});

struct TorusKnotOptions {
  int p = 2;                  ///< turns around the axis of the torus, 1 to 20
  int q = 3;                  ///< turns around its tube, 1 to 20; p and q without common factor
  double ring_radius = 1;     ///< of the torus that the curve lies on, > 0
  double wind_radius = 0.4;   ///< of its tube, > 0, below ring_radius
  double tube_radius = 0.15;  ///< of the knot itself, > 0
  int curve_segments = 400;   ///< >= 16 * max(p, q)
  int tube_segments = 24;     ///< >= 3
};
/// Makes a tube around the (p, q) torus knot. Rejects a tube that would touch itself. For this, the distance between
/// strands and the curvature are measured on the curve.
[[nodiscard]] TriangleMesh make_torus_knot(const TorusKnotOptions& options = {});

struct LinkedToriOptions {
  int count = 2;             ///< links of the chain, 1 to 1000
  double ring_radius = 1;    ///< > 0
  double tube_radius = 0.2;  ///< > 0, below ring_radius / 3 so that links do not touch
  int ring_segments = 96;    ///< >= 8
  int tube_segments = 32;    ///< >= 3
};
/// Makes a chain along x. Each ring passes through the next one.
[[nodiscard]] TriangleMesh make_linked_tori(const LinkedToriOptions& options = {});

struct RidgedRodOptions {
  double length = 4;            ///< along z, > 0
  double radius = 0.5;          ///< mean radius, > 0
  double ridge_height = 0.1;    ///< half the difference between ridge and groove, >= 0, below radius
  int ridges = 12;              ///< along the length, >= 0
  int sides = 48;               ///< >= 3
  int segments_per_ridge = 12;  ///< >= 4
};
/// Makes a rod whose radius waves along its length, with flat ends.
[[nodiscard]] TriangleMesh make_ridged_rod(const RidgedRodOptions& options = {});

struct SpoonOptions {
  double length = 6;           ///< along x, > 0
  double bowl_width = 1.4;     ///< along y, > 0, at most length / 3
  double bowl_depth = 0.4;     ///< > 0, at most bowl_width
  double handle_width = 0.35;  ///< > 0, at most bowl_width
  double thickness = 0.12;     ///< of bowl and handle, > 0, at most handle_width
  int stations = 160;          ///< cross-sections along the length, >= 16
  int sides = 40;              ///< points around each cross-section, even, >= 8
};
/// Makes a spoon-like solid: a thin bowl and a bent handle.
[[nodiscard]] TriangleMesh make_spoon(const SpoonOptions& options = {});

struct OrganicOptions {
  double radius = 1;      ///< typical radius, > 0
  int frequency = 59;     ///< as for a sphere; 59 gives 69,620 triangles
  double detail = 0.006;  ///< amplitude of the finest bumps, in radii, 0 to 0.05
  int holes = 0;          ///< patches of triangles left out, 0 to 12; above 0, the surface is open and frequency >= 8
  std::uint64_t seed = 1;
};
/// Makes a star-shaped animal-like body (ears, paws, tail, rough skin). Its size and roughness are those of a scanned
/// model. With holes it is open, as scans are: vertices inside the holes stay, and nothing names them.
[[nodiscard]] TriangleMesh make_organic(const OrganicOptions& options = {});

// ---- Machined shapes (generators_cad.cpp, generators_blocks.cpp) ----

struct BoxOptions {
  Vec3d size{1, 1, 1};                   ///< > 0
  std::array<int, 3> segments{1, 1, 1};  ///< parts along x, y, z, >= 1
};
[[nodiscard]] TriangleMesh make_box(const BoxOptions& options = {});

struct WedgeOptions {
  double angle = 30;  ///< between the two large faces, degrees, 0 < angle < 180
  double length = 1;  ///< of the two large faces, from the sharp edge, > 0
  double width = 1;   ///< of the sharp edge, along y, > 0
};
/// Makes a triangular prism. Its sharp edge lies on the y axis, and its large faces open towards +x.
[[nodiscard]] TriangleMesh make_wedge(const WedgeOptions& options = {});

struct VoidCubeOptions {
  double size = 1;           ///< of the cube, > 0
  double void_radius = 0.3;  ///< > 0, below size / 2
  int segments = 8;          ///< parts along each edge of the cube, >= 1
  int frequency = 12;        ///< of the void, as for a sphere
};
/// Makes a cube with a spherical void: two shells.
[[nodiscard]] TriangleMesh make_void_cube(const VoidCubeOptions& options = {});

struct NestedShellsOptions {
  int shells = 3;     ///< 1 to 1000
  double radius = 1;  ///< of the outermost sphere, > 0; the others shrink evenly
  int frequency = 8;  ///< as for a sphere
};
/// Makes nested spheres that face outwards and inwards in turn: solid, void, solid, ...
[[nodiscard]] TriangleMesh make_nested_shells(const NestedShellsOptions& options = {});

struct BodiesOptions {
  int count = 27;      ///< >= 1
  double size = 0.5;   ///< of each body, > 0, and above 1e-12 of the side of the lattice
  double spacing = 1;  ///< between centres, > size
  int frequency = 0;   ///< 0: boxes of 12 triangles; else spheres, as above
};
/// Makes separate equal bodies on a cubic lattice that has room for them.
[[nodiscard]] TriangleMesh make_bodies(const BodiesOptions& options = {});

struct PlateOptions {
  int holes_x = 3;           ///< holes along x, >= 0
  int holes_y = 2;           ///< holes along y, >= 0; the genus is holes_x * holes_y
  double pitch = 1;          ///< between hole centres, > 0; also the size of the plate around each hole
  double hole_radius = 0.3;  ///< > 0, below pitch / 2
  double thickness = 0.25;   ///< along z, > 0
  int hole_segments = 32;    ///< sides of each hole, >= 4, a multiple of 4
};
/// Makes a plate with a row or grid of round holes through it. Without holes it is a single cell.
[[nodiscard]] TriangleMesh make_plate(const PlateOptions& options = {});

struct BracketOptions {
  double length = 3;         ///< of the foot, along x, > 0
  double height = 3;         ///< of the wall, along z, > 0
  double width = 3;          ///< along y, > 0
  double thickness = 0.4;    ///< of foot and wall, > 0, below half of length and height
  int holes = 2;             ///< holes in the foot, and as many in the wall, 0 to 10,000; the genus is 2 * holes
  double hole_radius = 0.3;  ///< > 0; holes must fit between ribs and rims
  bool ribs = true;          ///< triangular ribs between foot and wall: at both sides and between holes
  int hole_segments = 32;    ///< sides of each hole, >= 4, a multiple of 4
};
/// Makes an L-shaped bracket with holes and ribs, in the box [0, length] x [0, width] x [0, height]. The outer corner
/// line of foot and wall lies on the y axis.
[[nodiscard]] TriangleMesh make_bracket(const BracketOptions& options = {});

struct GearOptions {
  int teeth = 20;                ///< 4 to 2000
  double root_radius = 0.85;     ///< between teeth, > 0
  double tip_radius = 1;         ///< > root_radius
  double bore_radius = 0.2;      ///< >= 0, below root_radius; 0: no bore
  int openings = 5;              ///< round holes between bore and teeth, 0 to 1000; genus openings + (bore ? 1 : 0)
  double opening_radius = 0.13;  ///< > 0; they lie halfway between bore and root, without touching
  double thickness = 0.3;        ///< along z, > 0
  int hole_segments = 32;        ///< sides of each hole, >= 3
};
/// Makes a spur gear or drive wheel: an extruded toothed outline with a bore and lightening holes.
/// Cost: O(n^2) in the number of outline points.
[[nodiscard]] TriangleMesh make_gear(const GearOptions& options = {});

/// Point of a polygon.
using Point2 = std::array<double, 2>;
struct ExtrusionOptions {
  double thickness = 1;  ///< along z, > 0
  int stacks = 1;        ///< bands along the thickness, >= 1
};
/// Extrudes a polygon with holes along z, from -thickness / 2 to thickness / 2.
/// @param outline  simple polygon with at least three corners, in either direction.
/// @param holes    simple polygons inside it that touch neither it nor each other, in either direction.
/// @throws InvalidOption also if the outline or holes cross or touch; Cancelled.
/// Cost: O(n^2) in the number of points, at most 20,000.
[[nodiscard]] TriangleMesh make_extrusion(std::span<const Point2> outline, std::span<const std::vector<Point2>> holes,
                                          const ExtrusionOptions& options = {}, const Context& context = {});

struct StarOptions {
  int spikes = 5;             ///< >= 2, at most 10,000
  double outer_radius = 1;    ///< > 0
  double inner_radius = 0.4;  ///< > 0, below outer_radius
  double thickness = 0.3;     ///< along z, > 0
};
/// Makes an extruded star, with sharp convex and reflex edges.
[[nodiscard]] TriangleMesh make_star(const StarOptions& options = {});

struct MengerOptions {
  int level = 2;    ///< 0 to 5; 20^level cubes
  double size = 1;  ///< of the whole, > 0
};
/// Makes the boundary of the Menger sponge. It is a manifold: no two of its cubes touch only along an edge or in a
/// corner.
[[nodiscard]] TriangleMesh make_menger(const MengerOptions& options = {});

struct FanPartOptions {
  double size = 1;     ///< of the whole, > 0
  int resolution = 8;  ///< parts along the smallest block, >= 1; 8 gives 12,288 triangles
};
/// Makes a sector of a fan. Its curved and flat faces meet in sharp edges, convex, concave and vanishing, as in CAD
/// models.
[[nodiscard]] TriangleMesh make_fan_part(const FanPartOptions& options = {});

// ---- Soups, and meshes from meshes (generators_soup.cpp) ----

struct SoupOptions {
  std::size_t triangles = 100;  ///< >= 1
  double size = 1;              ///< of the cube that centres are drawn from, > 0
  double triangle_size = 0.2;   ///< largest distance of a corner from the centre, > 0
  /// Fraction of the triangles that are awkward, 0 to 1, in equal parts. The kinds are needles, slivers, copies of
  /// earlier triangles (unchanged or reversed), triangles on one common plane, and degenerate ones (a point, a
  /// segment).
  double awkward = 0;
  std::uint64_t seed = 1;
};
/// Makes loose random triangles, each with its own three vertices. They bound nothing.
[[nodiscard]] TriangleMesh make_soup(const SoupOptions& options = {});

struct SegmentsOptions {
  std::size_t segments = 100;  ///< >= 1
  double size = 1;             ///< of the cube that centres are drawn from, > 0
  double segment_size = 0.2;   ///< largest distance of an end from the centre, > 0
  std::uint64_t seed = 1;
};
[[nodiscard]] TriangleMesh make_segments(const SegmentsOptions& options = {});

struct PointsOptions {
  std::size_t points = 1000;  ///< >= 1
  double size = 1;            ///< of the cube that they are drawn from, > 0
  std::uint64_t seed = 1;
};
[[nodiscard]] TriangleMesh make_points(const PointsOptions& options = {});

/// Returns a copy whose vertices are each moved by a random vector, uniform in a ball. It may intersect itself.
/// @param amplitude  radius of the ball, 0 to 1e100.
[[nodiscard]] TriangleMesh make_noisy(const MeshView& mesh, double amplitude, std::uint64_t seed = 1);

/// Cuts each triangle into four at the midpoints of its edges, and each segment into two, `levels` times. The shape
/// stays the same, up to rounding.  @param levels  0 to 12.
[[nodiscard]] TriangleMesh make_subdivided(const MeshView& mesh, int levels = 1);

/// Adds a copy of `other`, moved by `offset`, to `mesh`. `other` may be a view of `mesh` itself.
/// @throws InvalidMesh if the result has more than 2^31 - 1 vertices.
void append(TriangleMesh& mesh, const MeshView& other, const Vec3d& offset = {});

/// Reverses every triangle, so that surfaces that faced outwards face inwards.
void reverse_triangles(TriangleMesh& mesh);

}  // namespace blum
