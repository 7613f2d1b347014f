#include "blum/planning/rigid_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "blum/core/error.hpp"
#include "planning/check_pose.hpp"

namespace blum {
namespace {

struct AxisAngle {
  Vec3d axis;
  double angle = 0;
};

/// Returns axis and angle of a rotation. The quaternion is computed from its largest component, so it is precise at all
/// angles (Shepperd 1978).
AxisAngle axis_angle_of(const Mat3& m) {
  const auto entry = [&](std::size_t row, std::size_t column) { return m.columns[column][row]; };
  const double trace = entry(0, 0) + entry(1, 1) + entry(2, 2);
  const std::array<double, 4> squares{trace, entry(0, 0), entry(1, 1), entry(2, 2)};
  const auto largest = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  double w = 0;
  Vec3d v;
  if (largest == 0) {
    w = 1 + trace;
    v = {entry(2, 1) - entry(1, 2), entry(0, 2) - entry(2, 0), entry(1, 0) - entry(0, 1)};
  } else {
    const std::size_t i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
    v[i] = 1 + entry(i, i) - entry(j, j) - entry(k, k);
    v[j] = entry(j, i) + entry(i, j);
    v[k] = entry(k, i) + entry(i, k);
    w = entry(k, j) - entry(j, k);
  }
  const double size = length(v);
  if (size == 0) return {{0, 0, 1}, 0};
  const double sign = w < 0 ? -1 : 1;
  return {v * (sign / size), 2 * std::atan2(size, std::abs(w))};
}

/// Returns the rotation by an angle about a unit vector (Rodrigues).
Mat3 rotation_about(const Vec3d& axis, double angle) {
  const double sine = std::sin(angle), versine = 2 * std::sin(angle / 2) * std::sin(angle / 2);
  Mat3 out;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3d unit_k;
    unit_k[k] = 1;
    out.columns[k] = unit_k + cross(axis, unit_k) * sine + cross(axis, cross(axis, unit_k)) * versine;
  }
  return out;
}

}  // namespace

RigidMotion::RigidMotion(const RigidTransform& from, const RigidTransform& to, const Vec3d& centre) : centre_(centre) {
  detail::check_pose(from, "at time 0");
  detail::check_pose(to, "at time 1");
  if (!(length(centre) <= 1e70)) throw InvalidOption("motion: the centre must be finite and within 1e70 of the origin");
  rotation_ = closest_rotation(from.rotation);
  const Mat3 last = closest_rotation(to.rotation);
  start_ = rotation_ * centre + from.translation;
  end_ = last * centre + to.translation;
  Mat3 between;  // in the coordinates of the body
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t row = 0; row < 3; ++row) between.columns[k][row] = dot(rotation_.columns[row], last.columns[k]);
  }
  const AxisAngle turn = axis_angle_of(between);
  axis_ = turn.axis;
  angle_ = turn.angle;
}

RigidTransform RigidMotion::at(double time) const {
  RigidTransform out;
  const Mat3 turn = rotation_about(axis_, angle_ * time);
  for (std::size_t k = 0; k < 3; ++k) out.rotation.columns[k] = rotation_ * turn.columns[k];
  out.translation = start_ + (end_ - start_) * time - out.rotation * centre_;
  return out;
}

double RigidMotion::rounding(double radius) const {
  // Entries of the rotation have an error of at most 40 units of rounding (2^-53). So a point moves by at most 120
  // units of its distance from the origin of the body. Positions of the centre and sums add at most 16 units of their
  // sizes.
  constexpr double unit_of_rounding = 0x1p-53;
  const double from_origin = radius + length(centre_);
  const double in_scene = std::max(length(start_), length(end_));
  return unit_of_rounding * (240 * from_origin + 32 * in_scene);
}

}  // namespace blum
