#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/certificate/axis_verifier.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/complex/components.hpp"
#include "blum/complex/homology.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "certificate/checks.hpp"
#include "certificate/homology/homology_check.hpp"

namespace blum::verifier {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

/// Cells sorted by body, with vertices renumbered within each body, and the index of each body's first cell.
template <class Corners>
struct Sorted {
  std::vector<Corners> cells;
  std::vector<std::size_t> first;

  [[nodiscard]] std::span<const Corners> in(std::uint32_t body) const {
    return {cells.data() + first[body], first[body + 1] - first[body]};
  }
};

template <class Corners>
Sorted<Corners> sorted_by_body(std::span<const Corners> cells, const std::vector<std::uint32_t>& body_of,
                               const std::vector<std::uint32_t>& number, std::uint32_t body_count) {
  Sorted<Corners> sorted{std::vector<Corners>(cells.size()), std::vector<std::size_t>(body_count + 1, 0)};
  for (const Corners& cell : cells) ++sorted.first[body_of[cell[0]] + 1];
  for (std::uint32_t b = 0; b < body_count; ++b) sorted.first[b + 1] += sorted.first[b];
  std::vector<std::size_t> next(sorted.first.begin(), sorted.first.end() - 1);
  for (const Corners& cell : cells) {
    Corners& own = sorted.cells[next[body_of[cell[0]]]++];
    for (std::size_t k = 0; k < own.size(); ++k) own[k] = number[cell[k]];
  }
  return sorted;
}

/// Assigns each component of an axis to a body, and computes Betti numbers body by body.
/// @throws as homology().
AxisParts parts_in_bodies(const ComplexView& axis, const std::vector<Location>& locations, std::uint32_t body_count,
                          const Context& context) {
  throw_if_cancelled(context);
  AxisParts parts;
  // Where bodies touch, a vertex may lie in several. So the deepest vertex of a component decides its body.
  std::vector<std::uint32_t> deepest = components(axis);
  const std::vector<std::uint32_t> component = deepest;
  for (std::uint32_t v = 0; v < component.size(); ++v) {
    std::uint32_t& best = deepest[component[v]];
    if (locations[v].depth > locations[best].depth) best = v;
  }
  parts.body_of.resize(axis.vertex_count);
  std::vector<std::uint32_t> number(axis.vertex_count);
  std::vector<std::uint32_t> count(body_count, 0);
  for (std::uint32_t v = 0; v < component.size(); ++v) {
    parts.body_of[v] = locations[deepest[component[v]]].body;
    number[v] = count[parts.body_of[v]]++;
  }
  const auto edges = sorted_by_body<Edge>(axis.edges, parts.body_of, number, body_count);
  const auto triangles = sorted_by_body<Face>(axis.triangles, parts.body_of, number, body_count);
  for (std::uint32_t b = 0; b < body_count; ++b) {
    parts.betti.push_back(count[b] == 0 ? BettiNumbers{0, 0, 0}
                                        : homology({count[b], edges.in(b), triangles.in(b)}, context));
  }
  return parts;
}

/// Reports and resets impossible claims of an axis: theta, lambda, spacing, deviation.
/// @param diagonal  diagonal of the solid, in the caller's units.
void check_claims(CertificateOptions& options, double diagonal, std::vector<std::string>& mismatches) {
  const auto check = [&](std::optional<double>& value, const char* what, double least, double most, const char* must) {
    if (!value || (*value >= least && *value <= most)) return;
    mismatches.push_back("the axis says that its " + std::string(what) + " is " + exact_text(*value) +
                         ", but it must be " + must);
    value.reset();
  };
  check(options.theta, "theta", 0, 180, "0 to 180 degrees");
  // No two points of the solid are further apart than its diagonal.
  check(options.lambda, "lambda", 0, diagonal, "at least 0, and no more than the diagonal of the solid");
  check(options.spacing, "spacing", 1e-9 * diagonal, diagonal, "above 0, and no more than the diagonal of the solid");
  check(options.deviation, "deviation", 0, diagonal, "at least 0, and no more than the diagonal of the solid");
}

}  // namespace
}  // namespace blum::verifier

namespace blum {
namespace {

using verifier::Location;

void scale_back(BallUnionCheck& balls, double factor) {
  for (double* value : {&balls.solid_to_balls, &balls.mean_solid_to_balls, &balls.balls_beyond_solid,
                        &balls.balls_to_surface, &balls.step}) {
    *value /= factor;
  }
}

BettiNumbers sum(const std::vector<BettiNumbers>& all) {
  BettiNumbers total{};
  for (const BettiNumbers& one : all) {
    for (std::size_t k = 0; k < 3; ++k) total[k] += one[k];
  }
  return total;
}

std::string counted(std::int64_t count, const char* thing) {
  return count_text(static_cast<std::uint64_t>(count)) + " " + thing + (count == 1 ? "" : "s");
}

/// Compares the Betti numbers of axis and solid, body by body.
/// @param name  returns the name of a body, given its index.
template <class Name>
void compare_topology(Certificate& certificate, const Name& name) {
  constexpr std::array<const char*, 3> things{"component", "tunnel", "void"};
  constexpr std::size_t most_named = 8;
  std::size_t wrong = 0;
  for (std::size_t b = 0; b < certificate.bodies.size(); ++b) {
    const BodyCheck& body = certificate.bodies[b];
    if (body.solid == body.axis) continue;
    if (++wrong > most_named) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (body.solid[k] == body.axis[k]) continue;
      certificate.mismatches.push_back(name(b) + " has " + counted(body.solid[k], things[k]) + ", the axis " +
                                       (certificate.bodies.size() > 1 ? "in it " : "") + "has " +
                                       count_text(static_cast<std::uint64_t>(body.axis[k])));
    }
  }
  certificate.topology_holds = wrong == 0;
  if (wrong > most_named) {
    certificate.mismatches.push_back("the axis has other components, tunnels or voids than the solid in " +
                                     std::to_string(wrong - most_named) + " more bodies");
  }
}

}  // namespace

Certificate verifier::certify_against(const Complex& complex, const KnownSolid& solid, double factor,
                                      const CertificateOptions& options, const Context& context) {
  Certificate certificate;
  certificate.checked = options;
  certificate.solid = sum(solid.bodies);
  if (!options.positions) {
    certificate.axis = homology(complex.view(), context);
    certificate.bodies = {{certificate.solid, certificate.axis}};
    compare_topology(certificate, [](std::size_t) { return std::string("the solid"); });
    certificate.homology.shown = "nothing: positions were not checked";
    return certificate;
  }
  const MedialView axis(complex);
  const std::vector<Location> locations = verifier::locate_vertices(axis, *solid.solid, context);
  const auto body_count = static_cast<std::uint32_t>(solid.bodies.size());
  const verifier::AxisParts parts = verifier::parts_in_bodies(axis.cells(), locations, body_count, context);
  certificate.axis = sum(parts.betti);
  for (std::size_t b = 0; b < body_count; ++b) certificate.bodies.push_back({solid.bodies[b], parts.betti[b]});
  const auto name = [&](std::size_t b) {
    if (body_count == 1) return std::string("the solid");
    const Vec3d at = solid.solid->box(static_cast<std::uint32_t>(b)).center() / factor;
    return "body " + std::to_string(b + 1) + " of " + std::to_string(body_count) + " (around " +
           verifier::place_text(at) + ")";
  };
  compare_topology(certificate, name);
  certificate.geometry =
      verifier::check_vertices(axis, solid, locations, certificate.checked, factor, certificate.mismatches, context);
  verifier::check_claims(certificate.checked, solid.solid->diagonal() / factor, certificate.mismatches);
  const Incidence incidence(axis.cells(), context);
  verifier::EdgeWays ways;
  certificate.edges =
      verifier::check_edges(axis, incidence, solid, locations, parts, factor, ways, certificate.mismatches, context);
  certificate.homology =
      verifier::check_homology({axis, incidence, solid, locations, parts, ways, factor, certificate.edges.undecided},
                               certificate.edges.holds && certificate.geometry.not_finite == 0, certificate.bodies,
                               name, certificate.mismatches, context);
  certificate.triangles = verifier::check_triangles(axis, solid, locations, parts, certificate.checked, factor,
                                                    certificate.mismatches, context);
  if (certificate.checked.labels) {
    certificate.labels = verifier::check_labels(axis, incidence, factor, certificate.mismatches, context);
  }
  certificate.sheets = verifier::check_sheets(complex, incidence, solid, parts.body_of, certificate.checked, factor,
                                              certificate.mismatches, context);
  if (certificate.checked.angles) {
    certificate.angles = verifier::check_angles(axis, incidence, solid, parts.body_of, certificate.checked, factor,
                                                certificate.mismatches, context);
  }
  if (certificate.checked.medial) {
    certificate.medial = verifier::check_medial(axis, solid, parts.body_of, certificate.checked, factor,
                                                certificate.mismatches, context);
  }
  if (!certificate.checked.balls) return certificate;
  certificate.balls = verifier::check_balls(axis, *solid.solid, locations, context);
  scale_back(certificate.balls, factor);
  return certificate;
}

Certificate certify_topology(const Complex& complex, const MeshView& mesh, const Context& context) {
  return AxisVerifier(mesh).certify_topology(complex, context);
}

Certificate certify_topology(const Complex& complex, const VoxelSet& voxels, const GridSpec& grid,
                             const MeshView* surface, const Context& context) {
  return AxisVerifier(voxels, grid, surface).certify_topology(complex, context);
}

Certificate certify(const Complex& axis, const MeshView& mesh, const CertificateOptions& options,
                    const Context& context) {
  return AxisVerifier(mesh).certify(axis, options, context);
}

Certificate certify(const Complex& axis, const VoxelSet& voxels, const GridSpec& grid, const MeshView* surface,
                    const CertificateOptions& options, const Context& context) {
  return AxisVerifier(voxels, grid, surface).certify(axis, options, context);
}

}  // namespace blum
