#include "geometry/distance/triangle_meeting.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/triangle_contact.hpp"

namespace blum::detail {
namespace {

/// Points of a line are in order along it where their coordinates are in the order of words.
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

/// A triangle without an area is the segment between the first and the last of its corners.
struct Hull {
  std::array<Vec3d, 3> points;
  int size = 3;  ///< how many points it is spanned by

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

/// For a point in the plane of a triangle: whether it lies in it, the border included.
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
  // No end lies on the other one, so they meet just where they cross, seen along an axis that leaves the plane an area.
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

}  // namespace

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

}  // namespace blum::detail
