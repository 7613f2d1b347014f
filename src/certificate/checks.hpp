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

/// Tolerance of edges, as a multiple of the tolerance of vertices. The cost of checking an edge along the surface is
/// its length divided by this tolerance.
inline constexpr double more_for_edges = 10;

/// Returns the tolerance of positions for each body.
[[nodiscard]] std::vector<double> tolerances(const KnownSolid& solid);

/// The largest error of a kind, relative to the allowed error.
struct Worst {
  double error = 0;
  double allowed = 1;

  void add(double other, double other_allowed) {
    if (other * allowed > error * other_allowed) *this = {other, other_allowed};
  }
  void add(const Worst& other) { add(other.error, other.allowed); }
  [[nodiscard]] bool is_too_much() const { return error > allowed; }
};

/// Assignment of an axis to bodies.
struct AxisParts {
  std::vector<std::uint32_t> body_of;  ///< for each vertex: the body of the deepest vertex in its component
  std::vector<BettiNumbers> betti;     ///< for each body: Betti numbers of the axis in it
};

/// Returns the location of each vertex; for vertices that are not finite, a default one.
[[nodiscard]] std::vector<Location> locate_vertices(const MedialView& axis, const SolidOracle& solid,
                                                    const Context& context);

/// Checks every vertex, and adds mismatches.
/// @param factor  lengths of axis and solid are this many times the caller's.
[[nodiscard]] GeometryCheck check_vertices(const MedialView& axis, const KnownSolid& solid,
                                           const std::vector<Location>& locations, const CertificateOptions& options,
                                           double factor, std::vector<std::string>& mismatches, const Context& context);

/// Edges that are not certainly inside their body, in ascending order.
struct EdgeWays {
  std::vector<PushedEdge> pushed;      ///< edges that were pushed into the solid
  std::vector<std::uint32_t> grazing;  ///< edges that leave the solid by at most the tolerance
};

/// Checks edges between their ends, and adds mismatches.
/// @param incidence  incidence of the axis.
/// @param ways       receives the edges that are not certainly inside.
[[nodiscard]] EdgeCheck check_edges(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                                    const std::vector<Location>& locations, const AxisParts& parts, double factor,
                                    EdgeWays& ways, std::vector<std::string>& mismatches, const Context& context);

/// Checks triangles between their edges, and adds mismatches.
[[nodiscard]] TriangleCheck check_triangles(const MedialView& axis, const KnownSolid& solid,
                                            const std::vector<Location>& locations, const AxisParts& parts,
                                            const CertificateOptions& options, double factor,
                                            std::vector<std::string>& mismatches, const Context& context);

/// Checks roles and sheets, and adds mismatches.
/// @param factor  lengths of the axis are this many times the caller's.
[[nodiscard]] LabelCheck check_labels(const MedialView& axis, const Incidence& incidence, double factor,
                                      std::vector<std::string>& mismatches, const Context& context);

/// Checks sheets against walls, sites and patches, and adds mismatches.
/// @param complex    with the columns of MedialView.
/// @param incidence  incidence of `complex`.
/// @param body_of    for each vertex: see AxisParts.
[[nodiscard]] SheetCheck check_sheets(const Complex& complex, const Incidence& incidence, const KnownSolid& solid,
                                      const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                      double factor, std::vector<std::string>& mismatches, const Context& context);

/// Checks the separation angles of triangles and edges, and adds mismatches.
/// @param body_of  for each vertex: see AxisParts.
[[nodiscard]] AngleCheck check_angles(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                                      const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                      double factor, std::vector<std::string>& mismatches, const Context& context);

/// Checks points of sheets and curves, searches for missing parts, and adds mismatches.
/// @param body_of  for each vertex: see AxisParts.
/// @param factor   lengths of axis and solid are this many times the caller's. Lengths of the options are the caller's.
[[nodiscard]] MedialCheck check_medial(const MedialView& axis, const KnownSolid& solid,
                                       const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                       double factor, std::vector<std::string>& mismatches, const Context& context);

/// Measures how much of the solid the balls of an axis fill.
/// @throws Cancelled.
[[nodiscard]] BallUnionCheck check_balls(const MedialView& axis, const SolidOracle& solid,
                                         const std::vector<Location>& locations, const Context& context);

/// Runs all checks.
/// @param complex  has the columns of a medial axis. Like the solid, it is `factor` times as large as the caller's.
/// @throws InvalidOption, Cancelled.
[[nodiscard]] Certificate certify_against(const Complex& complex, const KnownSolid& solid, double factor,
                                          const CertificateOptions& options, const Context& context);

}  // namespace blum::verifier
