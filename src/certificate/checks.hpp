// Blum: the parts of a certificate. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/context.hpp"
#include "blum/core/exact_text.hpp"
#include "certificate/body_edges.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

[[nodiscard]] inline bool all_finite(const MedialView& axis, std::size_t vertex) {
  return is_finite(axis.positions[vertex]) && std::isfinite(axis.radius[vertex]) &&
         is_finite(axis.footprint(vertex, 0)) && is_finite(axis.footprint(vertex, 1)) &&
         std::isfinite(axis.separation_angle[vertex]);
}

/// Coordinates, as messages tell them.
[[nodiscard]] inline std::string place_text(const Vec3d& at) {
  return rounded_text(at.x) + " " + rounded_text(at.y) + " " + rounded_text(at.z);
}

/// Of what vertices are allowed: an edge along the surface is asked about as often as this goes into it.
inline constexpr double more_for_edges = 10;

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

/// Where each vertex lies; nowhere in particular where it is not finite.
[[nodiscard]] std::vector<Location> locate_vertices(const MedialView& axis, const SolidOracle& solid,
                                                    const Context& context);

/// Looks at every vertex, and adds what is wrong. @param factor  lengths are this many times what the caller knows.
[[nodiscard]] GeometryCheck check_vertices(const MedialView& axis, const KnownSolid& solid,
                                           const std::vector<Location>& locations, const CertificateOptions& options,
                                           double factor, std::vector<std::string>& mismatches, const Context& context);

/// Edges that are not simply inside, rising.
struct EdgeWays {
  std::vector<PushedEdge> pushed;      ///< those that were pushed into the solid
  std::vector<std::uint32_t> grazing;  ///< those that leave it by no more than the tolerance
};

/// The same for what lies between vertices. @param incidence  of the axis.  @param ways  is filled.
[[nodiscard]] EdgeCheck check_edges(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                                    const std::vector<Location>& locations, const AxisParts& parts, double factor,
                                    EdgeWays& ways, std::vector<std::string>& mismatches, const Context& context);

/// The same for triangles between their edges.
[[nodiscard]] TriangleCheck check_triangles(const MedialView& axis, const KnownSolid& solid,
                                            const std::vector<Location>& locations, const AxisParts& parts,
                                            const CertificateOptions& options, double factor,
                                            std::vector<std::string>& mismatches, const Context& context);

/// The same for roles and sheets.
[[nodiscard]] LabelCheck check_labels(const MedialView& axis, const Incidence& incidence,
                                      std::vector<std::string>& mismatches, const Context& context);

/// The same for the separation angles of triangles and edges. @param body_of  of each vertex: see AxisParts.
[[nodiscard]] AngleCheck check_angles(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                                      const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                      double factor, std::vector<std::string>& mismatches, const Context& context);

/// Looks at points of sheets and curves, and for what is missing, and adds what is wrong.
/// @param body_of  of each vertex: see AxisParts.
/// @param factor   lengths are this many times what the caller knows; those of the options are the caller's.
[[nodiscard]] MedialCheck check_medial(const MedialView& axis, const KnownSolid& solid,
                                       const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                       double factor, std::vector<std::string>& mismatches, const Context& context);

/// @throws Cancelled.
[[nodiscard]] BallUnionCheck check_balls(const MedialView& axis, const SolidOracle& solid,
                                         const std::vector<Location>& locations, const Context& context);

/// All of it. @param complex  with the columns of a medial axis, `factor` times as large as the caller knows it, as is
/// the solid. @throws InvalidOption, Cancelled.
[[nodiscard]] Certificate certify_against(const Complex& complex, const KnownSolid& solid, double factor,
                                          const CertificateOptions& options, const Context& context);

}  // namespace blum::verifier
