// Loops over the lanes of a block, vectorised by the compiler. With Highway, they are compiled once per instruction
// set, and the machine's best instruction set is chosen at program start. Without Highway (BLUM_SIMD=OFF, or not
// installed) they are compiled once, for instructions that every machine has.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#ifdef BLUM_HIGHWAY
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)  // would not make loops of doubles faster
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/bvh/lane_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#else
#define HWY_BEFORE_NAMESPACE() static_assert(true)
#define HWY_AFTER_NAMESPACE() static_assert(true)
#define HWY_NAMESPACE baseline
#define HWY_ONCE 1
#endif

#include "blum/geometry/orient3d.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/bvh/moving_block.hpp"
#include "geometry/bvh/primitive_block.hpp"
#include "geometry/bvh/triangle_group.hpp"
#include "geometry/winding/near_angle.hpp"
#include "geometry/winding/winding_tree.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::HWY_NAMESPACE {
namespace {

void squared_distances(const BoxBlock& block, const Vec3d& query, double (&out)[lanes]) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = std::max(std::max(block.lower[0][i] - query.x, query.x - block.upper[0][i]), 0.0);
    const double y = std::max(std::max(block.lower[1][i] - query.y, query.y - block.upper[1][i]), 0.0);
    const double z = std::max(std::max(block.lower[2][i] - query.z, query.z - block.upper[2][i]), 0.0);
    out[i] = x * x + y * y + z * z;
  }
}

void entries(const BoxBlock& block, const Ray& ray, const Vec3d& inverse, double (&out)[lanes]) {
  // Widens the slabs of boxes. Each end of a slab is rounded three times; a factor of 1 + 2 gamma(3) at one end
  // compensates for this (Ize 2013).
  constexpr double widened = 1 + 2e-15;
  alignas(64) double enter[lanes] = {};
  alignas(64) double leave[lanes];
  for (std::size_t i = 0; i < lanes; ++i) leave[i] = block.lower[0][i] <= block.upper[0][i] ? HUGE_VAL : -1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin[axis];
    const double factor = inverse[axis];
    if (factor == 0) {
      for (std::size_t i = 0; i < lanes; ++i) {
        const double outside = std::max(block.lower[axis][i] - origin, origin - block.upper[axis][i]);
        leave[i] = outside > 0 ? -1 : leave[i];
      }
      continue;
    }
    for (std::size_t i = 0; i < lanes; ++i) {
      const double first = (block.lower[axis][i] - origin) * factor;
      const double last = (block.upper[axis][i] - origin) * factor;
      enter[i] = std::max(enter[i], std::min(first, last) * (2 - widened));
      leave[i] = std::min(leave[i], std::max(first, last) * widened);
    }
  }
  for (std::size_t i = 0; i < lanes; ++i) out[i] = enter[i] <= leave[i] ? enter[i] : NAN;
}

/// Returns one bit per lane, set if the lane's flag is 1. All other flags must be 0.
inline unsigned bits_of(const double (&flags)[lanes]) {
  static_assert(lanes == 8);
  alignas(64) constexpr double weights[lanes] = {1, 2, 4, 8, 16, 32, 64, 128};
  double sum[4];
  for (std::size_t i = 0; i < 4; ++i) sum[i] = flags[i] * weights[i] + flags[i + 4] * weights[i + 4];
  return static_cast<unsigned>((sum[0] + sum[1]) + (sum[2] + sum[3]));
}

/// Returns 1 if two boxes touch, else 0. The result is a product of single comparisons, because with `&&` the compiler
/// branches instead of vectorising.
inline double touch(const BoxBlock& block, std::size_t i, const Box3& box) {
  double all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    all *= block.lower[axis][i] <= box.upper[axis] ? 1.0 : 0.0;
    all *= block.upper[axis][i] >= box.lower[axis] ? 1.0 : 0.0;
  }
  return all;
}

unsigned touching(const BoxBlock& block, const Box3& box) {
  alignas(64) double meet[lanes];
  for (std::size_t i = 0; i < lanes; ++i) meet[i] = touch(block, i, box);
  return bits_of(meet);
}

unsigned touching_moving(const MovingBlock& block, const MovingBoxF& box) {
  alignas(64) float gap[lanes];  // largest gap along any axis that is open both at the start and at the end
  std::fill_n(gap, lanes, -1.0F);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const float above =
          std::min(block.lower[0][axis][i] - box.upper[0][axis], block.lower[1][axis][i] - box.upper[1][axis]);
      const float below =
          std::min(box.lower[0][axis] - block.upper[0][axis][i], box.lower[1][axis] - block.upper[1][axis][i]);
      gap[i] = std::max(gap[i], std::max(above, below));
    }
  }
  alignas(64) float meet[lanes];
  for (std::size_t i = 0; i < lanes; ++i) meet[i] = gap[i] > 0 ? 0.0F : static_cast<float>(1U << i);
  const float sum = ((meet[0] + meet[1]) + (meet[2] + meet[3])) + ((meet[4] + meet[5]) + (meet[6] + meet[7]));
  return static_cast<unsigned>(sum);
}

/// Returns 1 if all corners of a triangle, except common ones, lie on one side of the other triangle's plane. Then the
/// two triangles share only their common corners. Returns 0 if rounding (the error bound of orient3d) makes this
/// uncertain. The function adds flags, because the compiler splits maxima into scalar code.
inline double is_beside(const TriangleGroup& group, std::size_t i, const GroupTriangle& other) {
  double above = 1;
  double below = 1;
  double all_common = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = group.point[k][0][i] - other.points[0].x;
    const double y = group.point[k][1][i] - other.points[0].y;
    const double z = group.point[k][2][i] - other.points[0].z;
    const double height = other.normal.x * x + other.normal.y * y + other.normal.z * z;
    const double bound =
        detail::orient3d_rounding *
        (other.magnitude.x * std::abs(x) + other.magnitude.y * std::abs(y) + other.magnitude.z * std::abs(z));
    const double number = group.corner[k][i];
    double is_common = 0;  // at most one of the terms is 1; then the height is 0 up to rounding
    for (std::size_t j = 0; j < 3; ++j) is_common += number == other.corners[j] ? 1.0 : 0.0;
    above *= is_common + (height > bound ? 1.0 : 0.0);
    below *= is_common + (height < -bound ? 1.0 : 0.0);
    all_common *= is_common;
  }
  return above + below - 2 * all_common;
}

unsigned may_meet(const TriangleGroup& group, const GroupTriangle& triangle) {
  alignas(64) double meet[lanes];
  for (std::size_t i = 0; i < lanes; ++i) meet[i] = touch(group.box, i, triangle.box);
  if (bits_of(meet) == 0) return 0;
  for (std::size_t i = 0; i < lanes; ++i) meet[i] *= 1 - is_beside(group, i, triangle);
  return bits_of(meet);
}

/// Error bounds, with a margin, for sums of products of three rounded factors (as in orient3d). The second bound covers
/// products so small that they lose digits.
constexpr double triple_rounding = 1e-14;
constexpr double least_product = 1e-300;

/// Returns 1 if a value is certainly above 0, else 0.
inline double is_above(double value, double magnitude) {
  return value > triple_rounding * magnitude + least_product ? 1.0 : 0.0;
}

/// Sum of products, and the sum of their magnitudes.
struct Rounded {
  double value;
  double magnitude;
};

/// Returns d . (u x v).
inline Rounded triple(const Vec3d& d, const Vec3d& u, const Vec3d& v) {
  const double xy = u.x * v.y, yx = u.y * v.x, yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z;
  return {d.x * (yz - zy) + d.y * (zx - xz) + d.z * (xy - yx), std::abs(d.x) * (std::abs(yz) + std::abs(zy)) +
                                                                   std::abs(d.y) * (std::abs(zx) + std::abs(xz)) +
                                                                   std::abs(d.z) * (std::abs(xy) + std::abs(yx))};
}

inline Vec3d corner_at(const PrimitiveBlock& block, std::size_t k, std::size_t i) {
  return {block.corner[k][0][i], block.corner[k][1][i], block.corner[k][2][i]};
}

unsigned may_cross(const PrimitiveBlock& block, const Ray& ray, double end) {
  const Vec3d o = ray.origin;
  const Vec3d d = ray.direction;
  alignas(64) double meet[lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    // Heights of the ray's origin and end above the triangle's plane, multiplied by twice the triangle's area.
    const Vec3d u = corner_at(block, 0, i) - o;
    const Vec3d ab = (corner_at(block, 1, i) - o) - u;
    const Vec3d ac = (corner_at(block, 2, i) - o) - u;
    const Rounded start = triple(u, ab, ac);
    const Rounded slope = triple(d, ab, ac);
    const double last = end * slope.value - start.value;
    const double bound = end * slope.magnitude + start.magnitude;
    const double above = is_above(-start.value, start.magnitude) * is_above(last, bound);
    const double below = is_above(start.value, start.magnitude) * is_above(-last, bound);
    meet[i] = above + below > 0 ? 0.0 : 1.0;
  }
  // Return early, because short rays rarely pass through any of the planes.
  if (bits_of(meet) == 0) return 0;
  for (std::size_t i = 0; i < lanes; ++i) {
    const Vec3d u = corner_at(block, 0, i) - o;
    const Vec3d v = corner_at(block, 1, i) - o;
    const Vec3d w = corner_at(block, 2, i) - o;
    const Rounded uv = triple(d, u, v), vw = triple(d, v, w), wu = triple(d, w, u);
    const double left =
        is_above(uv.value, uv.magnitude) + is_above(vw.value, vw.magnitude) + is_above(wu.value, wu.magnitude);
    const double right =
        is_above(-uv.value, uv.magnitude) + is_above(-vw.value, vw.magnitude) + is_above(-wu.value, wu.magnitude);
    meet[i] *= left * right > 0 ? 0.0 : 1.0;
  }
  return bits_of(meet);
}

/// Returns 1 if the bounding box of a triangle touches a given box, else 0.
inline double touch_around(const Vec3d& u, const Vec3d& v, const Vec3d& w, const Box3& box) {
  double all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    all *= std::min(std::min(u[axis], v[axis]), w[axis]) <= box.upper[axis] ? 1.0 : 0.0;
    all *= std::max(std::max(u[axis], v[axis]), w[axis]) >= box.lower[axis] ? 1.0 : 0.0;
  }
  return all;
}

unsigned may_reach(const PrimitiveBlock& block, const Box3& box) {
  const Vec3d centre = (box.lower + box.upper) * 0.5;
  const Vec3d half = max(box.upper - centre, centre - box.lower);
  alignas(64) double meet[lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    const Vec3d u = corner_at(block, 0, i);
    const Vec3d v = corner_at(block, 1, i);
    const Vec3d w = corner_at(block, 2, i);
    const double touch = touch_around(u, v, w, box);
    // `reach` is the largest distance of a corner of the box from its centre along the triangle's normal, times the
    // normal's length.
    const Vec3d ab = v - u;
    const Vec3d ac = w - u;
    const double x = std::abs(ab.y * ac.z) + std::abs(ab.z * ac.y);
    const double y = std::abs(ab.z * ac.x) + std::abs(ab.x * ac.z);
    const double z = std::abs(ab.x * ac.y) + std::abs(ab.y * ac.x);
    const double reach = std::abs(ab.y * ac.z - ab.z * ac.y) * half.x + std::abs(ab.z * ac.x - ab.x * ac.z) * half.y +
                         std::abs(ab.x * ac.y - ab.y * ac.x) * half.z;
    const Rounded height = triple(centre - u, ab, ac);
    const double beside =
        is_above(std::abs(height.value) - reach, height.magnitude + x * half.x + y * half.y + z * half.z);
    meet[i] = touch * (1 - beside);
  }
  return bits_of(meet);
}

unsigned may_meet_block(const PrimitiveBlock& block, const ProbeTriangle& other) {
  const auto& [a, b, c] = other.corners;
  alignas(64) double meet[lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    const Vec3d u = corner_at(block, 0, i);
    const Vec3d v = corner_at(block, 1, i);
    const Vec3d w = corner_at(block, 2, i);
    const double touch = touch_around(u, v, w, other.box);
    double above = 1;
    double below = 1;
    const auto look = [&](double height, double magnitude) {
      above *= is_above(height, magnitude);
      below *= is_above(-height, magnitude);
    };
    const auto look_at_corner = [&](const Vec3d& p) {
      const double x = p.x - a.x, y = p.y - a.y, z = p.z - a.z;
      look(other.normal.x * x + other.normal.y * y + other.normal.z * z,
           other.magnitude.x * std::abs(x) + other.magnitude.y * std::abs(y) + other.magnitude.z * std::abs(z));
    };
    look_at_corner(u);
    look_at_corner(v);
    look_at_corner(w);
    const double beside = above + below;
    above = 1;
    below = 1;
    const auto look_from_corner = [&](const Vec3d& p) {
      const Rounded height = triple(p - u, v - u, w - u);
      look(height.value, height.magnitude);
    };
    look_from_corner(a);
    look_from_corner(b);
    look_from_corner(c);
    meet[i] = beside + above + below > 0 ? 0.0 : touch;
  }
  return bits_of(meet);
}

void approximate_distances(const PrimitiveBlock& block, const Vec3d& query, double (&out)[lanes]) {
  const auto& p = block.corner;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double abx = p[1][0][i] - p[0][0][i], aby = p[1][1][i] - p[0][1][i], abz = p[1][2][i] - p[0][2][i];
    const double acx = p[2][0][i] - p[0][0][i], acy = p[2][1][i] - p[0][1][i], acz = p[2][2][i] - p[0][2][i];
    const double bcx = acx - abx, bcy = acy - aby, bcz = acz - abz;
    const double ax = query.x - p[0][0][i], ay = query.y - p[0][1][i], az = query.z - p[0][2][i];
    const double bx = query.x - p[1][0][i], by = query.y - p[1][1][i], bz = query.z - p[1][2][i];
    const double ab2 = abx * abx + aby * aby + abz * abz;
    const double ac2 = acx * acx + acy * acy + acz * acz;
    const double bc2 = bcx * bcx + bcy * bcy + bcz * bcz;
    constexpr double least = 1e-300;  // an edge of length zero gets t = 0
    const double dab = ax * abx + ay * aby + az * abz;
    const double dac = ax * acx + ay * acy + az * acz;
    const double dbc = bx * bcx + by * bcy + bz * bcz;
    const double tab = std::min(std::max(dab / std::max(ab2, least), 0.0), 1.0);
    const double tac = std::min(std::max(dac / std::max(ac2, least), 0.0), 1.0);
    const double tbc = std::min(std::max(dbc / std::max(bc2, least), 0.0), 1.0);
    const double x1 = ax - tab * abx, y1 = ay - tab * aby, z1 = az - tab * abz;
    const double x2 = ax - tac * acx, y2 = ay - tac * acy, z2 = az - tac * acz;
    const double x3 = bx - tbc * bcx, y3 = by - tbc * bcy, z3 = bz - tbc * bcz;
    const double border =
        std::min(std::min(x1 * x1 + y1 * y1 + z1 * z1, x2 * x2 + y2 * y2 + z2 * z2), x3 * x3 + y3 * y3 + z3 * z3);
    const double nx = aby * acz - abz * acy, ny = abz * acx - abx * acz, nz = abx * acy - aby * acx;
    const double n2 = nx * nx + ny * ny + nz * nz;
    // Barycentric coordinates of q, multiplied by n2: (n x ab) . aq and so on.
    const double over_c = (ny * abz - nz * aby) * ax + (nz * abx - nx * abz) * ay + (nx * aby - ny * abx) * az;
    const double over_b = -((ny * acz - nz * acy) * ax + (nz * acx - nx * acz) * ay + (nx * acy - ny * acx) * az);
    const double height = nx * ax + ny * ay + nz * az;
    const double plane = height * height / std::max(n2, least);
    const double inside = std::min(std::min(over_b, over_c), n2 - over_b - over_c);
    const double squared = inside > 0 ? std::min(plane, border) : border;
    out[i] = std::sqrt(squared) - block.sliver_altitude[i];
  }
}

/// Returns the first three terms of the multipole series, in steradians. (x, y, z) is the vector from the query to the
/// centre.
inline double series(const MultipoleBlock& b, std::size_t i, double x, double y, double z, double inverse_squared,
                     double inverse) {
  const double xx = x * x, yy = y * y, zz = z * z;
  const double first = b.dipole[0][i] * x + b.dipole[1][i] * y + b.dipole[2][i] * z;
  const double second = b.quadrupole[0][i] * (xx - zz) + b.quadrupole[1][i] * (yy - zz) + b.quadrupole[2][i] * x * y +
                        (b.quadrupole[3][i] * x + b.quadrupole[4][i] * y) * z;
  const double third =
      x * (b.octupole[0][i] * (xx - 3 * zz) + b.octupole[2][i] * (yy - zz)) +
      y * (b.octupole[1][i] * (yy - 3 * zz) + b.octupole[3][i] * (xx - zz)) +
      z * (b.octupole[4][i] * (3 * xx - zz) + b.octupole[5][i] * (3 * yy - zz) + b.octupole[6][i] * x * y);
  const double inverse_cubed = inverse_squared * inverse;
  return inverse_cubed * (first + inverse_squared * (second + inverse_squared * third));
}

// The kernel of the solid angle is n . (x - q) / |x - q|^3. It is the normal derivative of 1 / |x - q|, which is
// expanded in a harmonic series about the centre. Let R be the distance of the query q from the centre, and s = x -
// centre. The term of degree l is at most l |s|^(l-1) / R^(l+1) (Laplace's integral for Legendre polynomials). With t =
// radius / R, the terms of degree 4 and higher sum to at most (integral of |s|^3) / R^5 (4 - 3 t) / (1 - t)^2.
void add_clusters(const MultipoleBlock& block, const Vec3d& query, double tolerance, FarSum& sum, OpenLanes& others) {
  // The results are first stored in local arrays. These cannot alias the block, so the loop vectorises without checks
  // for overlap.
  alignas(64) double taken_angle[lanes];
  alignas(64) double taken_error[lanes];
  alignas(64) double open[lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = block.center[0][i] - query.x;
    const double y = block.center[1][i] - query.y;
    const double z = block.center[2][i] - query.z;
    const double inverse = 1 / std::sqrt(std::max(x * x + y * y + z * z, 1e-60));
    const double inverse_squared = inverse * inverse;
    const double value = series(block, i, x, y, z, inverse_squared, inverse);
    const double rest = 1 - block.radius[i] * inverse;
    const double safe_rest = std::max(rest, 1e-3);
    const double bound =
        block.cubed[i] * inverse_squared * inverse_squared * inverse * (1 + 3 * safe_rest) / (safe_rest * safe_rest);
    // If the query is too close, the series does not converge, and the penalty makes the error bound huge. There are no
    // branches, so that the loop vectorises.
    const double penalty = std::max(1e-3 - rest, 0.0) * 1e300;
    const double taken = bound + penalty <= tolerance ? 1.0 : 0.0;
    taken_angle[i] = taken * value;
    taken_error[i] = taken * bound;
    open[i] = 1 - taken;
  }
  for (std::size_t i = 0; i < lanes; ++i) {
    sum.solid_angle[i] += taken_angle[i];
    sum.error[i] += taken_error[i];
    others.open[i] = open[i];
  }
}

void add_clusters_beyond(const MultipoleBlock& block, const Vec3d& query, double beta, FarSum& sum, OpenLanes& others) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = block.center[0][i] - query.x;
    const double y = block.center[1][i] - query.y;
    const double z = block.center[2][i] - query.z;
    const double inverse = 1 / std::sqrt(std::max(x * x + y * y + z * z, 1e-60));
    const double value = series(block, i, x, y, z, inverse * inverse, inverse);
    // Lanes without a cluster have radius 0, so they are taken for every beta.
    const double taken = block.radius[i] * beta * inverse >= 1 ? 0.0 : 1.0;
    sum.solid_angle[i] += taken * value;
    others.open[i] = 1 - taken;
  }
}

/// If both the sine and the cosine are below this fraction of the sum of their terms' magnitudes, rounding may lose
/// half of the digits.
constexpr double near_edges = 1e-5;

/// Recomputes more accurately the angles of the lanes that `is_near` marks.
inline void look_closely(const TriangleBlock& block, const Vec3d& query, const double (&is_near)[lanes],
                         double (&cosine)[lanes], double (&sine)[lanes]) {
  for (std::size_t i = 0; i < lanes; ++i) {
    if (is_near[i] == 0) continue;
    const auto corner = [&](std::size_t k) {
      return Vec3d{block.corner[k][0][i], block.corner[k][1][i], block.corner[k][2][i]};
    };
    const HalfAngle found = half_solid_angle_nearby({corner(0), corner(1), corner(2)}, query);
    cosine[i] = found.cosine;
    sine[i] = found.sine;
  }
}

template <bool is_watched>
inline void add_angles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum,
                       [[maybe_unused]] double* watched) {
  const auto& p = block.corner;
  alignas(64) double cosine[lanes];  // cosine of half the angle, times a factor that `sine` shares
  alignas(64) double sine[lanes];
  alignas(64) double largest[lanes];  // magnitude of the terms of sine and cosine
  alignas(64) double is_near[lanes];  // 1 if sine and cosine are both small against their terms
  for (std::size_t i = 0; i < lanes; ++i) {
    const double ax = p[0][0][i] - query.x, ay = p[0][1][i] - query.y, az = p[0][2][i] - query.z;
    const double bx = p[1][0][i] - query.x, by = p[1][1][i] - query.y, bz = p[1][2][i] - query.z;
    const double cx = p[2][0][i] - query.x, cy = p[2][1][i] - query.y, cz = p[2][2][i] - query.z;
    const double ux = p[1][0][i] - p[0][0][i], uy = p[1][1][i] - p[0][1][i], uz = p[1][2][i] - p[0][2][i];
    const double vx = p[2][0][i] - p[0][0][i], vy = p[2][1][i] - p[0][1][i], vz = p[2][2][i] - p[0][2][i];
    const double la = std::sqrt(ax * ax + ay * ay + az * az);
    const double lb = std::sqrt(bx * bx + by * by + bz * bz);
    const double lc = std::sqrt(cx * cx + cy * cy + cz * cz);
    // a . (b x c) equals a . (u x v). This form with edges u and v stays accurate if the query is far away.
    const double y = ax * (uy * vz - uz * vy) + ay * (uz * vx - ux * vz) + az * (ux * vy - uy * vx);
    const double x = la * lb * lc + (ax * bx + ay * by + az * bz) * lc + (bx * cx + by * cy + bz * cz) * la +
                     (cx * ax + cy * ay + cz * az) * lb;
    cosine[i] = x;
    sine[i] = y;
    largest[i] = la * lb * lc;
    // Magnitude of the sine's terms. Unlike `largest`, it stays large if the query is close to two corners.
    const double edges =
        (std::abs(ux) + std::abs(uy) + std::abs(uz)) * (std::abs(vx) + std::abs(vy) + std::abs(vz)) * la;
    is_near[i] = std::abs(x) + std::abs(y) < near_edges * std::max(largest[i], edges) ? 1.0 : 0.0;
  }
  if (std::accumulate(is_near, is_near + lanes, 0.0) > 0) look_closely(block, query, is_near, cosine, sine);
  for (std::size_t i = 0; i < lanes; ++i) {
    const double size = std::abs(cosine[i]) + std::abs(sine[i]);
    const double inverse = 1 / size;
    const double zx = size > 0 ? cosine[i] * inverse : 1.0;
    const double zy = size > 0 ? sine[i] * inverse : 0.0;
    const double px = sum.re[i] * zx - sum.im[i] * zy;
    const double py = sum.re[i] * zy + sum.im[i] * zx;
    const double up = sum.im[i] >= 0 ? 1.0 : 0.0;
    const double also_up = zy >= 0 ? 1.0 : 0.0;
    const double now_up = py >= 0 ? 1.0 : 0.0;
    // Counts full turns. Adds 1 if both factors are in the upper half plane and the product is not. Subtracts 1 in the
    // same case for the lower half plane.
    sum.turns[i] += up * also_up * (1 - now_up) - (1 - up) * (1 - also_up) * now_up;
    // Keeps the magnitude of the product near 1: after scaling, each factor's magnitude is between 1/sqrt(2) and 1.
    const double magnitude = 1 / (std::abs(px) + std::abs(py));
    sum.re[i] = px * magnitude;
    sum.im[i] = py * magnitude;
    if constexpr (is_watched) watched[i] += largest[i] * inverse;
  }
}

void add_triangles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum) {
  add_angles<false>(block, query, sum, nullptr);
}

void add_watched_triangles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum,
                           double (&inverse)[lanes]) {
  // Local array: it cannot alias the block, so the loop vectorises without checks for overlap.
  alignas(64) double watched[lanes] = {};
  add_angles<true>(block, query, sum, watched);
  for (std::size_t i = 0; i < lanes; ++i) inverse[i] += watched[i];
}

}  // namespace
}  // namespace blum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "geometry/bvh/kernel_tables.hpp"

namespace blum {
namespace {

BLUM_KERNEL(squared_distances);
BLUM_KERNEL(entries);
BLUM_KERNEL(may_cross);
BLUM_KERNEL(may_reach);
BLUM_KERNEL(may_meet_block);
BLUM_KERNEL(touching);
BLUM_KERNEL(touching_moving);
BLUM_KERNEL(may_meet);
BLUM_KERNEL(approximate_distances);
BLUM_KERNEL(add_clusters);
BLUM_KERNEL(add_clusters_beyond);
BLUM_KERNEL(add_triangles);
BLUM_KERNEL(add_watched_triangles);

}  // namespace

void squared_distances(const BoxBlock& block, const Vec3d& query, double (&out)[lanes]) {
  best_squared_distances(block, query, out);
}

void entries(const BoxBlock& block, const Ray& ray, const Vec3d& inverse, double (&out)[lanes]) {
  best_entries(block, ray, inverse, out);
}

unsigned may_cross(const PrimitiveBlock& block, const Ray& ray, double end) {
  return best_may_cross(block, ray, end);
}

unsigned may_reach(const PrimitiveBlock& block, const Box3& box) {
  return best_may_reach(block, box);
}

unsigned may_meet(const PrimitiveBlock& block, const ProbeTriangle& other) {
  return best_may_meet_block(block, other);
}

unsigned touching(const BoxBlock& block, const Box3& box) {
  return best_touching(block, box);
}

unsigned touching(const MovingBlock& block, const MovingBoxF& box) {
  return best_touching_moving(block, box);
}

unsigned may_meet(const TriangleGroup& group, const GroupTriangle& triangle) {
  return best_may_meet(group, triangle);
}

void approximate_distances(const PrimitiveBlock& block, const Vec3d& query, double (&out)[lanes]) {
  best_approximate_distances(block, query, out);
}

void add_clusters(const MultipoleBlock& block, const Vec3d& query, double tolerance, FarSum& sum, OpenLanes& others) {
  best_add_clusters(block, query, tolerance, sum, others);
}

void add_clusters_beyond(const MultipoleBlock& block, const Vec3d& query, double beta, FarSum& sum, OpenLanes& others) {
  best_add_clusters_beyond(block, query, beta, sum, others);
}

void add_triangles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum) {
  best_add_triangles(block, query, sum);
}

void add_watched_triangles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum,
                           double (&inverse)[lanes]) {
  best_add_watched_triangles(block, query, sum, inverse);
}

}  // namespace blum
#endif  // HWY_ONCE
