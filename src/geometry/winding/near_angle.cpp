#include "geometry/winding/near_angle.hpp"

#include <cmath>

#include "geometry/predicates/double2_rows.hpp"

namespace blum {
namespace {

using detail::Double2;
using detail::product;
using detail::Row;
using detail::row;
using detail::sum;

Double2 dot(const Row& a, const Row& b) {
  return sum(sum(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]));
}

Double2 length(const Row& a) {
  const Double2 squared = dot(a, a);
  if (!(squared.high > 0)) return {};
  const double rough = std::sqrt(squared.high);
  const Double2 all = product({rough, 0}, {rough, 0});
  const Double2 rest = sum(squared, {-all.high, -all.low});
  return detail::quick_sum(rough, rest.high / (2 * rough));
}

}  // namespace

HalfAngle half_solid_angle_nearby(const std::array<Vec3d, 3>& corners, const Vec3d& point) {
  const Row a = row(corners[0], point);
  const Row b = row(corners[1], point);
  const Row c = row(corners[2], point);
  const Double2 length_a = length(a);
  const Double2 length_b = length(b);
  const Double2 length_c = length(c);
  const Double2 all = product(product(length_a, length_b), length_c);
  const Double2 ab_and_bc = sum(product(dot(a, b), length_c), product(dot(b, c), length_a));
  const Double2 cosine = sum(sum(all, ab_and_bc), product(dot(c, a), length_b));
  return {cosine.high, determinant(a, row(corners[1], corners[0]), row(corners[2], corners[0]))};
}

}  // namespace blum
