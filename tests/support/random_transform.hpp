// Blum: random rigid transforms. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/random.hpp"
#include "blum/geometry/rigid_transform.hpp"

namespace blum::test {

/// A rotation, and a translation by up to `far`.
inline RigidTransform random_transform(Random& random, double far) {
  RigidTransform out;
  auto& c = out.rotation.columns;
  c[0] = random.in_ball();
  c[0] = c[0] / length(c[0]);
  c[1] = cross(c[0], random.in_ball());
  c[1] = c[1] / length(c[1]);
  c[2] = cross(c[0], c[1]);
  out.translation = random.in_ball() * far;
  return out;
}

}  // namespace blum::test
