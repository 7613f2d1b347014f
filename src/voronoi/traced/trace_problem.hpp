// Blum: reasons why a diagram cannot be traced. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "blum/core/vec3.hpp"

namespace blum::voronoi {

/// Stops the tracing of a diagram. Never leaves traced_structure().
struct TraceProblem {
  std::string text;
  Vec3d place;  ///< relative to TracedSites::origin()
};

}  // namespace blum::voronoi
