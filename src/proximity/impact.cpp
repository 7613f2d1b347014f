#include "blum/proximity/impact.hpp"

#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "proximity/exact/exact_impact.hpp"
#include "proximity/impact_filter.hpp"

namespace blum {
namespace {

using detail::exact_edge_edge_approach;
using detail::exact_edge_edge_impact;
using detail::exact_vertex_face_approach;
using detail::exact_vertex_face_impact;
using detail::FeatureKinds;

constexpr std::size_t grain = 256;

void check(const FourMovingPoints& points, std::size_t number) {
  for (const auto* ends : {&points.start, &points.end}) {
    for (const Vec3d& p : *ends) {
      if (!is_finite(p)) throw InvalidMesh("points " + std::to_string(number) + ": a coordinate is not finite");
    }
  }
}

/// Returns the time of impact, computed by integers of any size.
std::optional<double> exact_impact(const FourMovingPoints& points, FeatureKinds kinds, const ImpactOptions& options) {
  const auto [tolerance, distance] = options;
  if (distance > 0) {
    return kinds == FeatureKinds::vertex_face ? exact_vertex_face_approach(points, distance, tolerance)
                                              : exact_edge_edge_approach(points, distance, tolerance);
  }
  return kinds == FeatureKinds::vertex_face ? exact_vertex_face_impact(points, tolerance)
                                            : exact_edge_edge_impact(points, tolerance);
}

std::optional<double> checked_impact(const FourMovingPoints& points, FeatureKinds kinds, const ImpactOptions& options) {
  check(options);
  check(points, 0);
  return detail::impact(points, kinds, options);
}

std::vector<std::optional<double>> impacts(std::span<const FourMovingPoints> points, FeatureKinds kinds,
                                           const ImpactOptions& options, const Context& context) {
  check(options);
  for (std::size_t k = 0; k < points.size(); ++k) check(points[k], k);
  std::vector<std::optional<double>> times(points.size());
  parallel_for(context, points.size(), grain, "impacts", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) times[k] = detail::impact(points[k], kinds, options);
  });
  return times;
}

}  // namespace

std::optional<double> detail::impact(const FourMovingPoints& points, FeatureKinds kinds, const ImpactOptions& options,
                                     double before) {
  const FilteredImpact filtered = filtered_impact(points, kinds, options, before);
  if (filtered.answer == FilteredImpact::Answer::never) return std::nullopt;
  const std::optional<double> time =
      filtered.answer == FilteredImpact::Answer::meets ? filtered.time : exact_impact(points, kinds, options);
  return time && *time < before ? time : std::nullopt;
}

void check(const ImpactOptions& options) {
  constexpr double least_tolerance = 0x1p-40;
  constexpr double most_separation = 1e150;
  if (!(options.tolerance >= least_tolerance && options.tolerance <= 1)) {
    throw InvalidOption("tolerance is " + exact_text(options.tolerance) + ", but must be 2^-40 (about 1e-12) to 1");
  }
  if (!(options.min_separation >= 0 && options.min_separation <= most_separation)) {
    throw InvalidOption("min_separation is " + exact_text(options.min_separation) + ", but must be 0 to 1e150");
  }
}

std::optional<double> vertex_face_impact(const FourMovingPoints& points, const ImpactOptions& options) {
  return checked_impact(points, FeatureKinds::vertex_face, options);
}

std::optional<double> edge_edge_impact(const FourMovingPoints& points, const ImpactOptions& options) {
  return checked_impact(points, FeatureKinds::edge_edge, options);
}

std::vector<std::optional<double>> vertex_face_impacts(std::span<const FourMovingPoints> points,
                                                       const ImpactOptions& options, const Context& context) {
  return impacts(points, FeatureKinds::vertex_face, options, context);
}

std::vector<std::optional<double>> edge_edge_impacts(std::span<const FourMovingPoints> points,
                                                     const ImpactOptions& options, const Context& context) {
  return impacts(points, FeatureKinds::edge_edge, options, context);
}

}  // namespace blum
