#include "blum/geometry/triangle_distance.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/distance/triangle_frame.hpp"

namespace blum::detail {
namespace {

/// Compares coordinates lexicographically. For points of one line, this is their order on the line.
bool is_before(const Vec3d& a, const Vec3d& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

int turn(std::size_t dropped, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const std::size_t u = (dropped + 1) % 3;
  const std::size_t v = (dropped + 2) % 3;
  return orient2d({a[u], a[v]}, {b[u], b[v]}, {c[u], c[v]});
}

bool on_one_line(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return turn(0, a, b, c) == 0 && turn(1, a, b, c) == 0 && turn(2, a, b, c) == 0;
}

/// Points that span a triangle. A triangle without area is represented by the segment between its first and last corner
/// in this order.
struct Hull {
  std::array<Vec3d, 3> points;
  int size = 3;  ///< number of distinct points

  explicit Hull(const std::array<Vec3d, 3>& triangle) : points(triangle) {
    if (!has_no_area(triangle)) return;
    const auto [first, last] = std::minmax_element(triangle.begin(), triangle.end(), is_before);
    points = {*first, *last, *last};
    size = *first == *last ? 1 : 2;
  }
};

bool on_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  return on_one_line(a, b, p) && !is_before(p, std::min(a, b, is_before)) && !is_before(std::max(a, b, is_before), p);
}

/// Returns true if a point in a triangle's plane lies in the triangle or on its border.
bool in_triangle(const Vec3d& p, const std::array<Vec3d, 3>& t) {
  std::size_t dropped = 0;
  while (dropped < 2 && turn(dropped, t[0], t[1], t[2]) == 0) ++dropped;
  const int way = turn(dropped, t[0], t[1], t[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    if (way * turn(dropped, t[k], t[(k + 1) % 3], p) < 0) return false;
  }
  return true;
}

bool segments_meet(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  if (on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d)) return true;
  if (orient3d(a, b, c, d) != 0) return false;
  // No end of a segment lies on the other segment, so they meet only if they cross. A projection along an axis in which
  // the plane keeps an area decides if they cross.
  for (std::size_t dropped = 0; dropped < 3; ++dropped) {
    const int first = turn(dropped, a, b, c) * turn(dropped, a, b, d);
    const int second = turn(dropped, c, d, a) * turn(dropped, c, d, b);
    if (first < 0 && second < 0) return true;
  }
  return false;
}

bool segment_meets_triangle(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& t) {
  const int at_p = orient3d(t[0], t[1], t[2], p);
  const int at_q = orient3d(t[0], t[1], t[2], q);
  if (at_p * at_q > 0) return false;
  if (at_p == 0 && in_triangle(p, t)) return true;
  if (at_q == 0 && in_triangle(q, t)) return true;
  if (at_p == 0 && at_q == 0) {
    return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) || segments_meet(p, q, t[2], t[0]);
  }
  const std::array<int, 3> sides{orient3d(p, q, t[0], t[1]), orient3d(p, q, t[1], t[2]), orient3d(p, q, t[2], t[0])};
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  return *least >= 0 || *most <= 0;
}

bool have_a_corner_in_common(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  return std::any_of(a.begin(), a.end(), [&](const Vec3d& p) { return std::find(b.begin(), b.end(), p) != b.end(); });
}

/// Returns true if two triangles share a point. The triangles may be degenerate to segments or points. The result is
/// exact if all coordinates are 0 or of magnitude 1e-80 to 1e100.
bool meet(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  if (have_a_corner_in_common(a, b)) return true;
  Hull small(a);
  Hull large(b);
  if (small.size > large.size) std::swap(small, large);
  const auto& p = small.points;
  const auto& q = large.points;
  if (large.size == 1) return p[0] == q[0];
  if (large.size == 2) return small.size == 1 ? on_segment(p[0], q[0], q[1]) : segments_meet(p[0], p[1], q[0], q[1]);
  if (small.size == 1) return orient3d(q[0], q[1], q[2], p[0]) == 0 && in_triangle(p[0], q);
  if (small.size == 2) return segment_meets_triangle(p[0], p[1], q);
  return contact({a, {0, 1, 2}}, {b, {3, 4, 5}}) != Contact::none;
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

using Points = std::array<Vec3d, 3>;

/// Bound on the rounding errors of a distance and of heights along a direction. Relative to the largest coordinate.
constexpr double rounding = 1e-14;

/// Triangle with precomputed edges, to compute its distances from others.
struct Sides {
  Points corner;
  Points edge;                    ///< vector of each edge, from corner k to the next corner
  std::array<double, 3> inverse;  ///< reciprocal of the squared length of edge k; 0 if the edge has no length

  explicit Sides(const Points& p) : corner(p) {
    for (std::size_t k = 0; k < 3; ++k) {
      edge[k] = p[(k + 1) % 3] - p[k];
      const double square = squared_length(edge[k]);
      inverse[k] = square > 0 ? 1 / square : 0;
    }
  }
};

TriangleFeature on_edge(std::size_t k, double t) {
  if (t <= 0) return {SiteKind::vertex, static_cast<std::uint8_t>(k)};
  if (t >= 1) return {SiteKind::vertex, static_cast<std::uint8_t>((k + 1) % 3)};
  return {SiteKind::edge, static_cast<std::uint8_t>(k)};
}

/// One point of each triangle, and their squared distance.
struct Pair {
  double squared = std::numeric_limits<double>::infinity();
  Vec3d p, q;
  TriangleFeature of_p, of_q;

  [[nodiscard]] Pair exchanged() const { return {squared, q, p, of_q, of_p}; }
};

/// Offers the closest pairs of a corner of one triangle and a point on an edge of the other triangle.
void offer_corners_and_edges(const Sides& a, const Sides& b, Pair& best) {
  // All distances are computed before they are compared, so that no computation waits for the previous one.
  std::array<double, 9> squares;
  std::array<double, 9> places;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d w = a.corner[i] - b.corner[k];
      const double t = std::min(std::max(dot(w, b.edge[k]) * b.inverse[k], 0.0), 1.0);
      squares[3 * i + k] = squared_length(w - b.edge[k] * t);
      places[3 * i + k] = t;
    }
  }
  double least = best.squared;
  std::size_t found = 9;
  for (std::size_t n = 0; n < 9; ++n) {
    // Without branches, which would be mispredicted about half of the time.
    const bool is_less = squares[n] < least;
    least = is_less ? squares[n] : least;
    found = is_less ? n : found;
  }
  if (found == 9) return;
  const std::size_t corner = found / 3;
  const std::size_t edge = found % 3;
  const double at = places[found];
  const Vec3d q = at >= 1 ? b.corner[(edge + 1) % 3] : b.corner[edge] + b.edge[edge] * at;
  best = {least, a.corner[corner], q, {SiteKind::vertex, static_cast<std::uint8_t>(corner)}, on_edge(edge, at)};
}

/// Offers the closest pairs of points of two edges, for edges that both contain the foot of their common perpendicular.
void offer_edges(const Sides& a, const Sides& b, Pair& best) {
  // Nine common perpendiculars are computed at once, so that no computation waits for a branch of another one.
  std::array<double, 9> square;  // squared length of each product of two edges
  std::array<double, 9> s;
  std::array<double, 9> t;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < 3; ++l) {
      const Vec3d& u = a.edge[k];
      const Vec3d& v = b.edge[l];
      const Vec3d w = b.corner[l] - a.corner[k];
      const Vec3d n = cross(u, v);
      square[3 * k + l] = squared_length(n);
      // Uses cross products. For nearly parallel edges, dot products would lose twice as many digits.
      s[3 * k + l] = dot(cross(w, v), n);
      t[3 * k + l] = dot(cross(w, u), n);
    }
  }
  unsigned feet = 0;  // a bit for each pair of edges that contain both feet
  for (std::size_t i = 0; i < 9; ++i) {
    const auto holds = [](bool condition) { return static_cast<unsigned>(condition); };
    feet |= (holds(s[i] > 0) & holds(s[i] < square[i]) & holds(t[i] > 0) & holds(t[i] < square[i])) << i;
  }
  for (; feet != 0; feet &= feet - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(feet));
    const std::size_t k = i / 3;
    const std::size_t l = i % 3;
    const Vec3d& v = b.edge[l];
    const Vec3d foot = a.corner[k] + a.edge[k] * (s[i] / square[i]);
    const double along = std::clamp(dot(foot - b.corner[l], v) * b.inverse[l], 0.0, 1.0);
    const Vec3d other = b.corner[l] + v * along;
    const double squared = squared_length(foot - other);
    if (!(squared < best.squared)) continue;
    best = {squared, foot, other, {SiteKind::edge, static_cast<std::uint8_t>(k)}, on_edge(l, along)};
  }
}

/// Returns the corners of a triangle that may project into another triangle. No such corner is missed.
std::array<bool, 3> may_be_over(const Sides& a, const Sides& b) {
  const Vec3d normal = cross(b.edge[0], b.edge[1]);
  const double longest =
      std::sqrt(std::max({squared_length(b.edge[0]), squared_length(b.edge[1]), squared_length(b.edge[2])}));
  // Coordinates are at most 2, so the margin exceeds the rounding errors of the normal and of the products below.
  const double margin = 1e-13 * longest * longest * longest;
  std::array<bool, 3> out{true, true, true};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d inwards = cross(normal, b.edge[k]);
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = out[i] && dot(inwards, a.corner[i] - b.corner[k]) >= -margin;
    }
  }
  return out;
}

/// Offers the closest pairs of a corner of one triangle and a point inside the other.
void offer_corners_and_face(const Sides& a, const Sides& b, Pair& best) {
  const std::array<bool, 3> may_be = may_be_over(a, b);
  if (!may_be[0] && !may_be[1] && !may_be[2]) return;
  const TriangleFrame face = make_triangle_frame(b.corner);
  if (face.is_flat()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!may_be[i]) continue;
    const Vec3d w = a.corner[i] - face.base;
    const double s = dot(w, face.u);
    const double t = dot(w, face.v);
    const bool is_over =
        t > 0 && s * face.altitude > t * face.apex && (face.length - s) * face.altitude > t * (face.length - face.apex);
    if (!is_over) continue;
    const Vec3d rest = w - face.u * s - face.v * t;
    const double squared = squared_length(rest);
    if (squared < best.squared) {
      best = {squared,
              a.corner[i],
              a.corner[i] - rest,
              {SiteKind::vertex, static_cast<std::uint8_t>(i)},
              {SiteKind::face, 0}};
    }
  }
}

/// Returns the closest pair among points of both borders, and among corners of one triangle and inner points of the
/// other. If the triangles do not cross, this pair is the closest pair of points.
Pair closest(const Points& a, const Points& b) {
  const Sides of_a(a);
  const Sides of_b(b);
  Pair best;
  offer_corners_and_edges(of_a, of_b, best);
  offer_edges(of_a, of_b, best);
  offer_corners_and_face(of_a, of_b, best);
  Pair other = best.exchanged();
  offer_corners_and_edges(of_b, of_a, other);
  offer_corners_and_face(of_b, of_a, other);
  return other.exchanged();
}

/// Returns a lower bound of the distance between two triangles, measured along a direction and multiplied by the
/// direction's length.
double gap_along(const Vec3d& direction, const Points& a, const Points& b) {
  const double here = std::max({dot(direction, a[0]), dot(direction, a[1]), dot(direction, a[2])});
  const double there = std::min({dot(direction, b[0]), dot(direction, b[1]), dot(direction, b[2])});
  return there - here;
}

/// Among the points where edges of `a` pass through the plane of `b`, offers the one closest to `b`.
void offer_crossings(const Points& a, const Points& b, Pair& best) {
  const TriangleFrame frame = make_triangle_frame(b);
  const Vec3d normal = frame.normal();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& p = a[k];
    const Vec3d& q = a[(k + 1) % 3];
    const double at_p = dot(normal, p - frame.base);
    const double at_q = dot(normal, q - frame.base);
    if (!(at_p * at_q < 0)) continue;
    const Vec3d point = p + (q - p) * (at_p / (at_p - at_q));
    const Pair found = closest({point, point, point}, b);
    if (!(found.squared < best.squared)) continue;
    best = {found.squared, point, point, {SiteKind::edge, static_cast<std::uint8_t>(k)}, found.of_q};
  }
}

/// Pair of triangles, moved so that one corner is the origin, and scaled so that products neither overflow nor
/// underflow.
struct Placed {
  Points a, b;
  double scale;
  double largest = 0;  ///< largest coordinate after moving and scaling

  Placed(const Points& first, const Points& second) {
    Box3 box;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = first[k] - first[0];
      b[k] = second[k] - first[0];
      box.extend(a[k]);
      box.extend(b[k]);
    }
    scale = coordinate_scale(box);
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] *= scale;
      b[k] *= scale;
    }
    // At most 2, unless coordinates are close to the largest or smallest double.
    largest = box.largest_coordinate() * scale;
  }
};

/// Returns true if the closest points prove that the triangles do not meet.
bool are_apart(const Placed& placed, const Pair& pair) {
  const Vec3d way = pair.q - pair.p;
  return gap_along(way, placed.a, placed.b) > rounding * placed.largest * length(way);
}

Points scaled(const Points& p, double by) {
  return {p[0] * by, p[1] * by, p[2] * by};
}

bool meet_exactly(const Points& a, const Points& b) {
  Box3 box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.extend(a[k]);
    box.extend(b[k]);
  }
  const double scale = coordinate_scale(box);
  return detail::meet(scaled(a, scale), scaled(b, scale));
}

bool in_range(const Points& p) {
  const auto is_fine = [](double x) { return std::abs(x) <= 1e150; };
  return std::all_of(p.begin(), p.end(), [&](const Vec3d& x) { return is_fine(x.x) && is_fine(x.y) && is_fine(x.z); });
}

}  // namespace

TriangleDistance triangle_distance(const Points& a, const Points& b) {
  const Placed placed(a, b);
  Pair best = closest(placed.a, placed.b);
  const bool is_meeting = !are_apart(placed, best) && meet_exactly(a, b);
  if (is_meeting && !(best.squared <= rounding * placed.largest * rounding * placed.largest)) {
    Pair crossing;
    offer_crossings(placed.a, placed.b, crossing);
    crossing = crossing.exchanged();
    offer_crossings(placed.b, placed.a, crossing);
    crossing = crossing.exchanged();
    // If the triangles only touch, there may be no crossing; then `best` stays.
    if (crossing.squared < best.squared) best = crossing;
  }
  const auto as_given = [&](const Vec3d& p) { return p / placed.scale + a[0]; };
  TriangleDistance out{0, as_given(best.p), as_given(best.q), best.of_p, best.of_q};
  if (is_meeting) {
    out.second_point = out.first_point;
  } else {
    out.distance = std::max(std::sqrt(best.squared) / placed.scale, std::numeric_limits<double>::min());
  }
  return out;
}

bool triangles_meet(const Points& a, const Points& b) {
  return meet_exactly(a, b);
}

std::vector<TriangleDistance> triangle_distances(std::span<const Points> a, std::span<const Points> b,
                                                 const Context& context) {
  if (a.size() != b.size()) {
    throw InvalidOption("pairs of triangles need two lists of equal length, not " + std::to_string(a.size()) + " and " +
                        std::to_string(b.size()) + " triangles");
  }
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!in_range(a[k]) || !in_range(b[k])) {
      throw InvalidMesh("pair " + std::to_string(k) + " of triangles: a coordinate is not finite, or beyond 1e150");
    }
  }
  std::vector<TriangleDistance> out(a.size());
  constexpr std::size_t grain = 1024;
  parallel_for(context, a.size(), grain, "distances of triangles", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) out[k] = triangle_distance(a[k], b[k]);
  });
  return out;
}

}  // namespace blum
