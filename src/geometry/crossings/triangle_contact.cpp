#include "blum/geometry/triangle_contact.hpp"

#include <cstddef>
#include <utility>

#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum::detail {
namespace {

using Points = std::array<Vec3d, 3>;
using Signs = std::array<int, 3>;

/// Projection along a coordinate axis in which a triangle keeps an area, so that its plane can be treated in 2D.
class Projection {
 public:
  explicit Projection(const Points& triangle) {
    for (axis_ = 0; axis_ < 2; ++axis_) {
      if (turn(triangle[0], triangle[1], triangle[2]) != 0) return;
    }
  }
  /// Returns the orientation of the path a -> b -> c: 1 or -1; 0 if the points are on one line. All results may have
  /// the opposite sign.
  [[nodiscard]] int turn(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    return orient2d(flat(a), flat(b), flat(c));
  }
  /// Returns true if x lies in the wedge between the rays from v through p and q, border included. The points v, p, q
  /// must not be on one line.
  [[nodiscard]] bool in_wedge(const Vec3d& v, const Vec3d& p, const Vec3d& q, const Vec3d& x) const {
    const int way = turn(v, p, q);
    return way * turn(v, p, x) >= 0 && way * turn(v, x, q) >= 0;
  }

 private:
  [[nodiscard]] std::array<double, 2> flat(const Vec3d& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }

  std::size_t axis_ = 0;
};

Points rotated(const Points& p, std::size_t first) {
  return {p[first], p[(first + 1) % 3], p[(first + 2) % 3]};
}

Signs sides(const Points& plane, const Points& points) {
  return {orient3d(plane[0], plane[1], plane[2], points[0]), orient3d(plane[0], plane[1], plane[2], points[1]),
          orient3d(plane[0], plane[1], plane[2], points[2])};
}

bool all_on_one_side(const Signs& s) {
  return s[0] != 0 && s[0] == s[1] && s[0] == s[2];
}

bool all_in_plane(const Signs& s) {
  return s[0] == 0 && s[1] == 0 && s[2] == 0;
}

bool on_both_sides(const Signs& s) {
  return (s[0] > 0 || s[1] > 0 || s[2] > 0) && (s[0] < 0 || s[1] < 0 || s[2] < 0);
}

/// Returns the contact of the triangles p, q, a and p, q, b with the common edge from p to q. The triangles overlap
/// only if one triangle is folded onto the other.
Contact contact_over_edge(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b) {
  if (orient3d(p, q, a, b) != 0) return Contact::none;
  const Projection plane({p, q, a});
  return plane.turn(p, q, a) == plane.turn(p, q, b) ? Contact::touching : Contact::none;
}

/// Returns the contact along a ray: the ray in which the wedge of `a` passes through the plane of `b`. The ray starts
/// at the common corner a[0] = b[0].
/// @param side  sides of b's plane on which a[1] and a[2] lie. The two sides must differ.
Contact contact_along_ray(const Points& a, const Points& b, int side_1, int side_2) {
  if (side_1 == 0 || side_2 == 0) {
    const Projection plane(b);
    return plane.in_wedge(b[0], b[1], b[2], side_1 == 0 ? a[1] : a[2]) ? Contact::touching : Contact::none;
  }
  const Vec3d& above = side_1 > 0 ? a[1] : a[2];
  const Vec3d& below = side_1 > 0 ? a[2] : a[1];
  const int first = orient3d(above, below, b[0], b[1]);
  const int second = orient3d(above, below, b[2], b[0]);
  if (first > 0 || second > 0) return Contact::none;
  return first < 0 && second < 0 ? Contact::crossing : Contact::touching;
}

/// Returns the contact of triangles with the common corner a[0] = b[0]. Near the corner both are wedges. Triangles are
/// convex, so they share more than the corner only if the wedges share more than the corner.
Contact contact_over_corner(const Points& a, const Points& b) {
  const int b1 = orient3d(a[0], a[1], a[2], b[1]);
  const int b2 = orient3d(a[0], a[1], a[2], b[2]);
  if (b1 != 0 && b1 == b2) return Contact::none;
  if (b1 == 0 && b2 == 0) {
    const Projection plane(a);
    const bool meet = plane.in_wedge(a[0], a[1], a[2], b[1]) || plane.in_wedge(a[0], a[1], a[2], b[2]) ||
                      plane.in_wedge(b[0], b[1], b[2], a[1]) || plane.in_wedge(b[0], b[1], b[2], a[2]);
    return meet ? Contact::touching : Contact::none;
  }
  const int a1 = orient3d(b[0], b[1], b[2], a[1]);
  const int a2 = orient3d(b[0], b[1], b[2], a[2]);
  if (a1 != 0 && a1 == a2) return Contact::none;
  const Contact found = contact_along_ray(a, b, a1, a2);
  // If an edge of b lies in a's plane, the ray lies inside a, but on the border of b.
  return found == Contact::crossing && (b1 == 0 || b2 == 0) ? Contact::touching : found;
}

/// Returns true if a polygon lies completely beyond one edge of another polygon. Two convex polygons in one plane are
/// apart if and only if this is true for at least one of the two orders.
bool is_beyond_an_edge(const Projection& plane, const Points& of, const Points& other) {
  const int way = plane.turn(of[0], of[1], of[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto outside = [&](const Vec3d& p) { return way * plane.turn(of[k], of[(k + 1) % 3], p) < 0; };
    if (outside(other[0]) && outside(other[1]) && outside(other[2])) return true;
  }
  return false;
}

/// Returns the corner that a plane separates from the other two corners; corners may also lie in the plane. The corners
/// must not all lie in the plane, nor all strictly on one side.
std::size_t lone_corner(const Signs& s) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (s[k] != 0 && s[k] * s[(k + 1) % 3] <= 0 && s[k] * s[(k + 2) % 3] <= 0) return k;
  }
  // Here one corner lies in the plane, and the other two are on the same side.
  return s[0] == 0 ? 0 : s[1] == 0 ? 1 : 2;
}

Contact contact_of_strangers(const Points& a, const Points& b) {
  const Signs b_sides = sides(a, b);
  if (all_on_one_side(b_sides)) return Contact::none;
  if (all_in_plane(b_sides)) {
    const Projection plane(a);
    return is_beyond_an_edge(plane, a, b) || is_beyond_an_edge(plane, b, a) ? Contact::none : Contact::touching;
  }
  const Signs a_sides = sides(b, a);
  if (all_on_one_side(a_sides)) return Contact::none;

  // Each triangle meets the common line of both planes in an interval between the two edges at its lone corner. The
  // corners are reordered so that each lone corner is above the other's plane. Two determinants then compare the ends
  // of the intervals.
  const std::size_t a_lone = lone_corner(a_sides);
  const std::size_t b_lone = lone_corner(b_sides);
  Points p = rotated(a, a_lone);
  Points q = rotated(b, b_lone);
  const auto is_below = [](const Signs& s, std::size_t lone) {
    return s[lone] < 0 || (s[lone] == 0 && s[(lone + 1) % 3] > 0);
  };
  const bool a_below = is_below(a_sides, a_lone);
  const bool b_below = is_below(b_sides, b_lone);
  if (a_below) std::swap(q[1], q[2]);
  if (b_below) std::swap(p[1], p[2]);
  const int first = orient3d(p[1], q[1], q[0], p[0]);
  const int second = orient3d(p[0], q[2], q[0], p[2]);
  if (first > 0 || second > 0) return Contact::none;
  return first < 0 && second < 0 && on_both_sides(a_sides) && on_both_sides(b_sides) ? Contact::crossing
                                                                                     : Contact::touching;
}

}  // namespace

bool has_no_area(const std::array<Vec3d, 3>& p) {
  return orient2d({p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}) == 0 &&
         orient2d({p[0].y, p[0].z}, {p[1].y, p[1].z}, {p[2].y, p[2].z}) == 0 &&
         orient2d({p[0].z, p[0].x}, {p[1].z, p[1].x}, {p[2].z, p[2].x}) == 0;
}

Contact contact(const ContactTriangle& a, const ContactTriangle& b) {
  std::size_t shared = 0;
  // Sums of the shared corners' indices (each 0 to 2), from which the index of the remaining corner follows.
  std::size_t of_a = 0;
  std::size_t of_b = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (a.corners[i] != b.corners[j]) continue;
      ++shared;
      of_a += i;
      of_b += j;
    }
  }
  if (shared == 0) return contact_of_strangers(a.points, b.points);
  if (shared == 1) return contact_over_corner(rotated(a.points, of_a), rotated(b.points, of_b));
  if (shared >= 3) return Contact::touching;
  const Points p = rotated(a.points, 3 - of_a);
  return contact_over_edge(p[1], p[2], p[0], b.points[3 - of_b]);
}

}  // namespace blum::detail
