#include "support/slow_triangles.hpp"

#include <algorithm>
#include <cstddef>

namespace blum::test {
namespace {

using Q = boost::multiprecision::cpp_rational;
using V = std::array<Q, 3>;
using T = std::array<V, 3>;

V exact(const Vec3d& p) {
  return {Q(p.x), Q(p.y), Q(p.z)};
}
V minus(const V& a, const V& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
V along(const V& a, const V& way, const Q& t) {
  return {a[0] + way[0] * t, a[1] + way[1] * t, a[2] + way[2] * t};
}
Q times(const V& a, const V& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Q square(const V& a) {
  return times(a, a);
}

Q of_point_and_segment(const V& p, const V& a, const V& b) {
  const V way = minus(b, a);
  const Q size = square(way);
  if (size == 0) return square(minus(p, a));
  const Q t = std::clamp<Q>(times(minus(p, a), way) / size, 0, 1);
  return square(minus(p, along(a, way, t)));
}

/// True if a point in the plane of a triangle lies in the triangle. Its area must not be zero.
bool is_inside(const V& p, const T& t, const V& normal) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (times(cross(minus(t[(k + 1) % 3], t[k]), minus(p, t[k])), normal) < 0) return false;
  }
  return true;
}

void offer(Q& best, const Q& other) {
  if (other < best) best = other;
}

/// Offers the distance between interior points of two edges.
void offer_edges(const V& a, const V& b, const V& c, const V& d, Q& best) {
  const V u = minus(b, a);
  const V v = minus(d, c);
  const V w = minus(c, a);
  const V n = cross(u, v);
  const Q size = square(n);
  if (size == 0) return;
  const Q s = times(cross(w, v), n) / size;
  const Q t = times(cross(w, u), n) / size;
  if (s < 0 || s > 1 || t < 0 || t > 1) return;
  const Q height = times(w, n);
  offer(best, height * height / size);
}

/// Offers the distances of the corners of one triangle from the interior of the other; 0 if an edge passes through it.
void offer_face(const T& a, const T& b, Q& best) {
  const V normal = cross(minus(b[1], b[0]), minus(b[2], b[0]));
  const Q size = square(normal);
  if (size == 0) return;
  std::array<Q, 3> height;
  for (std::size_t k = 0; k < 3; ++k) {
    height[k] = times(minus(a[k], b[0]), normal);
    if (is_inside(along(a[k], normal, -height[k] / size), b, normal)) offer(best, height[k] * height[k] / size);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Q& here = height[k];
    const Q& there = height[(k + 1) % 3];
    if (here * there >= 0) continue;
    if (is_inside(along(a[k], minus(a[(k + 1) % 3], a[k]), here / (here - there)), b, normal)) best = 0;
  }
}

}  // namespace

Q slow_squared_distance(const std::array<Vec3d, 3>& first, const std::array<Vec3d, 3>& second) {
  const T a{exact(first[0]), exact(first[1]), exact(first[2])};
  const T b{exact(second[0]), exact(second[1]), exact(second[2])};
  Q best = square(minus(a[0], b[0]));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      offer(best, of_point_and_segment(a[i], b[k], b[(k + 1) % 3]));
      offer(best, of_point_and_segment(b[i], a[k], a[(k + 1) % 3]));
      offer_edges(a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3], best);
    }
  }
  offer_face(a, b, best);
  offer_face(b, a, best);
  return best;
}

}  // namespace blum::test
