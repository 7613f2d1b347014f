// Blum: the homology check of an axis in its solid, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {

/// The input of the homology check.
struct AxisInSolid {
  const MedialView& axis;
  const Incidence& incidence;  ///< incidence of the axis
  const KnownSolid& solid;
  const std::vector<Location>& locations;
  const AxisParts& parts;
  const EdgeWays& ways;
  double factor = 1;                ///< lengths of axis and solid are this many times the caller's
  std::size_t undecided_edges = 0;  ///< number of edges that may cross gaps of the solid
};

/// Checks that the inclusion of an axis in its solid is an isomorphism of homology. Sets the missing members of
/// `bodies`, and adds mismatches. Nothing is checked if the Betti numbers of a body differ, or if edges leave the
/// solid.
/// @param edges_hold  true if edges lie in the solid. Otherwise nothing is checked.
/// @param name        returns the name of a body, given its index.
/// @throws Cancelled.
[[nodiscard]] HomologyCheck check_homology(const AxisInSolid& given, bool edges_hold, std::vector<BodyCheck>& bodies,
                                           const std::function<std::string(std::size_t)>& name,
                                           std::vector<std::string>& mismatches, const Context& context);

}  // namespace blum::verifier
