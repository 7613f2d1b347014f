// Blum: vertices of medial axes while they are made. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// All that is known of a vertex in one place; medial_columns says what the members are.
struct AxisVertex {
  Vec3d position;
  double radius = 0;
  std::array<Vec3d, 2> footprints;
  std::array<SiteId, 2> sites;
  double separation_angle = 0;
};

}  // namespace blum
