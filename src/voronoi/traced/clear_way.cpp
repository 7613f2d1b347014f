#include "voronoi/traced/clear_way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace blum::voronoi {
namespace {

constexpr std::size_t count = CurveSamples::count;
/// Places at which interpolants are compared: fine enough that a minimum lies next to the lowest place.
constexpr std::size_t places = 4 * (count - 1) + 1;

/// A polynomial over the interval from 0 to 1, as a sum of Chebyshev polynomials.
using Chebyshev = std::array<double, count>;

double angle_of(std::size_t k, std::size_t of) {
  return std::numbers::pi * static_cast<double>(k) / static_cast<double>(of - 1);
}

/// Cosines of all multiples of the angle between successive nodes.
const std::array<double, 2 * (count - 1)>& cosines() {
  static const auto table = [] {
    std::array<double, 2 * (count - 1)> out{};
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::cos(angle_of(k, count));
    return out;
  }();
  return table;
}

Chebyshev interpolant(const std::array<double, count>& values) {
  Chebyshev out{};
  constexpr double parts = count - 1;
  for (std::size_t j = 0; j < count; ++j) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double weight = k == 0 || k + 1 == count ? 0.5 : 1;
      sum += weight * values[k] * cosines()[j * k % cosines().size()];
    }
    out[j] = sum * (j == 0 || j + 1 == count ? 1 : 2) / parts;
  }
  return out;
}

/// Returns the value at a share of the interval. The first node is at the cosine 1.
double value(const Chebyshev& c, double share) {
  const double t = 1 - 2 * share;
  double now = 0, next = 0;
  for (std::size_t j = count - 1; j > 0; --j) {
    const double before = 2 * t * now - next + c[j];
    next = now;
    now = before;
  }
  return t * now - next + c[0];
}

/// The gap of a site: how much further it is than the curve's own sites.
class Gap {
 public:
  Gap(const TracedSites& sites, const CurveSamples& samples, const std::array<double, count>& radii,
      std::span<const TracedSites::Index> own, TracedSites::Index site)
      : sites_(sites), samples_(samples), site_(site) {
    const auto plane = plane_to(own);
    for (std::size_t k = 0; k < count; ++k) {
      const double distance = sites.distance(site, samples.points[k]);
      furthest_ = std::max(furthest_, distance);
      values_[k] = plane ? plane->height(samples.points[k]) : distance - radii[k];
    }
    gap_ = interpolant(values_);
  }

  /// Returns true if the site is clearly further, or faces away.
  [[nodiscard]] bool is_far() const {
    double least = gap_[0];
    for (std::size_t j = 1; j < count; ++j) least -= std::abs(gap_[j]);
    return least > limit() || (sites_[site_].kind == SiteKind::face && furthest_ < -samples_.length);
  }

  /// Returns true if the interpolation is precise: its last terms are small.
  [[nodiscard]] bool is_precise() const {
    constexpr double share = 0.25;
    return std::abs(gap_[count - 1]) + std::abs(gap_[count - 2]) <= share * sites_.tolerance();
  }

  /// Returns the share of the interval before which the site is not as close, or its domain is elsewhere.
  [[nodiscard]] double clear_share() const {
    std::array<double, places> at{};
    for (std::size_t k = 0; k < places; ++k) at[k] = value(gap_, share_of(k));
    for (std::size_t k = 0; k < places; ++k) {
      if (!may_touch(at, k) || is_outside(k)) continue;
      return k < 2 ? 0 : share_of(k - 2);
    }
    return 1;
  }

 private:
  /// Returns the plane before the region of an edge, if an own edge meets it at a vertex. Distances of both differ by
  /// less than rounding near it.
  [[nodiscard]] std::optional<TracedSites::EdgePlane> plane_to(std::span<const TracedSites::Index> own) const {
    for (const TracedSites::Index i : own) {
      if (const auto plane = sites_.plane_between_edges(i, site_)) return plane;
    }
    return std::nullopt;
  }
  static double share_of(std::size_t k) { return 0.5 * (1 - std::cos(angle_of(k, places))); }
  [[nodiscard]] double limit() const { return 4 * sites_.tolerance(); }

  /// Returns true if the gap may be 0 between the neighbours of a place. Between places, it is lower than at them by
  /// less than a quarter of the differences.
  [[nodiscard]] bool may_touch(const std::array<double, places>& at, std::size_t k) const {
    const double before = at[k > 0 ? k - 1 : k], after = at[k + 1 < places ? k + 1 : k];
    const double bend = std::max(std::abs(at[k] - before), std::abs(at[k] - after));
    const bool is_lowest = at[k] <= before && at[k] <= after;
    return at[k] - (is_lowest ? 0.25 * bend : 0) <= limit();
  }

  /// Returns true if the domain of the site does not come near a place.
  [[nodiscard]] bool is_outside(std::size_t place) const {
    // The closest node is within half the distance of two nodes.
    const double share = share_of(place);
    std::size_t best = 0;
    for (std::size_t k = 1; k < count; ++k) {
      if (std::abs(CurveSamples::share(k) - share) < std::abs(CurveSamples::share(best) - share)) best = k;
    }
    constexpr double more = 1.25;  // the curve is longer than its chord
    const double to_next = std::max(std::abs(share_of(std::min(place + 1, places - 1)) - share),
                                    std::abs(share - share_of(place > 0 ? place - 1 : 0)));
    const double reach = more * samples_.length * (std::abs(CurveSamples::share(best) - share) + to_next);
    return sites_.outside(site_, samples_.points[best], reach) >= reach;
  }

  const TracedSites& sites_;
  const CurveSamples& samples_;
  const TracedSites::Index site_;
  std::array<double, count> values_{};
  Chebyshev gap_{};
  double furthest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

double CurveSamples::share(std::size_t k) {
  return 0.5 * (1 - cosines()[k]);
}

std::optional<ClearWay> clear_way(const TracedSites& sites, const CurveSamples& samples,
                                  std::span<const TracedSites::Index> own, std::span<const TracedSites::Index> others) {
  std::array<double, count> radii{};
  for (std::size_t k = 0; k < count; ++k) {
    radii[k] = sites.distance(own[0], samples.points[k]);
    for (const TracedSites::Index i : own) {
      if (sites.outside(i, samples.points[k], sites.tolerance()) > sites.tolerance()) return std::nullopt;
    }
  }
  ClearWay out{samples.length, {}};
  for (const TracedSites::Index i : others) {
    const Gap gap(sites, samples, radii, own, i);
    if (gap.is_far()) continue;
    if (!gap.is_precise()) return std::nullopt;
    const double way = gap.clear_share() * samples.length;
    if (way < out.length) out = {way, i};
  }
  return out;
}

}  // namespace blum::voronoi
