#include "voronoi/traced/line_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace blum::voronoi {
namespace {

/// A part of a line.
struct Range {
  double from = 0;
  double to = 0;
  [[nodiscard]] bool is_empty() const { return !(from <= to); }
};

/// a + b s + c s^2
struct Quadratic {
  double a = 0, b = 0, c = 0;
  [[nodiscard]] double at(double s) const { return a + s * (b + s * c); }
};

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Returns the two places where a quadratic is 0, ascending; infinite if there are none.
std::array<double, 2> roots(const Quadratic& q) {
  if (q.c == 0) return q.b == 0 ? std::array{infinite, infinite} : std::array{-q.a / q.b, infinite};
  const double square = q.b * q.b - 4 * q.a * q.c;
  if (!(square >= 0)) return {infinite, infinite};
  // Without cancellation.
  const double sum = -0.5 * (q.b + std::copysign(std::sqrt(square), q.b));
  const double first = sum / q.c;
  const double second = sum == 0 ? first : q.a / sum;
  return {std::min(first, second), std::max(first, second)};
}

/// Returns the first place in a range where a quadratic is not positive. A part at the start of the range that is at
/// most `shortest` long does not count.
double first_at_most_0(const Quadratic& q, const Range& range, double shortest) {
  const auto [first, second] = roots(q);
  double from = range.from;
  if (q.at(from) <= 0) {
    // The end of this part.
    double end = range.to;
    for (const double root : {first, second}) {
      if (root > from && root < end) {
        end = root;
        break;
      }
    }
    if (end - from > shortest || end == range.to) return from;
    from = end;
    // Rounding may leave the quadratic just below 0 there.
    const double next = second > from ? second : infinite;
    return q.c < 0 && next <= range.to ? next : infinite;
  }
  for (const double root : {first, second}) {
    if (root > from && root <= range.to) return root;
  }
  return infinite;
}

/// Distance from a plane along a line, or squared distance from a line or point.
Quadratic distance_along(const TracedSite& site, const Vec3d& x, const Vec3d& along) {
  const Vec3d step = x - site.point;
  if (site.kind == SiteKind::face) return {dot(site.direction, step), dot(site.direction, along), 0};
  if (site.kind == SiteKind::vertex) return {squared_length(step), 2 * dot(step, along), squared_length(along)};
  const Vec3d place = cross(site.direction, step), rate = cross(site.direction, along);
  return {squared_length(place), 2 * dot(place, rate), squared_length(rate)};
}

Quadratic square_of(const Quadratic& linear) {
  return {linear.a * linear.a, 2 * linear.a * linear.b, linear.b * linear.b};
}

/// Returns the part of a line in the domain of a site.
Range range_in_domain(const TracedSite& site, const SeamLine& line, double most, double slack) {
  Range out{0, most};
  if (site.kind == SiteKind::face && !site.is_convex) return out;
  for (const DomainSide& side : site.sides) {
    const double height = side.height(line.start) + slack, rate = dot(side.normal, line.along);
    if (rate > 0) {
      out.from = std::max(out.from, -height / rate);
    } else if (rate < 0) {
      out.to = std::min(out.to, height / -rate);
    } else if (height < 0) {
      return {1, 0};
    }
  }
  return out;
}

}  // namespace

double way_to_contact(const TracedSites& sites, const SeamLine& line, TracedSites::Index other, double most) {
  const double slack = 2 * sites.tolerance();
  const double shortest = 16 * sites.tolerance();
  const TracedSite& site = sites[other];
  const Range range = range_in_domain(site, line, most, slack);
  if (range.is_empty()) return most;
  if (range.from == 0 && range.to <= shortest) return most;
  Quadratic own = distance_along(sites[line.own], line.start, line.along);
  Quadratic theirs = distance_along(site, line.start, line.along);
  if (sites[line.own].kind == SiteKind::face) {
    own.a += slack;
    if (site.kind != SiteKind::face) own = square_of(own);
  } else {
    if (site.kind == SiteKind::face) {
      // If the distance from the face is below the slack, the face is as close as the line's own site.
      theirs.a -= slack;
      if (theirs.at(range.from) <= 0) return range.from;
      theirs = square_of(theirs);
    } else {
      own.a += slack * (2 * (std::sqrt(own.a) + most) + slack);
    }
  }
  const Quadratic gap{theirs.a - own.a, theirs.b - own.b, theirs.c - own.c};
  return std::min(most, first_at_most_0(gap, range, range.from == 0 ? shortest : 0));
}

}  // namespace blum::voronoi
