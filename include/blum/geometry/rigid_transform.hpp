// Blum: rotations with translations. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "blum/core/vec3.hpp"

namespace blum {

/// Map of a point p to rotation * p + translation.
struct RigidTransform {
  Mat3 rotation;  ///< columns of length 1, at right angles
  Vec3d translation;

  [[nodiscard]] constexpr Vec3d operator()(const Vec3d& p) const { return rotation * p + translation; }

  /// Returns the deviation of the rotation from an orthonormal matrix. The deviation is the largest error of squared
  /// column lengths (from 1) and of dot products of columns (from 0).
  [[nodiscard]] double rotation_error() const {
    double error = 0;
    const auto& c = rotation.columns;
    for (std::size_t k = 0; k < 3; ++k) {
      error = std::max({error, std::abs(dot(c[k], c[k]) - 1), std::abs(dot(c[k], c[(k + 1) % 3]))});
    }
    return error;
  }

  /// Returns the inverse transform.
  [[nodiscard]] constexpr RigidTransform inverse() const {
    RigidTransform out;
    for (std::size_t k = 0; k < 3; ++k) {
      out.rotation.columns[k] = {rotation.columns[0][k], rotation.columns[1][k], rotation.columns[2][k]};
    }
    out.translation = -(out.rotation * translation);
    return out;
  }

  /// Returns the transform that applies `first`, then `then`.
  [[nodiscard]] friend constexpr RigidTransform operator*(const RigidTransform& then, const RigidTransform& first) {
    RigidTransform out;
    for (std::size_t k = 0; k < 3; ++k) out.rotation.columns[k] = then.rotation * first.rotation.columns[k];
    out.translation = then(first.translation);
    return out;
  }

  [[nodiscard]] friend constexpr bool operator==(const RigidTransform&, const RigidTransform&) = default;
};

/// Returns the rotation closest to a matrix. The matrix should be a rotation up to rounding, for example from a pose in
/// single precision.
/// @throws InvalidOption if the error of the matrix (RigidTransform::rotation_error) is above 0.1, or if the matrix
/// mirrors.
[[nodiscard]] Mat3 closest_rotation(const Mat3& matrix);

}  // namespace blum
