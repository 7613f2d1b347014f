// Blum: times at which moving features meet, by doubles with proven bounds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "blum/proximity/impact.hpp"

namespace blum::detail {

enum class FeatureKinds : std::uint8_t { vertex_face, edge_edge };

/// Times of impact are multiples of 2^-depth: the first contact, rounded down. So times of impact do not depend on the
/// arithmetic that computes them. Returns the least depth for which times of impact are early by at most the tolerance.
[[nodiscard]] int time_depth(double tolerance);

/// The result for two features, as far as fast arithmetic can decide it.
struct FilteredImpact {
  enum class Answer : std::uint8_t { never, meets, unknown };
  Answer answer = Answer::unknown;
  double time = 0;  ///< if they meet: the time that vertex_face_impact() returns
};

/// Later than any time of impact.
inline constexpr double after_all_times = 2;

/// Returns the time at which two moving features meet, if they do. Exact: uses filtered_impact() if that decides, else
/// integers of any size.
/// @param before  a multiple of 2^-time_depth(options.tolerance). Returns nullopt for pairs that meet then or later.
[[nodiscard]] std::optional<double> impact(const FourMovingPoints& points, FeatureKinds kinds,
                                           const ImpactOptions& options, double before = after_all_times);

/// Returns the time at which two moving features meet, if doubles or integers of a fixed width can decide it, else
/// `unknown`. The function never returns a wrong answer.
/// @param before  as for impact(). Returns `never` or a later time for pairs that meet at this time or later.
[[nodiscard]] FilteredImpact filtered_impact(const FourMovingPoints& points, FeatureKinds kinds,
                                             const ImpactOptions& options, double before = after_all_times);

}  // namespace blum::detail
