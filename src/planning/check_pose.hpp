// Blum: checks of poses. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/geometry/rigid_transform.hpp"

namespace blum::detail {

/// Checks that a pose is a rotation to 1e-9 and a finite translation.
/// @param which  pose in messages, for example "at time 0". @throws InvalidOption.
inline void check_pose(const RigidTransform& pose, const std::string& which) {
  constexpr double most = 1e-9, furthest = 1e70;
  const double error = pose.rotation_error();
  const double far = length(pose.translation);
  if (!(error <= most)) {
    throw InvalidOption("motion: the rotation of the pose " + which + " is not orthonormal to 1e-9: its error is " +
                        exact_text(error));
  }
  if (!(far <= furthest)) {
    throw InvalidOption("motion: the translation of the pose " + which + " must be finite and at most 1e70, not " +
                        exact_text(far));
  }
}

}  // namespace blum::detail
