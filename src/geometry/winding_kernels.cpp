#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/winding_tree.hpp"

namespace blum {
namespace {

/// The first three terms of the multipole series, in steradians; d points from the query to the centre.
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

}  // namespace

// The kernel of the solid angle, n . (x - q) / |x - q|^3, is the normal derivative of the harmonic series of
// 1 / |x - q| about the centre. Its term of degree l is at most l |s|^(l-1) / R^(l+1) (Laplace's integral for Legendre
// polynomials), R the distance of the query from the centre. With t = radius / R, the terms from l = 4 on add up to at
// most (integral of |s|^3) / R^5 (4 - 3 t) / (1 - t)^2.
BLUM_LANE_LOOPS void add_clusters(const MultipoleBlock& block, const Vec3d& query, double tolerance, FarSum& sum,
                                  OpenLanes& others) {
  // Local arrays, which cannot overlap the block, so that the loop vectorises without checks.
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
    // Too close, the series does not converge. Factors instead of branches, again for the vectoriser.
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

BLUM_LANE_LOOPS void add_clusters_beyond(const MultipoleBlock& block, const Vec3d& query, double beta, FarSum& sum,
                                         OpenLanes& others) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = block.center[0][i] - query.x;
    const double y = block.center[1][i] - query.y;
    const double z = block.center[2][i] - query.z;
    const double inverse = 1 / std::sqrt(std::max(x * x + y * y + z * z, 1e-60));
    const double value = series(block, i, x, y, z, inverse * inverse, inverse);
    // Lanes without a cluster have no radius, and are taken whatever beta is.
    const double taken = block.radius[i] * beta * inverse >= 1 ? 0.0 : 1.0;
    sum.solid_angle[i] += taken * value;
    others.open[i] = 1 - taken;
  }
}

SolidAngleSum::SolidAngleSum() {
  std::fill(re, re + lanes, 1.0);
  std::fill(im, im + lanes, 0.0);
  std::fill(turns, turns + lanes, 0.0);
}

double SolidAngleSum::winding_number() const {
  double x = re[0], y = im[0], sum = turns[0];
  for (std::size_t i = 1; i < lanes; ++i) {
    const double px = x * re[i] - y * im[i];
    const double py = x * im[i] + y * re[i];
    if (y >= 0 && im[i] >= 0 && py < 0) sum += 1;
    if (y < 0 && im[i] < 0 && py >= 0) sum -= 1;
    sum += turns[i];
    x = px;
    y = py;
  }
  return sum + std::atan2(y, x) / (2 * std::numbers::pi);
}

BLUM_LANE_LOOPS void add_triangles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum) {
  const auto& p = block.corner;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double ax = p[0][0][i] - query.x, ay = p[0][1][i] - query.y, az = p[0][2][i] - query.z;
    const double bx = p[1][0][i] - query.x, by = p[1][1][i] - query.y, bz = p[1][2][i] - query.z;
    const double cx = p[2][0][i] - query.x, cy = p[2][1][i] - query.y, cz = p[2][2][i] - query.z;
    const double ux = p[1][0][i] - p[0][0][i], uy = p[1][1][i] - p[0][1][i], uz = p[1][2][i] - p[0][2][i];
    const double vx = p[2][0][i] - p[0][0][i], vy = p[2][1][i] - p[0][1][i], vz = p[2][2][i] - p[0][2][i];
    const double la = std::sqrt(ax * ax + ay * ay + az * az);
    const double lb = std::sqrt(bx * bx + by * by + bz * bz);
    const double lc = std::sqrt(cx * cx + cy * cy + cz * cz);
    // a . (b x c) = a . (u x v): with edges it loses nothing to the distance.
    const double y = ax * (uy * vz - uz * vy) + ay * (uz * vx - ux * vz) + az * (ux * vy - uy * vx);
    const double x = la * lb * lc + (ax * bx + ay * by + az * bz) * lc + (bx * cx + by * cy + bz * cz) * la +
                     (cx * ax + cy * ay + cz * az) * lb;
    const double size = std::abs(x) + std::abs(y);
    const double inverse = 1 / size;
    const double zx = size > 0 ? x * inverse : 1.0;
    const double zy = size > 0 ? y * inverse : 0.0;
    const double px = sum.re[i] * zx - sum.im[i] * zy;
    const double py = sum.re[i] * zy + sum.im[i] * zx;
    const double up = sum.im[i] >= 0 ? 1.0 : 0.0;
    const double also_up = zy >= 0 ? 1.0 : 0.0;
    const double now_up = py >= 0 ? 1.0 : 0.0;
    // +1 where both were in the upper half and the product is not; -1 where both were below and it is above.
    sum.turns[i] += up * also_up * (1 - now_up) - (1 - up) * (1 - also_up) * now_up;
    // Keep the size of the product near 1: each factor is between 1/sqrt(2) and 1.
    const double magnitude = 1 / (std::abs(px) + std::abs(py));
    sum.re[i] = px * magnitude;
    sum.im[i] = py * magnitude;
  }
}

}  // namespace blum
