// Blum: whether an axis's way into its solid is an isomorphism of homology. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {

/// What homology is looked at with.
struct AxisInSolid {
  const MedialView& axis;
  const Incidence& incidence;  ///< of the axis
  const KnownSolid& solid;
  const std::vector<Location>& locations;
  const AxisParts& parts;
  const EdgeWays& ways;
  double factor = 1;             ///< lengths are this many times what the caller knows
  std::size_t untold_edges = 0;  ///< that may cross gaps of the solid
};

/// Fills what bodies are missing, and adds what is wrong. Bodies whose Betti numbers differ are left out.
/// @param edges_hold  whether edges lie in the solid: else nothing is looked at.
/// @param name  of a body, by its number.  @throws Cancelled.
[[nodiscard]] HomologyCheck check_homology(const AxisInSolid& given, bool edges_hold, std::vector<BodyCheck>& bodies,
                                           const std::function<std::string(std::size_t)>& name,
                                           std::vector<std::string>& mismatches, const Context& context);

}  // namespace blum::verifier
