#include "voronoi/traced/seam_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "voronoi/label_geometry.hpp"
#include "voronoi/traced/clear_way.hpp"
#include "voronoi/traced/line_contact.hpp"

namespace blum::voronoi {
namespace {

using Index = TracedSites::Index;

bool contains(const std::vector<Index>& sorted, Index i) {
  return std::binary_search(sorted.begin(), sorted.end(), i);
}

/// Returns the first positive root of a + b s - bend/2 s^2, for a >= 0.
double first_root(double a, double b, double bend) {
  const double size = std::sqrt(b * b + 2 * bend * a);
  if (b < 0) return 2 * a / (size - b);
  return bend > 0 ? (b + size) / bend : std::numeric_limits<double>::infinity();
}

/// Largest steps, relative to the radius. Along lines, contacts are known exactly.
constexpr double longest_step = 0.5;
constexpr double longest_step_of_line = 1;
constexpr int most_steps = 20000;
/// A curve with a smaller radius has reached the surface, in multiples of the tolerance.
constexpr double touching = 512;

}  // namespace

/// Length for which a curve may be followed before a site can become one of the closest sites.
struct SeamTracer::Room {
  double step = 0;
  Index site = 0;
};

/// Where a site joins a curve.
struct SeamTracer::Event {
  Vec3d at;
  TracedSites::Closest there;
};

bool SeamTracer::is_straight(const TracedCurve& curve) const {
  return std::all_of(curve.surfaces.begin(), curve.surfaces.end(), [&](const TracedSurface& surface) {
    if (surface.is_plane()) return true;
    const SiteKind first = sites_[surface.first].kind;
    return first == sites_[surface.second].kind && first != SiteKind::edge;
  });
}

std::optional<Vec3d> SeamTracer::plane_of(const TracedCurve& curve) const {
  for (const TracedSurface& surface : curve.surfaces) {
    if (surface.is_plane()) return surface.normal;
    const TracedSite& first = sites_[surface.first];
    const TracedSite& second = sites_[surface.second];
    if (first.kind == SiteKind::face && second.kind == SiteKind::face) return unit(first.direction - second.direction);
  }
  return std::nullopt;
}

double SeamTracer::value(const TracedSurface& surface, const Vec3d& x) const {
  if (surface.is_plane()) return dot(surface.normal, x - surface.point);
  return sites_.distance(surface.first, x) - sites_.distance(surface.second, x);
}

Vec3d SeamTracer::slope(const TracedSurface& surface, const Vec3d& x) const {
  if (surface.is_plane()) return surface.normal;
  return sites_.gradient(surface.first, x) - sites_.gradient(surface.second, x);
}

TracedSurface SeamTracer::between(Index first, Index second, const Vec3d& at) const {
  if (const DomainSide* side = sites_.side_between(first, second)) {
    return TracedSurface::plane(side->normal, side->ends[0]);
  }
  const TracedSite& a = sites_[first];
  const TracedSite& b = sites_[second];
  if (a.kind == SiteKind::edge && b.kind == SiteKind::edge) {
    for (const std::uint32_t v : a.vertices) {
      if (!contains(b.vertices, v)) continue;
      // Points x with |x . d_a| = |x . d_b|, relative to the vertex.
      const Vec3d& apex = sites_.vertices()[v];
      const double along_a = dot(a.direction, at - apex), along_b = dot(b.direction, at - apex);
      const Vec3d normal = a.direction + b.direction * ((along_a < 0) == (along_b < 0) ? -1.0 : 1.0);
      if (length(normal) > 1e-6) return TracedSurface::plane(unit(normal), apex);
    }
    constexpr double parallel = 1e-12;
    const Vec3d step = b.point - a.point;
    const Vec3d apart = step - a.direction * dot(a.direction, step);
    if (length(cross(a.direction, b.direction)) < parallel && length(apart) > sites_.tolerance()) {
      return TracedSurface::plane(unit(apart), a.point + apart * 0.5);
    }
  }
  return TracedSurface::between(first, second);
}

Vec3d SeamTracer::tangent(const TracedCurve& curve, const Vec3d& x) const {
  const Vec3d way = cross(slope(curve.surfaces[0], x), slope(curve.surfaces[1], x));
  return length(way) > 0 ? unit(way) : Vec3d{};
}

std::optional<Vec3d> SeamTracer::solve(const std::array<TracedSurface, 3>& surfaces, Vec3d x, double reach) const {
  ++work_.done;
  if (work_.is_exhausted()) return std::nullopt;
  const Vec3d start = x;
  double last = std::numeric_limits<double>::infinity();
  constexpr int most_iterations = 30;
  for (int k = 0; k < most_iterations; ++k) {
    std::array<Vec3d, 3> row;
    std::array<double, 3> f{};
    std::array<double, 3> slopes{};
    double away = 0;
    for (std::size_t s = 0; s < 3; ++s) {
      row[s] = slope(surfaces[s], x);
      f[s] = value(surfaces[s], x);
      away = std::max(away, std::abs(f[s]));
      // Rows of unit length make the determinant a measure of the angles between the surfaces.
      const double size = length(row[s]);
      if (!(size > 1e-13)) return std::nullopt;
      slopes[s] = size;
      row[s] = row[s] / size;
      f[s] /= size;
    }
    const double det = dot(row[0], cross(row[1], row[2]));
    if (!(std::abs(det) > 1e-12)) return std::nullopt;
    Vec3d step;
    double per_value = 0;  // of the step
    for (std::size_t s = 0; s < 3; ++s) {
      const Vec3d way = cross(row[(s + 1) % 3], row[(s + 2) % 3]) / det;
      step += way * f[s];
      per_value += length(way) / slopes[s];
    }
    x = x - step;
    const double size = length(step);
    if (!(size < 2 * reach) || !(length(x - start) <= 2 * reach)) return std::nullopt;
    if (size <= 1e-15 * sites_.extent()) return x;
    if (size >= 0.5 * last && size <= 1e-3 * sites_.tolerance()) return x;
    // Where surfaces have small slopes, or touch, rounding of distances moves x further. More steps do not help then.
    const double rounding = 0x1p-52 * sites_.extent();
    if (size >= 0.5 * last && away <= 4 * rounding && size <= rounding * per_value) return x;
    last = size;
  }
  return last <= 0.1 * sites_.tolerance() ? std::optional(x) : std::nullopt;
}

std::optional<Vec3d> SeamTracer::point_in_plane(const TracedCurve& curve, const Vec3d& guess,
                                                const Vec3d& normal) const {
  return solve({curve.surfaces[0], curve.surfaces[1], TracedSurface::plane(normal, guess)}, guess,
               sites_.distance(curve.sites[0], guess) + 100 * sites_.tolerance());
}

std::optional<TracedCurve> SeamTracer::curve_of(const std::vector<Index>& found, const Vec3d& at,
                                                const Vec3d& towards) const {
  TracedCurve curve;
  curve.sites = found;
  // The two surfaces are those that determine the direction best.
  std::vector<TracedSurface> surfaces;
  constexpr double same_foot = 1e-9;
  std::vector<Vec3d> gradients;
  constexpr std::size_t many = 16;  // then, surfaces with the first site are enough
  for (std::size_t a = 0; a < found.size(); ++a) {
    const Vec3d own = sites_.gradient(found[a], at);
    for (std::size_t b = a + 1; b < found.size() && (a == 0 || found.size() <= many); ++b) {
      if (sites_.side_between(found[a], found[b]) != nullptr ||
          length(own - sites_.gradient(found[b], at)) > same_foot) {
        surfaces.push_back(between(found[a], found[b], at + towards * (1e-3 * sites_.distance(found[a], at))));
      }
    }
    if (std::none_of(gradients.begin(), gradients.end(),
                     [&](const Vec3d& g) { return length(g - own) <= same_foot; })) {
      gradients.push_back(own);
    }
  }
  // Three footprints determine a seam. With fewer, it lies in sides of domains.
  for (std::size_t a = 0; gradients.size() < 3 && a < found.size(); ++a) {
    for (const DomainSide* side : sites_.sides_at(found[a], at, 8 * sites_.tolerance())) {
      if (side->is_open && std::abs(dot(side->normal, towards)) < 1e-5) {
        surfaces.push_back(TracedSurface::plane(side->normal, side->ends[0]));
      }
    }
  }
  double best = 1e-9;
  bool is_found = false;
  for (std::size_t a = 0; a < surfaces.size(); ++a) {
    const Vec3d first = slope(surfaces[a], at);
    for (std::size_t b = a + 1; b < surfaces.size(); ++b) {
      const double size = length(cross(first, slope(surfaces[b], at)));
      if (size <= best * (1 + 1e-9)) continue;
      best = size;
      curve.surfaces = {surfaces[a], surfaces[b]};
      is_found = true;
    }
  }
  return is_found ? std::optional(curve) : std::nullopt;
}

bool SeamTracer::is_meeting(const std::vector<Index>& near, const Vec3d& at) const {
  constexpr std::size_t many = 8;
  const double tolerance = sites_.tolerance();
  double radius = sites_.distance(near[0], at);
  if (near.size() > many) {
    for (const Index i : near) radius = std::min(radius, sites_.distance(i, at));
  }
  return std::all_of(near.begin(), near.end(), [&](Index i) {
    return (sites_[i].kind == SiteKind::face || near.size() > many) &&
           std::abs(sites_.distance(i, at) - radius) <= tolerance && sites_.outside(i, at, tolerance) <= tolerance &&
           sites_.sides_at(i, at, 64 * tolerance).empty();
  });
}

std::vector<Vec3d> SeamTracer::seam_points(const std::vector<Index>& near, const Vec3d& at, const Vec3d& normal,
                                           double reach) const {
  std::vector<TracedSurface> surfaces;
  for (std::size_t a = 0; a < near.size(); ++a) {
    for (std::size_t b = a + 1; b < near.size(); ++b)
      surfaces.push_back(between(near[a], near[b], at + normal * (0.1 * reach)));
    for (const DomainSide& side : sites_[near[a]].sides) {
      if (side.is_open && std::abs(side.height(at)) <= reach) {
        surfaces.push_back(TracedSurface::plane(side.normal, side.ends[0]));
      }
    }
  }
  const std::array<Vec3d, 2> axes = axes_across(normal);
  const TracedSurface plane = TracedSurface::plane(normal, at);
  std::vector<Vec3d> out;
  for (std::size_t a = 0; a < surfaces.size(); ++a) {
    for (std::size_t b = a + 1; b < surfaces.size(); ++b) {
      for (const Vec3d& aside : {Vec3d{}, -axes[0], -axes[1], axes[0], axes[1]}) {
        const auto found = solve({surfaces[a], surfaces[b], plane}, at + aside * (0.2 * reach), reach);
        if (!found || length(*found - at) > reach) continue;
        // Where two sites have one footprint, their surfaces touch instead of crossing, and the point is not precise.
        constexpr double least_angle = 1e-4;
        const Vec3d first = slope(surfaces[a], *found), second = slope(surfaces[b], *found);
        if (length(cross(first, second)) < least_angle * length(first) * length(second)) continue;
        if (length(first) < 1e-9 || length(second) < 1e-9) continue;
        if (is_meeting(near, *found)) return {*found};
        const bool is_known = std::any_of(
            out.begin(), out.end(), [&](const Vec3d& p) { return length(p - *found) <= sites_.precision().apart; });
        if (!is_known) out.push_back(*found);
      }
    }
  }
  return out;
}

TracedSites::Closest SeamTracer::closest(const Vec3d& x, double tolerance, Index site) const {
  TracedSites::Closest out = sites_.closest(x, tolerance, std::abs(sites_.distance(site, x)));
  work_.done += out.examined;
  return out;
}

std::vector<SeamTracer::Room> SeamTracer::rooms(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                double radius, double most) const {
  std::vector<Room> out =
      is_straight(curve) ? rooms_of_line(curve, x, along, radius, most) : rooms_of_bend(curve, x, along, radius, most);
  std::sort(out.begin(), out.end(), [](const Room& a, const Room& b) { return a.step < b.step; });
  return out;
}

double SeamTracer::gap_to(Index site, const Vec3d& x, double beyond, double radius) const {
  // A face behind which x lies, as the other face of a thin slot, is close from its other side only.
  const double behind = sites_[site].kind == SiteKind::face ? -sites_.distance(site, x) : 0;
  if (behind > sites_.tolerance()) return radius + behind;
  return sites_.least_distance(site, x, beyond) - radius;
}

template <class WayToZero>
double SeamTracer::way_past_edges(const TracedCurve& curve, Index site, const Vec3d& x,
                                  const WayToZero& way_to_zero) const {
  double out = 0;
  for (const Index own : curve.sites) {
    const auto plane = sites_.plane_between_edges(own, site);
    if (!plane) continue;
    const double height = plane->height(x);
    if (height > 0) out = std::max(out, way_to_zero(height, plane->normal));
  }
  return out;
}

std::vector<SeamTracer::Room> SeamTracer::rooms_of_line(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                        double radius, double most) const {
  std::vector<Room> out;
  const SeamLine line{curve.sites[0], x, along};
  const auto way_to_zero = [&](double value, const Vec3d& slope) {
    const double rate = -dot(slope, along);
    return rate > 0 ? value / rate : most;
  };
  // The radius is convex along the line. So all balls around its points lie in the ball around its middle.
  const Vec3d middle = x + along * (0.5 * most);
  const double largest = std::max(radius, sites_.distance(line.own, x + along * most));
  sites_.for_each_within(middle, largest + 0.5 * most + 4 * sites_.tolerance(), [&](Index i) {
    ++work_.done;
    if (contains(curve.sites, i)) return;
    const double contact = way_to_contact(sites_, line, i, most);
    if (contact >= most) return;
    const double beyond = sites_.outside(i, x, most);
    if (beyond >= most) return;
    const double step = std::max(
        {contact, gap_to(i, x, beyond, radius) / 2, beyond, std::min(way_past_edges(curve, i, x, way_to_zero), most)});
    if (step < most) out.push_back({step, i});
  });
  return out;
}

std::vector<SeamTracer::Room> SeamTracer::rooms_of_bend(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                        double radius, double most) const {
  std::vector<Room> out;
  const double reach = radius + 2 * most;
  // Second derivatives of distances along the curve are a few times its curvature.
  const double bend = 8 / std::max(radius, sites_.tolerance());
  const std::optional<Vec3d> plane = plane_of(curve);
  const auto face = std::find_if(curve.sites.begin(), curve.sites.end(),
                                 [&](Index own) { return sites_[own].kind == SiteKind::face; });
  // Returns the path length before which a linear function stays above 0. A curve in a plane bends within it, so
  // functions whose slope is at right angles to the plane change evenly. Differences of nearly symmetric sites are such
  // functions.
  const auto way_to_zero = [&](double value, const Vec3d& slope) {
    const Vec3d within = plane ? slope - *plane * dot(*plane, slope) : slope;
    return first_root(value, dot(slope, along), bend * length(within));
  };
  const double own_rate = dot(sites_.gradient(curve.sites[0], x), along);
  sites_.for_each_within(x, reach, [&](Index i) {
    ++work_.done;
    if (contains(curve.sites, i)) return;
    const TracedSite& site = sites_[i];
    if (std::abs(sites_.distance(i, x)) - radius >= 2 * most) return;
    const double beyond = sites_.outside(i, x, most);
    if (beyond >= most) return;
    double step = std::max(gap_to(i, x, beyond, radius) / 2, beyond);
    if (beyond > 0 && (site.kind != SiteKind::face || site.is_convex)) {
      for (const DomainSide& side : site.sides) {
        const double height = -side.height(x);
        if (height > 0) step = std::max(step, std::min(way_to_zero(height, -side.normal), most));
      }
    }
    if (beyond > 0 && site.kind == SiteKind::face && !site.is_convex && !site.index) {
      const TracedSites::OutsideSide outside = sites_.outside_side(i, x);
      const double height = std::max(-outside.side->height(x), 0.0);
      step = std::max(step, std::min({way_to_zero(height, -outside.side->normal), outside.others, most}));
    }
    // The line or plane of a site is not farther than the site.
    const double gap = sites_.distance(i, x) - radius;
    if (gap > 0) {
      const double way = face != curve.sites.end() && site.kind == SiteKind::face
                             ? way_to_zero(gap, site.direction - sites_[*face].direction)
                             : first_root(gap, dot(sites_.gradient(i, x), along) - own_rate, bend);
      step = std::max(step, std::min(way, most));
    }
    step = std::max(step, std::min(way_past_edges(curve, i, x, way_to_zero), most));
    if (step < most) out.push_back({std::max(step, 0.0), i});
  });
  return out;
}

bool SeamTracer::may_meet(const TracedCurve& curve, Index site, const Vec3d& at) const {
  const double tolerance = (1 + 1e-9) * sites_.tolerance();
  const double radius = sites_.distance(curve.sites[0], at);
  const auto is_at = [&](Index i) {
    return std::abs(sites_.distance(i, at) - radius) <= tolerance && sites_.outside(i, at, tolerance) <= tolerance;
  };
  return is_at(site) && std::all_of(curve.sites.begin(), curve.sites.end(), is_at);
}

bool SeamTracer::is_closer_to_an_edge(const DomainSide& end, const std::vector<Index>& edges, const Vec3d& at) const {
  const double rounding = 1e-15 * sites_.extent();
  return std::any_of(edges.begin(), edges.end(), [&](Index i) {
    const TracedSite& edge = sites_[i];
    return std::any_of(edge.sides.begin() + 2, edge.sides.end(),
                       [&](const DomainSide& side) {
                         return &side != &end && side.ends[0] == end.ends[0] && side.height(at) > rounding;
                       }) &&
           sites_.outside(i, at, sites_.tolerance()) <= sites_.tolerance();
  });
}

std::optional<SeamTracer::Event> SeamTracer::event_with(const TracedCurve& curve, Index site, const Vec3d& x,
                                                        const Vec3d& along, double radius) const {
  std::optional<Event> best;
  double least = std::numeric_limits<double>::infinity();
  std::vector<Index> edges;
  for (const Index own : curve.sites) {
    if (sites_[own].kind == SiteKind::edge) edges.push_back(own);
  }
  if (sites_[site].kind == SiteKind::edge) edges.push_back(site);
  const auto consider = [&](const TracedSurface& surface, double most, const DomainSide* end_of_edge = nullptr) {
    const auto found = solve({curve.surfaces[0], curve.surfaces[1], surface}, x, radius);
    if (!found) return;
    const double way = dot(*found - x, along);
    if (way <= 0 || way >= std::min(least, most) || way < 0.5 * length(*found - x)) return;
    if (end_of_edge != nullptr && is_closer_to_an_edge(*end_of_edge, edges, *found)) return;
    if (!may_meet(curve, site, *found)) return;
    TracedSites::Closest there = closest(*found, sites_.tolerance(), curve.sites[0]);
    if (!contains(there.sites, site)) return;
    if (!std::includes(there.sites.begin(), there.sites.end(), curve.sites.begin(), curve.sites.end())) return;
    least = way;
    best = {*found, std::move(there)};
  };
  const double infinite = least;
  const auto consider_side = [&](Index owner, const DomainSide& side) {
    if (!side.is_open) return;
    const bool is_end = sites_[owner].kind == SiteKind::edge && &side - sites_[owner].sides.data() >= 2;
    consider(TracedSurface::plane(side.normal, side.ends[0]), infinite, is_end ? &side : nullptr);
  };
  sites_.for_each_side(site, x, 2 * radius, [&](const DomainSide& side) { consider_side(site, side); });
  for (const Index own : curve.sites) {
    // The curve passes a side within this path length.
    sites_.for_each_side(own, x, 2 * radius, [&](const DomainSide& side) {
      if (std::abs(side.height(x)) < radius) consider_side(own, side);
    });
    if (const auto plane = sites_.plane_between_edges(own, site)) {
      consider(TracedSurface::plane(plane->normal, plane->point), infinite);
    }
  }
  // At a side of its domain, the distance of a site touches that of its neighbour, and the side gives the place more
  // precisely.
  const double most = least - 1e-3 * radius;
  for (std::size_t k = 0; k < std::min<std::size_t>(curve.sites.size(), 3); ++k) {
    consider(between(curve.sites[k], site, x), most);
  }
  return best;
}

std::optional<std::uint32_t> SeamTracer::vertex_ahead(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                      double radius, const std::vector<Room>& near) const {
  // The site with the fewest vertices comes first: large faces have thousands.
  const auto vertices_of = [&](Index i) -> const std::vector<std::uint32_t>& { return sites_[i].vertices; };
  const Index least = *std::min_element(curve.sites.begin(), curve.sites.end(), [&](Index a, Index b) {
    return vertices_of(a).size() < vertices_of(b).size();
  });
  for (const std::uint32_t v : vertices_of(least)) {
    if (!std::all_of(curve.sites.begin(), curve.sites.end(), [&](Index i) { return contains(vertices_of(i), v); })) {
      continue;
    }
    const Vec3d way = sites_.vertices()[v] - x;
    const double size = length(way);
    // All surfaces of the curve are cones with the vertex as their apex, so it is straight.
    if (dot(way, along) < (1 - 1e-9) * size) continue;
    const auto are_free = [&](const std::vector<Room>& found) {
      return std::all_of(found.begin(), found.end(), [&](const Room& room) {
        const std::vector<std::uint32_t>& own = sites_[room.site].vertices;
        return room.step >= size || std::binary_search(own.begin(), own.end(), v);
      });
    };
    // In most cases, a site near x shows that the path is not free.
    if (are_free(near) && are_free(rooms(curve, x, along, radius, size))) return v;
  }
  return std::nullopt;
}

std::optional<CurveSamples> SeamTracer::samples_of(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                   double length) const {
  CurveSamples out{length, {x}};
  for (std::size_t k = 1; k < CurveSamples::count; ++k) {
    const double way = length * CurveSamples::share(k);
    const auto next = point_in_plane(curve, x + along * way, along);
    if (!next || blum::length(*next - x) > 1.25 * way) return std::nullopt;
    out.points[k] = *next;
  }
  return out;
}

bool SeamTracer::is_clear(const TracedCurve& curve, const Vec3d& from, const Vec3d& to,
                          const std::vector<Index>& at_end) const {
  const Vec3d way = to - from;
  const double size = length(way);
  if (!(size > 0)) return true;
  constexpr int parts = 6;
  for (int k = 1; k <= parts; ++k) {
    // The last point is only nearly at the end, where an event may be.
    const double share = k < parts ? static_cast<double>(k) / parts : 0.999;
    const auto at = point_in_plane(curve, from + way * share, way / size);
    if (!at || length(*at - from) > 1.5 * size) return false;
    const std::vector<Index> there = closest(*at, sites_.tolerance(), curve.sites[0]).sites;
    if (there == curve.sites) continue;
    if (k < parts || !std::includes(there.begin(), there.end(), curve.sites.begin(), curve.sites.end()) ||
        !std::includes(at_end.begin(), at_end.end(), there.begin(), there.end())) {
      return false;
    }
  }
  return true;
}

std::optional<Vec3d> SeamTracer::touching_point(const TracedCurve& curve, Index site, const Vec3d& x,
                                                double radius) const {
  // The distance of the site changes at this rate, relative to that of the curve's own sites.
  const auto rate = [&](const Vec3d& at) {
    return dot(sites_.gradient(site, at) - sites_.gradient(curve.sites[0], at), tangent(curve, at));
  };
  constexpr double crossing = 0.02;
  double value = rate(x);
  if (std::abs(value) > crossing) return std::nullopt;
  // At a side of its domain, a site always touches its neighbour.
  constexpr double same_foot = 1e-3;
  const Vec3d own = sites_.gradient(site, x);
  for (const Index i : curve.sites) {
    if (length(sites_.gradient(i, x) - own) < same_foot) return std::nullopt;
  }
  const Vec3d along = tangent(curve, x);
  const auto at = [&](double way) { return point_in_plane(curve, x + along * way, along); };
  double way = 0;
  double step = 1e-3 * radius;
  Vec3d best = x;
  constexpr int most_steps_of_secant = 12;
  for (int k = 0; k < most_steps_of_secant; ++k) {
    const auto next = at(way + step);
    if (!next) return std::nullopt;
    double other = rate(*next);
    // The tangent of a curve has two directions.
    if (dot(tangent(curve, *next), along) < 0) other = -other;
    if (other == value) break;
    const double last = way;
    way += step;
    step = -other * (way - last) / (other - value);
    value = other;
    best = *next;
    if (!(std::abs(way + step) < 0.1 * radius)) return std::nullopt;
    if (std::abs(step) < 1e-13 * radius) break;
  }
  const double gap = sites_.distance(site, best) - sites_.distance(curve.sites[0], best);
  if (std::abs(gap) > sites_.tolerance() || sites_.outside(site, best) > sites_.tolerance()) return std::nullopt;
  return best;
}

std::optional<Vec3d> SeamTracer::meeting_point(const TracedCurve& curve, const Vec3d& x, double radius) const {
  constexpr double loose = 64;
  const double reach = loose * sites_.tolerance();
  const TracedSites::Closest near = closest(x, reach, curve.sites[0]);
  if (near.sites.size() < 2) return std::nullopt;
  std::vector<TracedSurface> surfaces;
  for (std::size_t k = 0; k < near.sites.size(); ++k) {
    if (k > 0) surfaces.push_back(TracedSurface::between(near.sites[0], near.sites[k]));
    for (const DomainSide* side : sites_.sides_at(near.sites[k], x, reach)) {
      if (side->is_open) surfaces.push_back(TracedSurface::plane(side->normal, side->ends[0]));
    }
  }
  // Least squares by Gauss and Newton. A little damping keeps directions that nothing determines.
  Vec3d best = x;
  constexpr int most_iterations = 12;
  for (int k = 0; k < most_iterations; ++k) {
    constexpr double damping = 1e-9;
    std::array<Vec3d, 3> matrix{Vec3d{damping, 0, 0}, Vec3d{0, damping, 0}, Vec3d{0, 0, damping}};
    Vec3d right;
    for (const TracedSurface& surface : surfaces) {
      const Vec3d row = slope(surface, best);
      const double f = value(surface, best);
      for (std::size_t axis = 0; axis < 3; ++axis) matrix[axis] += row * row[axis];
      right += row * f;
    }
    const double det = dot(matrix[0], cross(matrix[1], matrix[2]));
    if (!(std::abs(det) > 0)) return std::nullopt;
    const Vec3d step = (cross(matrix[1], matrix[2]) * right.x + cross(matrix[2], matrix[0]) * right.y +
                        cross(matrix[0], matrix[1]) * right.z) /
                       det;
    best -= step;
    if (length(step) < 1e-15 * sites_.extent()) break;
  }
  if (!(length(best - x) <= std::max(reach, sites_.blur(radius)))) return std::nullopt;
  const TracedSites::Closest found = closest(best, sites_.tolerance(), curve.sites[0]);
  return found.sites == near.sites ? std::optional(best) : std::nullopt;
}

void SeamTracer::end_at_border(Trace& trace) const {
  trace.end = TraceEnd::border;
  constexpr double close = 1024;
  const auto v = sites_.vertex_near(trace.points.back(), close * sites_.tolerance());
  if (!v) return;
  trace.end = TraceEnd::vertex;
  trace.vertex = *v;
  trace.points.back() = sites_.vertices()[*v];
}

/// A trace in progress.
struct SeamTracer::Run {
  const SeamTracer& tracer;
  const TracedCurve& curve;
  const Vec3d start;
  const Departure& from;
  Trace out;
  Vec3d x;
  Vec3d along;
  double way = 0;
  double radius = 0;
  double most = 0;                               ///< longest step
  std::optional<Index> expected = std::nullopt;  ///< probably the next site that becomes as close

  [[nodiscard]] double tolerance() const { return tracer.sites_.tolerance(); }

  /// Returns true if more sites than those of the curve are closest.
  [[nodiscard]] bool is_event(const std::vector<Index>& found) const {
    return found.size() > curve.sites.size() &&
           std::includes(found.begin(), found.end(), curve.sites.begin(), curve.sites.end());
  }

  /// Returns true if all sites meet at one edge of the polyhedron: its faces, and the edge itself if it is reflex. They
  /// are equally close only there, but differ by less than the tolerance near an edge that is nearly flat.
  [[nodiscard]] bool meet_at_edge(const std::vector<Index>& found) const {
    return std::any_of(found.begin(), found.end(), [&](Index i) {
      const TracedSite& site = tracer.sites_[i];
      if (site.kind != SiteKind::edge) return false;
      const BorderEdge& edge = tracer.sites_.edges()[site.border];
      return std::all_of(found.begin(), found.end(),
                         [&](Index k) { return k == i || k == edge.faces[0] || k == edge.faces[1]; }) &&
             contains(found, edge.faces[0]) && contains(found, edge.faces[1]);
    });
  }

  /// Ends the trace at the closest sites of its last point.
  void end_at(std::vector<Index> found, double there) {
    if (meet_at_edge(found)) {
      out.points.back() = tracer.sites_.foot(found[0], out.points.back());
      out.end = TraceEnd::border;
      return;
    }
    out.sites = std::move(found);
    out.end = out.sites.size() > 1 ? TraceEnd::event : TraceEnd::failed;
    if (there < touching * tolerance()) tracer.end_at_border(out);
  }

  void end_at_vertex(std::uint32_t v) {
    out.points.push_back(tracer.sites_.vertices()[v]);
    out.end = TraceEnd::vertex;
    out.vertex = v;
  }

  /// Returns true if the trace ends at a vertex just beyond an event. Sites that meet at the vertex are equally close
  /// only there, but differ by less than the tolerance near it if they are nearly flat.
  bool ends_at_vertex(const Vec3d& event, const TracedSites::Closest& there) {
    const auto v = tracer.vertex_ahead(curve, event, along, there.radius, {});
    if (!v || !std::all_of(there.sites.begin(), there.sites.end(), [&](Index i) {
          const std::vector<std::uint32_t>& own = tracer.sites_[i].vertices;
          return std::binary_search(own.begin(), own.end(), *v);
        })) {
      return false;
    }
    end_at_vertex(*v);
    return true;
  }

  /// Returns true if the trace ends at the surface.
  bool ends_at_surface(bool is_first, const std::vector<Room>& near) {
    if (!is_first || radius > tolerance()) {
      if (const auto v = tracer.vertex_ahead(curve, x, along, radius, near)) {
        end_at_vertex(*v);
        return true;
      }
    }
    if (!(radius < touching * tolerance() && dot(tracer.sites_.gradient(curve.sites[0], x), along) < 0)) return false;
    tracer.end_at_border(out);
    return true;
  }

  /// Moves the last point to where the curve touches the region of a site, or where all near sites meet. It moves only
  /// if this place is an event of the curve and is known more precisely.
  /// @param found  the closest sites of the last point.
  /// @return the closest sites of the point.
  std::vector<Index> refined(Index site, const std::vector<Index>& found) {
    const Vec3d at = out.points.back();
    const auto touched = tracer.touching_point(curve, site, at, radius);
    const auto met = tracer.meeting_point(curve, touched ? *touched : at, radius);
    for (const std::optional<Vec3d>& place : {met, touched}) {
      if (!place) continue;
      std::vector<Index> there = tracer.closest(*place, tolerance(), curve.sites[0]).sites;
      if (!is_event(there)) continue;
      out.points.back() = *place;
      return there;
    }
    return found;
  }

  /// Returns true if the trace ends where a site becomes as close. Events near the start are the junction there.
  bool ends_at_event(const std::vector<Room>& near) {
    constexpr std::size_t most_tried = 6;
    // A step must not end at an event: it would then lie behind.
    const double ahead = 1.0625 * most;
    std::vector<Index> tried;
    if (expected) tried.push_back(*expected);
    for (std::size_t r = 0; r < near.size() && r < most_tried && near[r].step < ahead; ++r) {
      if (expected != near[r].site) tried.push_back(near[r].site);
    }
    for (const Index site : tried) {
      const auto event = tracer.event_with(curve, site, x, along, radius);
      if (!event) continue;
      const auto& [found, there] = *event;
      const double size = length(found - x);
      const double away = length(found - from.at);
      if (away <= tracer.sites_.precision().apart || size > 2 * most) continue;
      if (there.sites == from.sites && away <= tracer.sites_.blur(there.radius)) continue;
      const bool is_first = std::all_of(near.begin(), near.end(), [&](const Room& room) {
        return room.step >= size || contains(there.sites, room.site);
      });
      if (!is_first && !tracer.is_clear(curve, x, found, there.sites)) continue;
      if (ends_at_vertex(found, there)) return true;
      out.points.push_back(found);
      end_at(refined(site, there.sites), there.radius);
      return true;
    }
    return false;
  }

  /// Lengthens a step that is too short. Returns nothing if the trace ends, because the curve touches a region without
  /// a clear crossing.
  std::optional<double> long_enough(double step, const std::vector<Room>& near) {
    if (step >= 4 * tolerance()) return step;
    if (way > 64 * tolerance() && near.front().step <= 0.25 * tolerance()) {
      if (const auto touched = tracer.touching_point(curve, near.front().site, x, radius)) {
        x = *touched;
        out.points.back() = x;
      }
      const TracedSites::Closest there = tracer.closest(x, 4 * tolerance(), curve.sites[0]);
      const bool is_start = there.sites == from.sites && length(x - from.at) <= tracer.sites_.blur(radius);
      if (!is_start && there.sites != curve.sites) {
        end_at(there.sites, there.radius);
        return std::nullopt;
      }
      step = 0.1 * tracer.sites_.blur(radius);
      // Only the sites of the start are still as close. All other sites limit the step as always.
      const auto other =
          std::find_if(near.begin(), near.end(), [&](const Room& room) { return !contains(from.sites, room.site); });
      if (other != near.end()) step = std::min(step, other->step);
    }
    return std::max(step, 4 * tolerance());
  }

  /// Goes to a point of the curve, if its direction there is much the same.
  bool go_to(const std::optional<Vec3d>& next, double step) {
    constexpr double same_way = 0.9;
    if (!next || length(*next - x) > 1.5 * step) return false;
    Vec3d turned = tracer.tangent(curve, *next);
    if (dot(turned, along) < 0) turned = -turned;
    if (!(dot(turned, along) > same_way)) return false;
    way += length(*next - x);
    x = *next;
    along = turned;
    out.points.push_back(x);
    return true;
  }

  /// Takes a long step if sites come close without reaching the curve. They would make all steps short.
  /// @param near  all sites that the curve may reach within twice the longest step.
  bool leaps(double step, const std::vector<Room>& near) {
    expected.reset();
    double leap = std::min(0.125 * radius, most);
    constexpr double least = 8;  // in steps: shorter leaps take longer than steps
    if (!(least * step < leap && way > 64 * tolerance())) return false;
    const auto others_within = [&](double size) {
      std::vector<Index> out;
      for (const Room& room : near) {
        if (room.step < 1.5 * size) out.push_back(room.site);
      }
      return out;
    };
    constexpr int most_tries = 3;
    for (int k = 0; k < most_tries && least * step < leap; ++k, leap *= 0.125) {
      const auto samples = tracer.samples_of(curve, x, along, leap);
      if (!samples) continue;
      const auto clear = clear_way(tracer.sites_, *samples, curve.sites, others_within(leap));
      if (!clear) continue;
      expected = clear->site;
      if (!(least * step < clear->length)) return false;
      const auto next = clear->site ? tracer.point_in_plane(curve, x + along * clear->length, along)
                                    : std::optional(samples->points.back());
      if (!next || tracer.closest(*next, tolerance(), curve.sites[0]).sites != curve.sites) continue;
      if (go_to(next, clear->length)) return true;
    }
    return false;
  }

  /// Returns true if a step to a point of the curve passes an event: other sites are clearly closer there. Along
  /// lines, contacts are known exactly.
  [[nodiscard]] bool passes_event(const Vec3d& next) const {
    if (tracer.is_straight(curve)) return false;
    constexpr double clearly = 64;
    const std::vector<Index> there = tracer.closest(next, clearly * tolerance(), curve.sites[0]).sites;
    return !std::includes(there.begin(), there.end(), curve.sites.begin(), curve.sites.end());
  }

  /// Takes a step, or a shorter one if the curve bends, or bends so much that the step would pass an event.
  bool advances(double& step) {
    constexpr int most_halvings = 30;
    for (int h = 0; h < most_halvings; ++h, step *= 0.5) {
      const auto next = tracer.point_in_plane(curve, x + along * step, along);
      if (next && step > 8 * tolerance() && passes_event(*next)) continue;
      if (go_to(next, step)) return true;
    }
    return false;
  }

  /// Returns true if the trace is back at its start.
  bool is_closed(double step) {
    if (out.points.size() < 6 || way <= 4 * length(x - start) || length(x - start) >= 2 * step) return false;
    const Vec3d first = out.points[1] - start;
    if (!(dot(first, along) > 0.9 * length(first) && dot(start - x, along) >= 0)) return false;
    out.points.push_back(start);
    out.end = TraceEnd::closed;
    return true;
  }
};

double SeamTracer::first_step(const TracedCurve& curve) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Index i : curve.sites) {
    if (sites_[i].kind == SiteKind::vertex) continue;
    const Vec3d size = sites_[i].box.size();
    least = std::min(least, std::max({size.x, size.y, size.z}));
  }
  return std::max(least, 64 * sites_.tolerance());
}

Trace SeamTracer::trace(const TracedCurve& curve, const Vec3d& start, const Vec3d& towards,
                        const Departure& from) const {
  Run run{*this, curve, start, from, {}, start, tangent(curve, start)};
  run.out.points.push_back(start);
  if (dot(run.along, towards) < 0) run.along = -run.along;
  if (length(run.along) == 0) return std::move(run.out);
  const double longest = is_straight(curve) ? longest_step_of_line : longest_step;
  // Seams of small sites are short, and sites near a short step are few.
  double likely = first_step(curve);
  for (int k = 0; k < most_steps && !work_.is_exhausted(); ++k) {
    run.radius = sites_.distance(curve.sites[0], run.x);
    run.most = std::min(longest * std::max(run.radius, 64 * sites_.tolerance()), likely);
    likely *= 2;
    const std::vector<Room> near = rooms(curve, run.x, run.along, run.radius, 2 * run.most);
    if (run.ends_at_surface(k == 0, near) || run.ends_at_event(near)) break;
    std::optional<double> step = run.long_enough(near.empty() ? run.most : std::min(run.most, near.front().step), near);
    if (!step) break;
    if (run.leaps(*step, near)) continue;
    if (!run.advances(*step) || run.is_closed(*step)) break;
  }
  return std::move(run.out);
}

}  // namespace blum::voronoi
