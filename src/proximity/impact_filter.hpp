// Blum: when moving features meet, by doubles with proven bounds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::detail {

enum class FeatureKinds : std::uint8_t { vertex_face, edge_edge };

/// What doubles tell of two features.
struct FilteredImpact {
  enum class Answer : std::uint8_t { never, meets, unknown };
  Answer answer = Answer::unknown;
  double time = 0;  ///< where they meet: as impacts tell it
};

/// Whether and when two moving features meet, exactly: by doubles where these decide it, else by integers.
[[nodiscard]] std::optional<double> impact(const FourMovingPoints& points, FeatureKinds kinds,
                                           const ImpactOptions& options);

/// Whether and when two moving features meet, where doubles decide it: never a wrong answer.
[[nodiscard]] FilteredImpact filtered_impact(const FourMovingPoints& points, FeatureKinds kinds,
                                             const ImpactOptions& options);

}  // namespace blum::detail
