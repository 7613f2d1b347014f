// Blum: one curve in the middle of a tube. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/core/vec3.hpp"
#include "medial_axis/centreline/sections.hpp"

namespace blum::centrelines {

/// How a curve ends.
struct CurveEnd {
  enum class Kind : std::uint8_t { free, junction, closed };
  Kind kind = Kind::free;
  Vec3d centre{};     ///< of a junction's ball
  double radius = 0;  ///< likewise
};

/// Points outside of the balls of its junctions: at least one. Of a closed curve the first is also the last.
struct Curve {
  std::vector<Vec3d> points;
  std::vector<double> radii;  ///< of the circle with the area of the section there
};

/// @param voxels  the centres of a chain, from end to end.
/// @param reach   no point is moved further from these.
[[nodiscard]] Curve make_curve(const std::vector<Vec3d>& voxels, const std::array<CurveEnd, 2>& ends,
                               const LabelShare& label, double reach);

}  // namespace blum::centrelines
