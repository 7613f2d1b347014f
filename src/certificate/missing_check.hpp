// Blum: whether an axis has all that a solid shows, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/context.hpp"
#include "certificate/allowances.hpp"
#include "certificate/sampling.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// Balls in the middle between two walls that see these at an angle, and how far they are from an axis.
struct FoundBalls {
  Offsets all;                  ///< from random points of the whole solid
  std::vector<Offsets> bodies;  ///< from random points of each body, by its surface where it has triangles
};

/// Grows balls from random points, the same in every run. @param theta  degrees.  @param sought  the least angle.
/// @throws Cancelled.
[[nodiscard]] FoundBalls find_balls(const MedialView& axis, const KnownSolid& solid, const Allowances& allowed,
                                    double theta, double sought, const Context& context);

}  // namespace blum::verifier
