// Blum: the parts of a certificate. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/medial_axis/certificate.hpp"
#include "medial_axis/certificate/solid.hpp"

namespace blum::verifier {

[[nodiscard]] inline bool all_finite(const MedialVertex& vertex) {
  return is_finite(vertex.position) && std::isfinite(vertex.radius) && is_finite(vertex.footprints[0]) &&
         is_finite(vertex.footprints[1]) && std::isfinite(vertex.separation_angle);
}

/// How far off positions may be in each body.
[[nodiscard]] std::vector<double> tolerances(const KnownSolid& solid);

/// An error that is the worst of its kind, measured by what is allowed for it.
struct Worst {
  double error = 0;
  double allowed = 1;

  void add(double other, double other_allowed) {
    if (other * allowed > error * other_allowed) *this = {other, other_allowed};
  }
  void add(const Worst& other) { add(other.error, other.allowed); }
  [[nodiscard]] bool is_too_much() const { return error > allowed; }
};

/// A part of an axis in each body.
struct AxisParts {
  std::vector<std::uint32_t> body_of;  ///< of each vertex: the body of the deepest vertex that is joined with it
  std::vector<BettiNumbers> betti;     ///< of what is in each body
};

/// Betti numbers of a whole axis. @throws as homology().
[[nodiscard]] BettiNumbers axis_betti_numbers(const MedialComplex& axis, const Context& context);
/// Sorts the parts of an axis into bodies. @throws as homology().
[[nodiscard]] AxisParts parts_in_bodies(const MedialComplex& axis, const std::vector<Place>& places,
                                        std::uint32_t body_count, const Context& context);

/// Where each vertex lies; nowhere in particular where it is not finite.
[[nodiscard]] std::vector<Place> locate_vertices(const MedialComplex& axis, const Solid& solid, const Context& context);

/// Looks at every vertex, and adds what is wrong. @param factor  lengths are this many times what the caller knows.
[[nodiscard]] GeometryCheck check_vertices(const MedialComplex& axis, const KnownSolid& solid,
                                           const std::vector<Place>& places, const CertificateOptions& options,
                                           double factor, std::vector<std::string>& mismatches, const Context& context);

/// The same for what lies between vertices.
[[nodiscard]] EdgeCheck check_edges(const MedialComplex& axis, const KnownSolid& solid,
                                    const std::vector<Place>& places, const AxisParts& parts, double factor,
                                    std::vector<std::string>& mismatches, const Context& context);

/// @throws Cancelled.
[[nodiscard]] BallUnionCheck check_balls(const MedialComplex& axis, const Solid& solid,
                                         const std::vector<Place>& places, const Context& context);

}  // namespace blum::verifier
