#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/ear_clipping.hpp"
#include "blum/geometry/plane_polygon.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"
#include "shapes/generator_parts.hpp"

namespace blum::detail {
namespace {

using Polygon = PlanePolygon;
using Point = PlanePolygon::Point;

/// Tests sides in the order of rising x.
/// @throws InvalidOption if two sides cross, or touch other than in a common corner.
void require_simple(const Polygon& polygon, const Context& context) {
  struct Side {
    Point lower, upper;  // by (x, y)
  };
  std::vector<Side> sides;
  for (std::size_t loop = 0; loop < polygon.loop_starts.size(); ++loop) {
    for (std::uint32_t k = polygon.loop_starts[loop]; k < polygon.loop_end(loop); ++k) {
      const Point& a = polygon.points[k];
      const Point& b = polygon.points[k + 1 == polygon.loop_end(loop) ? polygon.loop_starts[loop] : k + 1];
      sides.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::vector<Point> sorted = polygon.points;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    throw InvalidOption("the polygon uses a point twice; its outline and holes must not touch");
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.lower < b.lower; });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    throw_if_cancelled(context);
    for (std::size_t k = i + 1; k < sides.size() && sides[k].lower[0] <= sides[i].upper[0]; ++k) {
      const auto [low, high] = std::minmax(sides[i].lower[1], sides[i].upper[1]);
      if (std::max(sides[k].lower[1], sides[k].upper[1]) < low) continue;
      if (std::min(sides[k].lower[1], sides[k].upper[1]) > high) continue;
      if (!segments_meet(sides[i].lower, sides[i].upper, sides[k].lower, sides[k].upper)) continue;
      throw InvalidOption("the polygon crosses or touches itself near x = " + std::to_string(sides[k].lower[0]) +
                          ", y = " + std::to_string(sides[k].lower[1]));
    }
  }
}

/// Adds the outline or a hole.
/// @throws InvalidOption if the loop has fewer than three points or no area, or if the polygon would have more than
/// 20,000 points.
void add_loop(Polygon& polygon, std::span<const Point> loop) {
  require(loop.size() >= 3, "the number of points of a loop", "at least 3", static_cast<double>(loop.size()));
  const double count = static_cast<double>(polygon.points.size() + loop.size());
  require(count <= 20000, "the number of points of a polygon", "at most 20000", count);
  const double area = doubled_area(loop);
  require(area > 0 || area < 0, "the area of a loop", "finite and not 0", area);
  polygon.add_loop(loop);
}

/// Triangulates a polygon.
/// @throws InvalidOption if loops cross or touch, or a hole is not inside the outline; Cancelled.
std::vector<Triangle> triangles_of(const Polygon& polygon, const Context& context) {
  require_simple(polygon, context);
  std::optional<std::vector<Triangle>> found = triangulate(polygon, EarOrder::every_other, context);
  if (found) return std::move(*found);
  throw InvalidOption("the polygon cannot be triangulated: a hole lies outside the outline or in another hole");
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

using detail::require;
using detail::require_at_least;
using detail::require_positive;
using detail::require_triangle_count;

/// Returns the outline of a gear, counter-clockwise. Each tooth has a sector of the circle: an arc at the root, a
/// flank, an arc at the tip, and a second flank. Corner::along is a fraction of the sector. The second flank ends where
/// the next tooth begins.
std::vector<Point2> gear_outline(const GearOptions& options) {
  struct Corner {
    double along;
    bool is_tip;
  };
  constexpr std::array<Corner, 6> corners = {
      {{0, false}, {0.175, false}, {0.35, false}, {0.5, true}, {0.675, true}, {0.85, true}}};
  std::vector<Point2> outline;
  for (int tooth = 0; tooth < options.teeth; ++tooth) {
    for (const Corner& corner : corners) {
      const double angle = 2 * detail::pi * (tooth + corner.along) / options.teeth;
      const double radius = corner.is_tip ? options.tip_radius : options.root_radius;
      outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
  }
  return outline;
}

}  // namespace

TriangleMesh make_wedge(const WedgeOptions& options) {
  require(options.angle > 0 && options.angle < 180, "angle", "above 0 and below 180 degrees", options.angle);
  require_positive(options.length, "length");
  require_positive(options.width, "width");
  const double half = 0.5 * options.angle * detail::pi / 180;
  const double x = options.length * std::cos(half);
  const double z = options.length * std::sin(half);
  require(z > 0 && x > 0, "angle", "large enough to keep the faces apart", options.angle);
  const double y = 0.5 * options.width;
  TriangleMesh mesh;
  mesh.vertices = {{0, -y, 0}, {x, -y, -z}, {x, -y, z}, {0, y, 0}, {x, y, -z}, {x, y, z}};
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}};
  detail::add_quad(mesh, 0, 3, 4, 1);
  detail::add_quad(mesh, 1, 4, 5, 2);
  detail::add_quad(mesh, 2, 5, 3, 0);
  return mesh;
}

TriangleMesh make_extrusion(std::span<const Point2> outline, std::span<const std::vector<Point2>> holes,
                            const ExtrusionOptions& options, const Context& context) {
  require_positive(options.thickness, "thickness");
  require_at_least(options.stacks, 1, "stacks");
  detail::PlanePolygon polygon;
  detail::add_loop(polygon, outline);
  for (const auto& hole : holes) detail::add_loop(polygon, hole);
  const auto count = static_cast<std::uint32_t>(polygon.points.size());
  require_triangle_count(2.0 * count * (options.stacks + 2.0));
  const auto levels = static_cast<std::uint32_t>(options.stacks);
  TriangleMesh mesh;
  for (std::uint32_t level = 0; level <= levels; ++level) {
    const double z = options.thickness * (static_cast<double>(level) / levels - 0.5);
    for (const Point2& p : polygon.points) mesh.vertices.push_back({p[0], p[1], z});
  }
  const std::uint32_t above = levels * count;
  for (const Triangle& t : detail::triangles_of(polygon, context)) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + above, t[1] + above, t[2] + above});
  }
  for (std::uint32_t level = 0; level < levels; ++level) {
    for (std::size_t loop = 0; loop < polygon.loop_starts.size(); ++loop) {
      const std::uint32_t first = polygon.loop_starts[loop];
      const std::uint32_t end = polygon.loop_end(loop);
      for (std::uint32_t k = first; k < end; ++k) {
        const std::uint32_t a = level * count + k;
        const std::uint32_t b = level * count + (k + 1 == end ? first : k + 1);
        detail::add_quad(mesh, a, b, b + count, a + count);
      }
    }
  }
  return mesh;
}

TriangleMesh make_gear(const GearOptions& options) {
  require(options.teeth >= 4 && options.teeth <= 2000, "teeth", "4 to 2000", options.teeth);
  require_positive(options.root_radius, "root_radius");
  require_positive(options.tip_radius, "tip_radius");
  require(options.tip_radius > options.root_radius, "tip_radius", "above root_radius", options.tip_radius);
  // Each half of an arc at the root is a chord. The middle of a chord is closer to the centre than the root radius.
  const double inner_radius = options.root_radius * std::cos(0.175 * detail::pi / options.teeth);
  require(options.bore_radius >= 0 && options.bore_radius < inner_radius, "bore_radius", "0 to below root_radius",
          options.bore_radius);
  require_at_least(options.hole_segments, 3, "hole_segments");
  require(options.openings >= 0 && options.openings <= 1000, "openings", "0 to 1000", options.openings);
  require_triangle_count(8.0 * (6.0 * options.teeth + (options.openings + 1.0) * options.hole_segments));
  std::vector<std::vector<Point2>> holes;
  if (options.bore_radius > 0) holes.push_back(detail::circle(0, 0, options.bore_radius, options.hole_segments));
  if (options.openings > 0) {
    require_positive(options.opening_radius, "opening_radius");
    const double middle = 0.5 * (options.bore_radius + inner_radius);
    const double room = std::min(0.5 * (inner_radius - options.bore_radius),
                                 options.openings == 1 ? HUGE_VAL : middle * std::sin(detail::pi / options.openings));
    require(options.opening_radius < room, "opening_radius",
            ("below " + std::to_string(room) + ", or openings meet").c_str(), options.opening_radius);
    for (const Point2& center : detail::circle(0, 0, middle, options.openings)) {
      holes.push_back(detail::circle(center[0], center[1], options.opening_radius, options.hole_segments));
    }
  }
  return make_extrusion(gear_outline(options), holes, {options.thickness, 1});
}

TriangleMesh make_star(const StarOptions& options) {
  require(options.spikes >= 2 && options.spikes <= 10000, "spikes", "2 to 10000", options.spikes);
  require_positive(options.outer_radius, "outer_radius");
  require_positive(options.inner_radius, "inner_radius");
  require(options.inner_radius < options.outer_radius, "inner_radius", "below outer_radius", options.inner_radius);
  std::vector<Point2> outline = detail::circle(0, 0, options.outer_radius, 2 * options.spikes);
  const auto inner = detail::circle(0, 0, options.inner_radius, 2 * options.spikes);
  for (std::size_t k = 1; k < outline.size(); k += 2) outline[k] = inner[k];
  return make_extrusion(outline, {}, {options.thickness, 1});
}

TriangleMesh make_void_cube(const VoidCubeOptions& options) {
  require_positive(options.size, "size");
  require_positive(options.void_radius, "void_radius");
  require(options.void_radius < 0.5 * options.size, "void_radius", "below size / 2, or the void cuts the cube",
          options.void_radius);
  const int n = options.segments;
  TriangleMesh mesh = make_box({{options.size, options.size, options.size}, {n, n, n}});
  TriangleMesh inner = make_sphere({options.void_radius, options.frequency});
  require_triangle_count(static_cast<double>(mesh.triangles.size()) + static_cast<double>(inner.triangles.size()));
  reverse_triangles(inner);
  append(mesh, inner);
  return mesh;
}

TriangleMesh make_nested_shells(const NestedShellsOptions& options) {
  require(options.shells >= 1 && options.shells <= 1000, "shells", "1 to 1000", options.shells);
  require_positive(options.radius, "radius");
  require_at_least(options.frequency, 1, "frequency");
  require_triangle_count(20.0 * options.shells * options.frequency * options.frequency);
  // All shells are copies of one convex polyhedron around the origin with different scales, so they cannot touch.
  const TriangleMesh outer = make_sphere({options.radius, options.frequency});
  TriangleMesh mesh;
  for (int shell = 0; shell < options.shells; ++shell) {
    TriangleMesh scaled = outer;
    for (Vec3d& p : scaled.vertices) p *= 1 - static_cast<double>(shell) / options.shells;
    if (shell % 2 == 1) reverse_triangles(scaled);
    append(mesh, scaled);
  }
  return mesh;
}

TriangleMesh make_bodies(const BodiesOptions& options) {
  require_at_least(options.count, 1, "count");
  require_positive(options.size, "size");
  require_positive(options.spacing, "spacing");
  require(options.spacing > options.size, "spacing", "above size, or bodies touch", options.spacing);
  require_at_least(options.frequency, 0, "frequency");
  const double each = options.frequency == 0 ? 12.0 : 20.0 * options.frequency * options.frequency;
  require_triangle_count(each * options.count);
  const TriangleMesh body = options.frequency == 0 ? make_box({{options.size, options.size, options.size}, {1, 1, 1}})
                                                   : make_sphere({0.5 * options.size, options.frequency});
  int side = 1;
  while (static_cast<double>(side) * side * side < options.count) ++side;
  require(options.size > 1e-12 * side * options.spacing, "size",
          "above 1e-12 of the lattice's side, or rounding makes bodies vanish", options.size);
  const double middle = 0.5 * (side - 1);
  TriangleMesh mesh;
  for (int i = 0; i < options.count; ++i) {
    const Vec3d place{i % side - middle, i / side % side - middle, i / side / side - middle};
    append(mesh, body, place * options.spacing);
  }
  return mesh;
}

}  // namespace blum
