#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/ear_clipping.hpp"
#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"
#include "shapes/generator_parts.hpp"

namespace blum::detail {
namespace {

/// A polygon with holes: a list of loops, each of consecutive points. The outline comes first, counter-clockwise. Then
/// come the holes, clockwise.
struct Polygon {
  std::vector<std::array<double, 2>> points;
  std::vector<std::uint32_t> loop_starts;  ///< index of the first point of each loop; 0 for the outline

  /// Adds the outline or a hole. A loop in the wrong direction is reversed.
  /// @throws InvalidOption if the loop has fewer than three points or no area, or if the polygon would have more than
  /// 20,000 points.
  void add_loop(std::span<const std::array<double, 2>> loop);
  [[nodiscard]] std::uint32_t loop_end(std::size_t loop) const;
};

using Point = std::array<double, 2>;

double doubled_area(std::span<const Point> loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point& a = loop[k];
    const Point& b = loop[(k + 1) % loop.size()];
    sum += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (a[1] - loop[0][1]) * (b[0] - loop[0][0]);
  }
  return sum;
}

/// Returns true if the segments ab and cd cross or overlap, or if an end of one lies inside the other. A common end
/// alone does not count.
bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  // True if r, on line pq, is strictly between p and q.
  const auto between = [](const Point& p, const Point& q, const Point& r) {
    return std::min(p, q) < r && r < std::max(p, q);
  };
  const int c_side = orient2d(a, b, c);
  const int d_side = orient2d(a, b, d);
  const int a_side = orient2d(c, d, a);
  const int b_side = orient2d(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) || (a_side == 0 && between(c, d, a)) ||
         (b_side == 0 && between(c, d, b));
}

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

/// The outline of a polygon, to which its holes are joined by bridges: one loop of point indices. The ends of bridges
/// occur twice.
class JoinedLoop {
 public:
  JoinedLoop(const Polygon& polygon, const Context& context) : polygon_(polygon), context_(context) {
    loop_.resize(polygon.loop_end(0));
    std::iota(loop_.begin(), loop_.end(), 0U);
    // The rightmost hole is joined first. So the bridge of a hole can only cross the loop joined so far, not a later
    // hole.
    std::vector<Hole> holes;
    for (std::size_t h = 1; h < polygon.loop_starts.size(); ++h) holes.push_back(rightmost(h));
    std::sort(holes.begin(), holes.end(), [&](const Hole& a, const Hole& b) {
      return polygon.points[a.start] != polygon.points[b.start] ? polygon.points[a.start] > polygon.points[b.start]
                                                                : a.start < b.start;
    });
    for (const Hole& hole : holes) join(hole);
  }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return loop_; }

 private:
  struct Hole {
    std::size_t loop = 0;
    std::uint32_t start = 0;  ///< index of its largest point by (x, y)
  };

  [[nodiscard]] Hole rightmost(std::size_t loop) const {
    std::uint32_t best = polygon_.loop_starts[loop];
    for (std::uint32_t i = best; i < polygon_.loop_end(loop); ++i) {
      if (polygon_.points[i] > polygon_.points[best]) best = i;
    }
    return {loop, best};
  }

  /// Returns true if the ray from corner loop_[at] to the point `target` starts inside the polygon.
  [[nodiscard]] bool leaves_inwards(std::size_t at, const Point& target) const {
    const std::size_t n = loop_.size();
    const Point& before = polygon_.points[loop_[(at + n - 1) % n]];
    const Point& corner = polygon_.points[loop_[at]];
    const Point& after = polygon_.points[loop_[(at + 1) % n]];
    const bool left_of_first = orient2d(before, corner, target) > 0;
    const bool left_of_second = orient2d(corner, after, target) > 0;
    return orient2d(before, corner, after) > 0 ? left_of_first && left_of_second : left_of_first || left_of_second;
  }

  [[nodiscard]] bool is_free(std::uint32_t from, std::uint32_t to) const {
    const auto& p = polygon_.points;
    for (std::size_t k = 0; k < loop_.size(); ++k) {
      if (segments_meet(p[from], p[to], p[loop_[k]], p[loop_[(k + 1) % loop_.size()]])) return false;
    }
    return true;
  }

  void join(const Hole& hole) {
    const Point& start = polygon_.points[hole.start];
    std::vector<std::size_t> order;
    for (std::size_t at = 0; at < loop_.size(); ++at) {
      if (polygon_.points[loop_[at]] > start && leaves_inwards(at, start)) order.push_back(at);
    }
    const auto squared = [&](std::size_t at) {
      const Point& q = polygon_.points[loop_[at]];
      return (q[0] - start[0]) * (q[0] - start[0]) + (q[1] - start[1]) * (q[1] - start[1]);
    };
    // The closest corner is tried first, because the bridge to it almost never crosses the loop.
    const auto goes_later = [&](std::size_t a, std::size_t b) {
      return squared(a) != squared(b) ? squared(a) > squared(b) : a > b;
    };
    std::make_heap(order.begin(), order.end(), goes_later);
    for (auto end = order.end(); end != order.begin(); --end) {
      throw_if_cancelled(context_);
      std::pop_heap(order.begin(), end, goes_later);
      const std::size_t at = *(end - 1);
      if (!is_free(hole.start, loop_[at])) continue;
      splice(at, hole);
      return;
    }
    throw InvalidOption("the polygon cannot be triangulated: a hole lies outside the outline or in another hole");
  }

  /// Inserts after loop_[at] the loop of a hole, from its start back to its start, and then loop_[at] again.
  void splice(std::size_t at, const Hole& hole) {
    std::vector<std::uint32_t> inserted;
    const std::uint32_t first = polygon_.loop_starts[hole.loop];
    const std::uint32_t count = polygon_.loop_end(hole.loop) - first;
    for (std::uint32_t k = 0; k <= count; ++k) inserted.push_back(first + (hole.start - first + k) % count);
    inserted.push_back(loop_[at]);
    loop_.insert(loop_.begin() + static_cast<std::ptrdiff_t>(at) + 1, inserted.begin(), inserted.end());
  }

  const Polygon& polygon_;
  const Context& context_;
  std::vector<std::uint32_t> loop_;
};

void Polygon::add_loop(std::span<const Point> loop) {
  require(loop.size() >= 3, "the number of points of a loop", "at least 3", static_cast<double>(loop.size()));
  const double count = static_cast<double>(points.size() + loop.size());
  require(count <= 20000, "the number of points of a polygon", "at most 20000", count);
  const double area = doubled_area(loop);
  require(area > 0 || area < 0, "the area of a loop", "finite and not 0", area);
  const bool is_outline = loop_starts.empty();
  loop_starts.push_back(static_cast<std::uint32_t>(points.size()));
  points.insert(points.end(), loop.begin(), loop.end());
  if ((area > 0) != is_outline) std::reverse(points.end() - static_cast<std::ptrdiff_t>(loop.size()), points.end());
}

std::uint32_t Polygon::loop_end(std::size_t loop) const {
  return loop + 1 < loop_starts.size() ? loop_starts[loop + 1] : static_cast<std::uint32_t>(points.size());
}

/// Triangulates a polygon by cutting off ears, after its holes are joined to the outline. Triangles are
/// counter-clockwise. Every edge of a loop is an edge of exactly one triangle, and no point is added.
/// @throws InvalidOption if loops cross or touch, or a hole is not inside the outline; Cancelled. Cost: O(n^2) for n
/// points, in practice.
std::vector<Triangle> triangulate(const Polygon& polygon, const Context& context) {
  require_simple(polygon, context);
  const JoinedLoop joined(polygon, context);
  const std::vector<std::uint32_t>& loop = joined.indices();
  std::vector<Point> points;
  for (const std::uint32_t index : loop) points.push_back(polygon.points[index]);
  std::vector<Triangle> triangles(loop.size() - 2);
  std::int64_t work_left = std::numeric_limits<std::int64_t>::max();
  if (!clip_ears(points, EarOrder::every_other, triangles, work_left, context)) {
    throw InvalidOption("the polygon cannot be triangulated: its outline or holes cross");
  }
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = loop[corner];
  }
  return triangles;
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
  detail::Polygon polygon;
  polygon.add_loop(outline);
  for (const auto& hole : holes) polygon.add_loop(hole);
  const auto count = static_cast<std::uint32_t>(polygon.points.size());
  require_triangle_count(2.0 * count * (options.stacks + 2.0));
  const auto levels = static_cast<std::uint32_t>(options.stacks);
  TriangleMesh mesh;
  for (std::uint32_t level = 0; level <= levels; ++level) {
    const double z = options.thickness * (static_cast<double>(level) / levels - 0.5);
    for (const Point2& p : polygon.points) mesh.vertices.push_back({p[0], p[1], z});
  }
  const std::uint32_t above = levels * count;
  for (const Triangle& t : detail::triangulate(polygon, context)) {
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
  // Each half of an arc at the root is a chord. Its middle is closer to the centre than the root radius.
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
