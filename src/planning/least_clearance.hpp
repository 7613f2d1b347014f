// Blum: the smallest distance during motions, with a proof. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "planning/motion_tests.hpp"

namespace blum::detail {

/// Part of a motion, with a lower bound of the distance of one pair.
struct ProvenInterval {
  std::size_t motion = 0;
  TimeInterval at;
  double clearance = 0;  ///< mesh units
};

struct LeastClearance {
  double at_least = 0;  ///< lower bound of all distances, mesh units
  std::optional<MotionPair> closest = {};
  std::size_t motion = 0;  ///< of the closest pair
  double time = 0;         ///< of the closest pair
  /// The proof: for each pair of each motion, intervals that cover its time.
  std::vector<ProvenInterval> intervals = {};
};

/// Returns the smallest distance of all pairs during motions, up to a relative tolerance. Intervals with the smallest
/// lower bounds are halved first.
LeastClearance least_clearance(std::span<MotionTests> motions, double tolerance);

/// @throws InvalidOption if a relative tolerance is not above 0 and below 1.
void check_tolerance(double tolerance);

}  // namespace blum::detail
