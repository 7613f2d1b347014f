// Blum: the checks of a certificate. SPDX-License-Identifier: Apache-2.0
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

/// Returns coordinates as text for messages.
[[nodiscard]] inline std::string place_text(const Vec3d& at) {
  return rounded_text(at.x) + " " + rounded_text(at.y) + " " + rounded_text(at.z);
}

/// Tolerance of edges, as a multiple of that of vertices. An edge along the surface costs its length divided by this
/// tolerance.
inline constexpr double more_for_edges = 10;

/// Returns the tolerance of positions in each body.
[[nodiscard]] std::vector<double> tolerances(const KnownSolid& solid);

/// The worst error of its kind, relative to what is allowed for it.
struct Worst {
  double error = 0;
  double allowed = 1;

  void add(double other, double other_allowed) {
    if (other * allowed > error * other_allowed) *this = {other, other_allowed};
  }
  void add(const Worst& other) { add(other.error, other.allowed); }
  [[nodiscard]] bool is_too_much() const { return error > allowed; }
};

/// The parts of an axis, by body.
struct AxisParts {
  std::vector<std::uint32_t> body_of;  ///< for each vertex, the body of the deepest vertex connected to it
  std::vector<BettiNumbers> betti;     ///< of the parts in each body
};

/// Returns the location of each vertex; a default one if it is not finite.
[[nodiscard]] std::vector<Location> locate_vertices(const MedialView& axis, const SolidOracle& solid,
                                                    const Context& context);

/// Checks every vertex, and adds mismatches.
/// @param factor  lengths are this many times the caller's.
[[nodiscard]] GeometryCheck check_vertices(const MedialView& axis, const KnownSolid& solid,
                                           const std::vector<Location>& locations, const CertificateOptions& options,
                                           double factor, std::vector<std::string>& mismatches, const Context& context);

/// Edges that are not simply inside, in rising order.
struct EdgeWays {
  std::vector<PushedEdge> pushed;      ///< pushed into the solid
  std::vector<std::uint32_t> grazing;  ///< leave it by no more than the tolerance
};

/// Checks edges between their ends, and adds mismatches.
/// @param incidence  of the axis.
/// @param ways       is filled.
[[nodiscard]] EdgeCheck check_edges(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                                    const std::vector<Location>& locations, const AxisParts& parts, double factor,
                                    EdgeWays& ways, std::vector<std::string>& mismatches, const Context& context);

/// Checks triangles between their edges, and adds mismatches.
[[nodiscard]] TriangleCheck check_triangles(const MedialView& axis, const KnownSolid& solid,
                                            const std::vector<Location>& locations, const AxisParts& parts,
                                            const CertificateOptions& options, double factor,
                                            std::vector<std::string>& mismatches, const Context& context);

/// Checks roles and sheets, and adds mismatches.
[[nodiscard]] LabelCheck check_labels(const MedialView& axis, const Incidence& incidence,
                                      std::vector<std::string>& mismatches, const Context& context);

/// Checks the separation angles of triangles and edges, and adds mismatches.
/// @param body_of  of each vertex: see AxisParts.
[[nodiscard]] AngleCheck check_angles(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                                      const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                      double factor, std::vector<std::string>& mismatches, const Context& context);

/// Checks points of sheets and curves, searches for missing parts, and adds mismatches.
/// @param body_of  of each vertex: see AxisParts.
/// @param factor   lengths are this many times the caller's. Lengths of the options are the caller's.
[[nodiscard]] MedialCheck check_medial(const MedialView& axis, const KnownSolid& solid,
                                       const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                       double factor, std::vector<std::string>& mismatches, const Context& context);

/// Measures how much of the solid the balls of an axis fill.
/// @throws Cancelled.
[[nodiscard]] BallUnionCheck check_balls(const MedialView& axis, const SolidOracle& solid,
                                         const std::vector<Location>& locations, const Context& context);

/// Runs all checks.
/// @param complex  with the columns of a medial axis. Like the solid, it is `factor` times as large as the caller's.
/// @throws InvalidOption, Cancelled.
[[nodiscard]] Certificate certify_against(const Complex& complex, const KnownSolid& solid, double factor,
                                          const CertificateOptions& options, const Context& context);

}  // namespace blum::verifier
