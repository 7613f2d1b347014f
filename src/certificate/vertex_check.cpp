#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "certificate/angle.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {
namespace {

constexpr double tolerance_of_diagonal = 1e-6;
constexpr double tolerance_of_angles = 1e-4;  // degrees

/// Findings about some of the vertices.
struct Findings {
  GeometryCheck check;
  Worst outside, radius, off_surface, footprint, site, angle;

  void add(const Findings& other) {
    check.vertices += other.check.vertices;
    check.not_finite += other.check.not_finite;
    check.outside += other.check.outside;
    check.outside_by = std::max(check.outside_by, other.check.outside_by);
    check.radius_error = std::max(check.radius_error, other.check.radius_error);
    check.footprint_off_surface = std::max(check.footprint_off_surface, other.check.footprint_off_surface);
    check.footprint_error = std::max(check.footprint_error, other.check.footprint_error);
    check.site_error = std::max(check.site_error, other.check.site_error);
    check.angle_error = std::max(check.angle_error, other.check.angle_error);
    outside.add(other.outside);
    radius.add(other.radius);
    off_surface.add(other.off_surface);
    footprint.add(other.footprint);
    site.add(other.site);
    angle.add(other.angle);
  }
};

void note(double& largest, Worst& worst, double error, double allowed) {
  largest = std::max(largest, error);
  worst.add(error, allowed);
}

/// Adds the errors of a vertex's footprints.
void look_at_footprints(const MedialView& axis, std::size_t v, const Location& location, const SolidOracle& solid,
                        double allowed, const CertificateOptions& options, Findings& found) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3d foot = axis.footprint(v, k);
    note(found.check.footprint_off_surface, found.off_surface, solid.distance(foot, location.body), allowed);
    const double distance = length(axis.positions[v] - foot);
    note(found.check.footprint_error, found.footprint, std::abs(distance - axis.radius[v]), allowed);
    if (options.sites && axis.site(v, k).has_value()) {
      note(found.check.site_error, found.site, solid.distance_from_site(foot, axis.site(v, k)), allowed);
    }
  }
  if (!options.angles) return;
  const Vec3d a = axis.footprint(v, 0) - axis.positions[v];
  const Vec3d b = axis.footprint(v, 1) - axis.positions[v];
  // Errors of positions change the directions to footprints by up to this angle, in degrees.
  const double turned = 2 * allowed / std::max(std::min(length(a), length(b)), allowed) * degrees_per_radian;
  note(found.check.angle_error, found.angle, std::abs(axis.separation_angle[v] - degrees_between(a, b)),
       tolerance_of_angles + turned);
}

void look_at(const MedialView& axis, std::size_t v, const Location& location, const SolidOracle& solid, double allowed,
             const CertificateOptions& options, Findings& found) {
  ++found.check.vertices;
  if (!all_finite(axis, v)) {
    ++found.check.not_finite;
    return;
  }
  if (location.outside_by > allowed) ++found.check.outside;
  note(found.check.outside_by, found.outside, location.outside_by, allowed);
  if (!options.radii) return;
  note(found.check.radius_error, found.radius, std::abs(axis.radius[v] - location.distance), allowed);
  if (options.footprints) look_at_footprints(axis, v, location, solid, allowed, options, found);
}

void explain(const Findings& found, double factor, std::vector<std::string>& mismatches) {
  const auto allowed = [](double amount, const char* unit) {
    return " (allowed: " + rounded_text(amount) + unit + ")";
  };
  const auto add = [&](const Worst& worst, const std::string& what) {
    if (!worst.is_too_much()) return;
    mismatches.push_back(what + rounded_text(worst.error / factor) + allowed(worst.allowed / factor, ""));
  };
  const GeometryCheck& check = found.check;
  const std::string of_all = "of the " + count_text(check.vertices) + " vertices of the axis ";
  if (check.not_finite > 0) {
    mismatches.push_back(of_all + count_text(check.not_finite) +
                         " have a coordinate, footprint, angle or radius that is not finite");
  }
  add(found.radius, "a radius differs from the exact distance to the surface by ");
  add(found.off_surface, "a footprint lies off the surface by ");
  add(found.footprint, "the distance to a footprint differs from the radius by ");
  if (std::isinf(found.site.error)) {
    mismatches.emplace_back("a footprint has a site that the solid does not have");
  } else {
    add(found.site, "a footprint lies off its site by ");
  }
  if (found.angle.is_too_much()) {
    mismatches.push_back("a separation angle differs from the angle between the footprints by " +
                         rounded_text(found.angle.error) + " degrees" + allowed(found.angle.allowed, " degrees"));
  }
  if (check.outside > 0) {
    mismatches.push_back(of_all + count_text(check.outside) + " lie outside the solid, by up to " +
                         rounded_text(found.outside.error / factor) + allowed(found.outside.allowed / factor, ""));
  }
}

}  // namespace

std::vector<double> tolerances(const KnownSolid& solid) {
  std::vector<double> all;
  for (std::uint32_t b = 0; b < solid.bodies.size(); ++b) {
    const Box3 box = solid.solid->box(b);
    const double furthest = std::max(length(box.lower), length(box.upper));
    all.push_back(std::max(tolerance_of_diagonal * solid.solid->diagonal(b),
                           2 * std::numeric_limits<double>::epsilon() * furthest));
  }
  return all;
}

std::vector<Location> locate_vertices(const MedialView& axis, const SolidOracle& solid, const Context& context) {
  std::vector<Location> locations(axis.positions.size());
  parallel_for(context, locations.size(), 256, "locating vertices", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) {
      if (is_finite(axis.positions[v])) locations[v] = solid.locate(axis.positions[v]);
    }
  });
  return locations;
}

GeometryCheck check_vertices(const MedialView& axis, const KnownSolid& solid, const std::vector<Location>& locations,
                             const CertificateOptions& options, double factor, std::vector<std::string>& mismatches,
                             const Context& context) {
  constexpr std::size_t grain = 256;
  const std::vector<double> allowed = tolerances(solid);
  std::vector<Findings> parts(axis.positions.size() / grain + 1);
  parallel_for(context, axis.positions.size(), grain, "checking vertices", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) {
      look_at(axis, v, locations[v], *solid.solid, allowed[locations[v].body], options, parts[range.begin / grain]);
    }
  });
  Findings all;
  for (const Findings& part : parts) all.add(part);
  const std::size_t before = mismatches.size();
  explain(all, factor, mismatches);
  GeometryCheck check = all.check;
  for (double* length : {&check.outside_by, &check.radius_error, &check.footprint_off_surface, &check.footprint_error,
                         &check.site_error}) {
    *length /= factor;
  }
  check.tolerance = *std::max_element(allowed.begin(), allowed.end()) / factor;
  check.holds = mismatches.size() == before;
  return check;
}

}  // namespace blum::verifier
